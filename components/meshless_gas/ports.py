"""What a gas takes and gives: balances; its error where the solution is known; probes."""

from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.component import Field, Port
from quintet.interfaces.manifest import Ports
from quintet.interfaces.ports import POSITION, TEMPERATURE, VELOCITY
from quintet.interfaces.units import add_unit

add_unit("kg/m4")  # of a density's gradient

DENSITY = Field("density", (), "kg/m3")
PRESSURE = Field("pressure", (), "Pa")
MACH = Field("mach", (), "1")
SHOWS = (
    DENSITY,
    PRESSURE,
    VELOCITY,
    TEMPERATURE,
    MACH,
    Field("density_gradient", (), "kg/m4"),  # its size, as in a schlieren picture
)
# Of all nodes, one row; sums of densities over their volumes.
BALANCE = Port(
    "balance",
    fields=(
        Field("mass", (), "kg"),
        Field("momentum", (3,), "N s"),
        Field("energy", (), "J"),
        # What came in through the boundary since the start, pressure's part included.
        Field("mass_entered", (), "kg"),
        Field("momentum_entered", (3,), "N s"),
        Field("energy_entered", (), "J"),
        # What is there less what was there at the start and came in since; over the mass and the
        # energy at the start, and over √(2 mass energy).
        Field("mass_drift", (), "1"),
        Field("momentum_drift", (3,), "1"),
        Field("energy_drift", (), "1"),
        Field("inflow", (), "kg/s"),  # through all that gas enters by now
        Field("outflow", (), "kg/s"),
        Field("imbalance", (), "1"),  # inflow less outflow, over the inflow
        Field("change", (), "1"),  # of the density in the last step, over it and the steps' share
    ),
)
# Where the exact solution is known: means over the volume of the sizes of errors, and the largest.
ERROR = Port(
    "error",
    fields=(
        Field("density", (), "kg/m3"),
        Field("velocity", (), "m/s"),  # along x
        Field("pressure", (), "Pa"),
        Field("largest_density", (), "kg/m3"),
    ),
)
# Of the node nearest to each place.
PROBES = Port("probes", fields=(POSITION, VELOCITY, DENSITY, PRESSURE, TEMPERATURE, MACH))


def ports(params: MeshlessGasParams) -> Ports:
    """Ports taken and given."""
    known = params.riemann is not None or params.vortex is not None
    given = (BALANCE, *((ERROR,) if known else ()), *((PROBES,) if params.probes else ()))
    return (), given
