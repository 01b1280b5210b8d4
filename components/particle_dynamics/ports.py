"""What a lattice takes and gives: positions and hotness, energies, baths, a wall of heat."""

from quintet.components.particle_dynamics.params import ParticleLatticeParams
from quintet.interfaces.component import Field, Port
from quintet.interfaces.manifest import Ports
from quintet.interfaces.ports import (
    POSITION,
    TEMPERATURE,
    VELOCITY,
    WALL_HEAT,
    WALL_TEMPERATURE,
)

HOTNESS = Field("hotness", (), "J")  # mean kinetic energy since averages began
RELATIVE = Field("relative_hotness", (), "1")  # over that of the hottest point
# Of the view, at points.
SHOWS = (RELATIVE, HOTNESS, TEMPERATURE, VELOCITY)
POINTS = Port("points", fields=(POSITION, VELOCITY, HOTNESS, RELATIVE, TEMPERATURE))
# Of the lattice, in one row. Energy put in since the start is work of the drive and heat of baths.
ENERGIES = Port(
    "energies",
    fields=(
        Field("kinetic", (), "J"),
        Field("potential", (), "J"),
        Field("dissipated", (), "J"),
        Field("work", (), "J"),
        Field("heat", (), "J"),
        Field("audit", (), "1"),  # missing energy over energy put in
        Field("intact", (), "1"),  # share of the bonds to the nearest of 0.8 to 1.2 spacings
        TEMPERATURE,  # mean of all points since averages began
        Field("temperature_error", (), "K"),  # standard error by blocks
    ),
)
# Of each bath, means since averages began; its heat flows into the points.
BATHS = Port(
    "baths",
    fields=(
        TEMPERATURE,
        Field("heat_flow", (), "W"),
        Field("heat_flow_error", (), "W"),
    ),
)


def ports(params: ParticleLatticeParams) -> Ports:
    """Ports taken and given."""
    baths = (BATHS,) if params.baths else ()
    coupled = any(bath.coupled for bath in params.baths)
    wall = (WALL_HEAT,) if coupled else ()
    return (WALL_TEMPERATURE,) if coupled else (), (POINTS, ENERGIES, *baths, *wall)
