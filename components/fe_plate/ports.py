"""What the structure takes and gives: loads at nodes of its surface; the motion of its faces."""

from quintet.components.fe_plate.params import FePlateParams
from quintet.interfaces.component import Field
from quintet.interfaces.manifest import Ports
from quintet.interfaces.ports import (
    FACE_ACTIVITY,
    FACES,
    NODE_GLUE,
    NODE_LOAD,
    NODE_MASS,
    TEMPERATURE,
    VELOCITY,
)

# Of the view, at the corners of outer faces: means of the elements that meet there.
SHOWS = (
    Field("von_mises", (), "Pa"),
    VELOCITY,
    Field("pressure", (), "Pa"),
    Field("plastic_strain", (), "1"),
    TEMPERATURE,
    Field("displacement", (3,), "m"),
)


def ports(_: FePlateParams) -> Ports:
    """Ports taken and given."""
    return (NODE_LOAD, NODE_MASS), (FACES, NODE_GLUE, FACE_ACTIVITY)
