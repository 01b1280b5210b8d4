"""The ports that solvers of several kinds share, so that any of them fits any link."""

import json
from collections.abc import Container, Iterable
from dataclasses import asdict, replace
from typing import Any

from quintet.interfaces.component import Field, Port
from quintet.interfaces.units import UNITS, add_unit

POSITION = Field("position", (3,), "m", rate="velocity")
VELOCITY = Field("velocity", (3,), "m/s")
FORCE = Field("force", (3,), "N", "impulse", works_with="velocity")
TORQUE = Field("torque", (3,), "N m", "impulse", works_with="angular_velocity")
ORIENTATION = Field("orientation", (4,), "1", rate="angular_velocity", kind="rotation")
ANGULAR_VELOCITY = Field("angular_velocity", (3,), "rad/s")
TEMPERATURE = Field("temperature", (), "K")
HEAT_FLOW = Field("heat_flow", (), "W", "impulse")  # into the side that takes it
# Of items that may die, as a face that erodes: 1 while the item exists, then 0, permanently; inner
# faces of a mesh begin at 0, until erosion opens them.
ACTIVE = Field("active", (), "1", kind="flag")
RANK = Field("rank", (), "1")  # in views of a component of several MPI ranks: who owns each point

# Moving surface samples, whoever moves them: taken by fluids, which push back with a force on each.
SURFACE = Port(
    "surface",
    fields=(POSITION, VELOCITY),
    items="partner",
    static=(
        Field("normal", (3,), "1"),  # outward, at the start
        Field("volume", (), "m3"),  # that the sample stands for
        Field("body", (), "1", labels=True),  # number of the body (or mesh) it belongs to
    ),
    requests=(
        Field("spacing", (), "m"),
        Field("depth", (), "m"),  # how far below the surface samples are wanted
        Field("inset", (), "m"),  # how far below it the outermost lie; half a spacing if not said
    ),
)
# The same with the mirror image of each sample through its surface, for fluids that ask for it.
MIRRORED_SURFACE = replace(SURFACE, fields=(*SURFACE.fields, Field("mirror", (3,), "m")))
SURFACE_LOAD = Port("surface_load", fields=(FORCE,), items="partner")
# Still water in which bodies may float, with gravity along -z: `Manifest.surroundings` of a fluid
# that removes the water inside them.
STILL_WATER = (
    Field("water_lowest", (3,), "m"),  # corners of the box of water
    Field("water_highest", (3,), "m"),
    Field("water_density", (), "kg/m3"),
)

# Said by solvers in two dimensions: 2. All that they hold lies in the plane of x and z and is 1 m
# deep along y, so that a body's volume is its area times 1 m. Positions keep three numbers; a
# surface is sampled by one row of points in the plane, each standing for 1 m of depth, and forces
# and torques are those on 1 m. Solvers that do not say it have three dimensions.
DIMENSIONS = Field("dimensions", (), "1")

# Rigid bodies: given by whatever moves them, loaded by a force and a torque about the centre.
MOTION = Port(
    "motion",
    fields=(
        POSITION,
        VELOCITY,
        ORIENTATION,  # unit quaternion w, x, y, z: body -> world
        ANGULAR_VELOCITY,
    ),
    static=(Field("mass", (), "kg"),),
)
PLANAR_MOTION = replace(MOTION, static=(*MOTION.static, DIMENSIONS))
# Of round bodies, for partners that have such bodies themselves.
RADIUS = Field("radius", (), "m")
LOAD = Port("load", fields=(FORCE, TORQUE))
# Into each body, from a flow around it.
HEAT = Port("heat", fields=(HEAT_FLOW,))
# Particles in a flow that is coarser than they are. One that stands for a number of equal ones is
# described, loaded and heated as all of them together; its diameter is that of one.
PARTICLES = Port(
    "particles",
    fields=(
        POSITION,
        VELOCITY,
        Field("acceleration", (3,), "m/s2"),  # by all but the load, as of gravity
        TEMPERATURE,
        Field("diameter", (), "m"),
        Field("launched", (), "1", kind="flag"),  # 0: not there yet
    ),
    static=(
        Field("mass", (), "kg"),
        Field("heat_capacity", (), "J/K"),
        Field("number", (), "1"),  # that it stands for
    ),
)

# Meshes: faces that move, loaded at their nodes.
MESH = (
    Field("start", (3,), "m"),  # position of each node at the start
    Field("corner", (4,), "1"),  # (faces, 4) nodes of each face; -1 ends a triangle
)
FACES = Port("faces", fields=(POSITION, VELOCITY), static=MESH)
# The same of meshes in two dimensions, whose faces are edges: two nodes, then -1 twice. Edges go
# round a body from x to z, so that (dz, -dx) is the outward normal of an edge along (dx, dz).
PLANAR_FACES = replace(FACES, static=(*MESH, DIMENSIONS))
NODE_LOAD = Port("node_load", fields=(FORCE,), static=(Field("added_mass", (), "kg"),))

