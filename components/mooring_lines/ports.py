"""What lines take and give: the motion of bodies; their loads, and the pull of each line."""

from dataclasses import replace

from quintet.components.mooring_lines.params import MooringLinesParams
from quintet.interfaces.component import Field, Port
from quintet.interfaces.manifest import Ports
from quintet.interfaces.ports import LOAD, MOTION, RADIUS

BODIES = replace(MOTION, items="partner")
PULL = replace(LOAD, items="partner")  # on each body
TENSION = Field("tension", (), "N")  # of the view, at points
GAUGE = Port(
    "line_gauge",
    (
        Field("tension", (), "N"),  # at the fairlead
        Field("anchor_tension", (), "N"),
        Field("lying", (), "m"),  # length without pull that lies on the bed
    ),
)
SHOWS = (TENSION, RADIUS)


def ports(params: MooringLinesParams) -> Ports:
    """Ports taken and given."""
    return (BODIES,), (PULL, GAUGE)
