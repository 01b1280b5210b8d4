"""Ports of bodies: loads in; motion, and optionally the loads of contacts, out."""

from quintet.components.dem_bodies.params import DemBodiesParams
from quintet.interfaces.component import Field, Port
from quintet.interfaces.manifest import Ports
from quintet.interfaces.ports import LOAD, MOTION, PLANAR_MOTION, VELOCITY

# Of all contacts of a body; the last item is the load on all planes together.
CONTACT = Port("contact", LOAD.fields)
# Of the view: the radius is that of spheres, 0 at corners; the body its number.
SHOWS = (VELOCITY, Field("radius", (), "m"), Field("body", (), "1"))


def ports(params: DemBodiesParams) -> Ports:
    """Ports taken and given."""
    motion = PLANAR_MOTION if params.dimensions == 2 else MOTION
    return (LOAD,), (motion, CONTACT) if params.contact_forces else (motion,)
