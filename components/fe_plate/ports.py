"""What the structure takes and gives: loads at nodes of its surface; the motion of its faces."""

from dataclasses import replace

from quintet.components.fe_plate.erosion import eroding_parts
from quintet.components.fe_plate.params import FePlateParams
from quintet.interfaces.component import Field, Port
from quintet.interfaces.manifest import Ports
from quintet.interfaces.ports import (
    ACTIVE,
    CONTACT_ACTIVITY,
    CONTACT_FACES,
    CONTACT_LOAD,
    CONTACT_SURFACE,
    CONTACT_SURFACE_LOAD,
    FACE_ACTIVITY,
    FACES,
    NODE_GLUE,
    NODE_LOAD,
    NODE_MASS,
    OPEN_FACES,
    PLANAR_CONTACT_FACES,
    PLANAR_CONTACT_SURFACE,
    PLANAR_FACES,
    PLANAR_NODE_GLUE,
    TEMPERATURE,
    VELOCITY,
)

POSITION = Field("position", (3,), "m")
PRESSURE = Field("pressure", (), "Pa")
VON_MISES = Field("von_mises", (), "Pa")
PLASTIC_STRAIN = Field("plastic_strain", (), "1")
DAMAGE = Field("damage", (), "1")
DISPLACEMENT = Field("displacement", (3,), "m")  # from where nodes were at the start
NODE_GAUGE = Port("node_gauge", (POSITION, VELOCITY))
ELEMENT_GAUGE = Port(
    "element_gauge", (VON_MISES, PRESSURE, PLASTIC_STRAIN, TEMPERATURE, DAMAGE, ACTIVE)
)
PART_GAUGE = Port(
    "part_gauge",
    (
        VELOCITY,  # momentum over mass
        Field("kinetic", (), "J"),
        Field("internal", (), "J"),  # strain, plastic work, stabilisation
        Field("eroded", (), "J"),  # of it that of eroded elements
    ),
)
NODE_SET_GAUGE = Port("node_set_gauge", (POSITION, VELOCITY))
ELEMENT_SET_GAUGE = Port(
    "element_set_gauge", (*PART_GAUGE.fields, VON_MISES, PLASTIC_STRAIN, DAMAGE)
)
UNTOUCHED = "set contact_with_faces = true"  # where a link needs contact with faces
# Of the view, at the corners of outer faces: means of the elements that meet there.
SHOWS = (VON_MISES, VELOCITY, PRESSURE, PLASTIC_STRAIN, TEMPERATURE, DAMAGE, DISPLACEMENT)


def ports(params: FePlateParams) -> Ports:
    """Ports taken and given."""
    gauges = params.gauges
    switched = (
        (NODE_GAUGE, bool(gauges.node_gauges)),
        (ELEMENT_GAUGE, bool(gauges.element_gauges)),
        (PART_GAUGE, gauges.part_gauge),
        (NODE_SET_GAUGE, bool(gauges.node_set_gauges)),
        (ELEMENT_SET_GAUGE, bool(gauges.element_set_gauges)),
    )
    measured = tuple(port for port, on in switched if on)
    planar = params.dimensions == 2
    mesh = (PLANAR_FACES, PLANAR_NODE_GLUE) if planar else (FACES, NODE_GLUE)
    touched = (PLANAR_CONTACT_SURFACE if planar else CONTACT_SURFACE, OPEN_FACES)
    taken = (NODE_LOAD, NODE_MASS, *((CONTACT_SURFACE_LOAD,) if eroding_parts(params) else ()))
    if not params.contact_with_faces:
        activity = replace(FACE_ACTIVITY, lacks=((CONTACT_FACES.name, UNTOUCHED),))
        return taken, (*mesh, activity, *touched, *measured)
    touching = PLANAR_CONTACT_FACES if planar else CONTACT_FACES
    taken = *taken, touching, CONTACT_ACTIVITY
    return taken, (*mesh, FACE_ACTIVITY, *touched, CONTACT_LOAD, *measured)
