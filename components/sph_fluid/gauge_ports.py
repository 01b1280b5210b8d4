"""The ports of gauges; a port exists only where a scene switches its gauge on."""

from quintet.components.sph_fluid.params import SphFluidParams
from quintet.interfaces.component import Field, Port

PRESSURE = Port("pressure_gauge", (Field("pressure", (), "Pa"),))
LEVEL = Port("level_gauge", (Field("height", (), "m"),))
FRONT = Port("front_gauge", (Field("position", (), "m"),))
MOTION = Port(
    "motion_gauge",
    (
        Field("speed", (), "m/s"),  # of the fastest particle
        Field("kinetic", (), "J"),
        Field("potential", (), "J"),  # of gravity, zero at the origin
        Field("centre", (3,), "m"),  # of mass
    ),
)


def gauge_ports(params: SphFluidParams) -> tuple[Port, ...]:
    """Ports of the gauges that are switched on."""
    switched = (
        (PRESSURE, bool(params.gauges.pressure_gauges)),
        (LEVEL, bool(params.gauges.level_gauges)),
        (FRONT, params.gauges.front_gauge is not None),
        (MOTION, params.gauges.motion_gauge),
    )
    return tuple(port for port, on in switched if on)
