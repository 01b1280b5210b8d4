"""Ports of bodies: loads in; motion, and optionally the loads of contacts, out."""

from dataclasses import replace

from quintet.components.dem_bodies.params import DemBodiesParams
from quintet.interfaces.component import Field, Port
from quintet.interfaces.manifest import Ports
from quintet.interfaces.ports import (
    CONTACT_ACTIVITY,
    CONTACT_FACES,
    CONTACT_LOAD,
    LOAD,
    MOTION,
    PLANAR_MOTION,
    VELOCITY,
)

UNTOUCHED = "set contact_with_faces = true"  # where a link needs contact with faces
# Of all contacts of a body; the last item is the load on all planes together.
CONTACT = Port("contact", LOAD.fields)
# The front of the largest group of touching bodies, and the share of all bodies in that group.
FRONT = Port("front_gauge", (Field("position", (), "m"), Field("share", (), "1")))
# Of the view: the radius is that of spheres, 0 at corners; the body its number.
SHOWS = (VELOCITY, Field("radius", (), "m"), Field("body", (), "1"))


def ports(params: DemBodiesParams) -> Ports:
    """Ports taken and given."""
    motion = PLANAR_MOTION if params.dimensions == 2 else MOTION
    takes, gives = (LOAD,), (motion, CONTACT) if params.contact_forces else (motion,)
    if params.front_gauge is not None:
        gives = (*gives, FRONT)
    if params.contact_with_faces:
        return (*takes, CONTACT_FACES, CONTACT_ACTIVITY), (*gives, CONTACT_LOAD)
    lacks = ((CONTACT_FACES.name, UNTOUCHED),)
    return takes, (replace(motion, lacks=lacks), *gives[1:])
