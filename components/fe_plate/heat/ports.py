"""What a conducting body takes and gives: heat at nodes of its surface, and their temperatures."""

from quintet.components.fe_plate.heat.params import FeHeatParams
from quintet.interfaces.component import Port
from quintet.interfaces.manifest import Ports
from quintet.interfaces.ports import HEAT_FLOW, NODE_HEAT, NODE_TEMPERATURE, TEMPERATURE

PARTS = Port("parts", fields=(TEMPERATURE,))  # means over the volume
HELD = Port("held", fields=(HEAT_FLOW,))  # from fixed temperatures into the body
NODE_GAUGE = Port("node_gauge", fields=(TEMPERATURE,))
SHOWS = (TEMPERATURE,)


def ports(params: FeHeatParams) -> Ports:
    """Ports taken and given."""
    switched = ((HELD, bool(params.fixed_temperatures)), (NODE_GAUGE, bool(params.node_gauges)))
    measured = tuple(port for port, on in switched if on)
    return (NODE_HEAT,), (NODE_TEMPERATURE, PARTS, *measured)