# Glue: particles that hang on the nodes of a mesh. Velocities cross as impulses, that is as
# displacements over the window, so that both sides move by the same amount.
DISPLACEMENT_RATE = Field("velocity", (3,), "m/s", "impulse")
NODE_GLUE = Port("node_glue", fields=(DISPLACEMENT_RATE,), static=MESH)
PLANAR_NODE_GLUE = replace(NODE_GLUE, static=(*MESH, DIMENSIONS))
GLUED = Port("glued", fields=(DISPLACEMENT_RATE,))
GLUED_LOAD = Port(
    "glued_load",
    fields=(FORCE,),
    static=(Field("position", (3,), "m"), Field("mass", (), "kg")),
)

# Of meshes whose faces may erode, and of the particles that hang on them: these are then free, and
# the mesh gets the mass that is left on its nodes.
FACE_ACTIVITY = Port("face_activity", fields=(ACTIVE,))
GLUE_ACTIVITY = Port("glue_activity", fields=(ACTIVE,))
NODE_MASS = Port("node_mass", fields=(Field("added", (), "kg"),))

# Contact: particles, bodies or a mesh touch the faces of a mesh. The mesh gives its faces and what
# the stiffness of contact follows from; the other side computes the forces and gives their reaction
# on the nodes. Forces follow from places at the begin of a window, at which the mesh is told of
# them; velocities cross as displacements over the last window, so that work is counted by what
# moved. Meshes that may erode take contact's forces by a port of their own. When `sample` is asked
# for `inner` (1), such a mesh answers with all static fields of CONTACT_SURFACE: first the nodes
# and faces that it described, then those that erosion may open. OPEN_FACES has a row for each face.
PLACE = replace(POSITION, rate="")
LAYER = (
    Field("mass", (), "kg"),  # of each node
    Field("bulk", (), "Pa"),  # K behind each face
    Field("shear", (), "Pa"),  # G
    Field("thickness", (), "m"),  # of the element behind each face: volume over area
    Field("step", (), "s"),  # one row: stable step of the mesh without contact
)
CONTACT_SURFACE = Port("contact_surface", fields=(PLACE, DISPLACEMENT_RATE), static=(*MESH, *LAYER))
PLANAR_CONTACT_SURFACE = replace(CONTACT_SURFACE, static=(*CONTACT_SURFACE.static, DIMENSIONS))
CONTACT_SURFACE_LOAD = Port("contact_surface_load", fields=(FORCE,))
OPEN_FACES = Port("open_faces", fields=(ACTIVE,))  # whether each face is part of the surface now
CONTACT_FACES = Port(
    "contact_faces",
    fields=(PLACE, DISPLACEMENT_RATE),
    items="partner",
    static=(
        # Closed: the last node of a triangle stands twice, edges go forth and back.
        Field("corner", (4,), "1", labels=True),
        *LAYER,
        Field("width", (), "m"),  # of each face, its shortest side at the start
        Field("friction", (), "1"),  # of each face, Coulomb's coefficient
        Field("stiffness", (), "1"),  # of each face, scale of the penalty stiffness
        Field("safety", (), "1"),  # one row: share of the predicted stable step
        # One row: points across a particle that bear its force; 0: the component decides.
        Field("points", (), "1"),
    ),
)
PLANAR_CONTACT_FACES = replace(CONTACT_FACES, static=(*CONTACT_FACES.static, DIMENSIONS))
CONTACT_ACTIVITY = Port("contact_activity", fields=(ACTIVE,), items="partner")  # of each face
CONTACT_LOAD = Port("contact_load", fields=(FORCE,), items="partner")  # on each node

# Conduction: one side holds its wall at a temperature, the other answers with the heat that it
# conducts away. Walls are points (the bath of a particle lattice), meshes take heat at nodes.
NODE_TEMPERATURE = Port("node_temperature", fields=(TEMPERATURE,), static=MESH)
NODE_HEAT = Port("node_heat", fields=(HEAT_FLOW,))
WALL_TEMPERATURE = Port("wall_temperature", fields=(TEMPERATURE,))
WALL_HEAT = Port(  # what leaves through the wall
    "wall_heat", fields=(HEAT_FLOW,), static=(Field("position", (3,), "m"),)
)


def only_fields(ports: Iterable[Port], keys: Container[str]) -> tuple[Port, ...]:
    """Ports with those of their fields whose key ``"port.field"`` is among `keys`."""
    ports_left = []
    for port in ports:
        fields = tuple(field for field in port.fields if f"{port.name}.{field.name}" in keys)
        if fields:
            ports_left.append(replace(port, fields=fields))
    return tuple(ports_left)


# Attributes of a port that a recording holds.
RECORDED = ("name", "fields", "items", "static")


def to_json(ports: Iterable[Port]) -> str:
    """Write ports that a component gives as text, for a recording."""
    tables = [asdict(port) for port in ports]
    return json.dumps([{key: table[key] for key in RECORDED} for table in tables])


def from_json(text: str) -> tuple[Port, ...]:
    """Read ports that were written as text."""
    tables = json.loads(text)
    return tuple(Port(**{key: _fields(table[key]) for key in RECORDED}) for table in tables)


def _fields(value: Any) -> Any:
    if not isinstance(value, list):
        return value
    for entry in value:
        if entry["unit"] not in UNITS:  # of a kind that is not installed here
            add_unit(entry["unit"], f"{entry['unit']} s" if entry["centring"] == "impulse" else "")
    return tuple(Field(**{**entry, "shape": tuple(entry["shape"])}) for entry in value)
