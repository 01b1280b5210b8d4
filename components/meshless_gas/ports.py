"""What a gas takes and gives: balances; its error where the solution is known; probes."""

from dataclasses import replace

import numpy as np

from quintet.components.meshless_gas.params import MeshlessGasParams, has_walls
from quintet.interfaces import ports as shared
from quintet.interfaces.component import Field, Fields, Port
from quintet.interfaces.manifest import Ports
from quintet.interfaces.ports import HEAT, LOAD, MOTION, RADIUS, TEMPERATURE, VELOCITY

POSITION = Field("position", (3,), "m")
DENSITY = Field("density", (), "kg/m3")
PRESSURE = Field("pressure", (), "Pa")
MACH = Field("mach", (), "1")
SHOWS = (
    DENSITY,
    PRESSURE,
    VELOCITY,
    TEMPERATURE,
    MACH,
    Field("schlieren", (), "1"),
    Field("shadowgraph", (), "1"),
    Field("spacing", (), "m"),  # of nodes
    Field("exact_density", (), "kg/m3"),  # of a tube with a diaphragm
    Field("exact_pressure", (), "Pa"),
    Field("exact_velocity", (3,), "m/s"),
)
# Of all nodes, one row; sums of densities over their volumes.
BALANCE = Port(
    "balance",
    fields=(
        Field("mass", (), "kg"),
        Field("momentum", (3,), "N s"),
        Field("energy", (), "J"),
        # What came in through the boundary since the start, pressure's part included, and from
        # particles.
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
# Nodes of a body's wall, or of walls that hold the gas; where a wall of a box meets another or an
# inflow the node may be one of theirs.
WALL = Port(
    "wall",
    fields=(
        POSITION,
        PRESSURE,
        Field("friction", (3,), "Pa"),
        Field("heat_flux", (), "W/m2"),  # into the wall
    ),
)


def body(params: MeshlessGasParams) -> Port:
    """Sums over what `wall` has, less the pressure of the stream; of whole rings about an axis."""
    # Whether the flow is steady: 1 if it is. Nothing judges it without `steady`.
    names = ["settled"] if params.steady is not None else []
    if params.box is None:
        names.append("drag_coefficient")  # by the cross-section of a sphere, the area of a plate
    if params.sphere is not None:
        names.append("pitot_ratio")  # pressure where the flow meets it, over that of Rayleigh
        far = params.boundaries["far"].state
        if far is not None and far.mach(params.gas) > 1.0:
            names.append("standoff")  # of the bow shock from the wall, over the radius
        if params.boundaries["wall"].temperature is not None:
            names.append("heat_ratio")  # heat flux there, over that of Fay and Riddell
    fields = (
        Field("force", (3,), "N"),
        Field("torque", (3,), "N m"),  # about the centre of a sphere, else about the origin
        Field("heat", (), "W"),
    )
    return Port(
        "body",
        fields=(*fields, *(Field(name, (), "1") for name in names)),
        lacks=() if "settled" in names else (("settled", "Give the gas a table steady."),),
    )


# On each line, where a front is; and the angle to x, about y, of the straight line that fits best
# through this front and all before it, 0 of the first.
FRONTS = Port(
    "fronts",
    fields=(
        POSITION,
        Field("distance", (), "m"),  # from where the line begins
        Field("angle", (), "rad"),
        # Whether there is one; else the distance is minus the line's length, and the angle of it
        # and all behind it is -π: what no front has.
        Field("found", (), "1"),
    ),
)

# Of bodies that carry clouds, all of them; forces are means over the step. Where a sector ends at a
# body's shoulder, the pressure of the gas at the start is taken to be on the back.
BODIES = Port(
    "bodies",
    fields=(
        POSITION,
        VELOCITY,
        Field("force", (3,), "N"),
        Field("torque", (3,), "N m"),  # about its centre
        Field("heat", (), "W"),  # into the body
        # Over ½ρU² and the area that faces the flow, of the state at the start and the body's
        # velocity there.
        Field("coefficient", (3,), "1"),
        Field("highest_pressure", (), "Pa"),  # on the wall
        Field("fresh_nodes", (), "1"),  # nodes of all clouds that came back since the start
    ),
)
# Nodes of the walls of those bodies, one body after another, each from upstream round to z.
SURFACE = Port(
    "surface",
    fields=(
        POSITION,
        Field("body", (), "1"),
        Field("angle", (), "rad"),  # at the centre, from upstream
        PRESSURE,
        Field("friction", (3,), "Pa"),
        Field("heat_flux", (), "W/m2"),  # into the body
        # Over that of Fay and Riddell where the stream at the start meets a sphere; 0 of others.
        Field("heat_ratio", (), "1"),
    ),
)


# Spheres that nodes do not resolve, as the partner has them, and what the gas does to them; a point
# is not turned, its torque is 0.
# The largest that the gas can take for points: the spacing of its nodes where they are coarsest.
PARTICLES = replace(shared.PARTICLES, requests=(Field("largest_diameter", (), "m"),))
DRIVEN = replace(MOTION, static=(*MOTION.static, RADIUS))
PARTICLE_LOAD = replace(LOAD, name="particle_load")
PARTICLE_HEAT = replace(HEAT, name="particle_heat")


def ports(params: MeshlessGasParams) -> Ports:
    """Ports taken and given."""
    known = params.riemann is not None or params.vortex is not None
    read = (*((PROBES,) if params.probes else ()), *((FRONTS,) if params.fronts else ()))
    felt = (WALL, body(params)) if has_walls(params) else ()
    gives = (BALANCE, *((ERROR,) if known else ()), *read, *felt)
    if params.particles is not None:
        return (PARTICLES,), (*gives, PARTICLE_LOAD, PARTICLE_HEAT)
    if params.moving is None:
        return (), gives
    driven = any(body.is_driven for body in params.moving.bodies)
    bodies = (BODIES, SURFACE, *((LOAD, HEAT) if driven else ()))
    return (DRIVEN,) if driven else (), (*gives, *bodies)


def initial(params: MeshlessGasParams) -> Fields:
    """What is stated of particles before there are nodes; layers round a body are not known yet."""
    if params.particles is None or params.box is None:
        return {}
    return {"particles.largest_diameter": np.array([params.box.spacing])}
