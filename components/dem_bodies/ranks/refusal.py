"""What of bodies cannot be shared out yet."""

from quintet.components.dem_bodies.params import DemBodiesParams
from quintet.components.dem_bodies.shapes.solid import is_ball
from quintet.components.shared.contact.one_rank import refuse_faces
from quintet.interfaces.errors import SceneError


def refuse_what_needs_one_rank(params: DemBodiesParams, ranks: int) -> None:
    """Raise SceneError where several ranks cannot share the bodies out."""
    if not any(map(is_ball, params.placed.kinds)):
        raise SceneError(
            "ranks must be 1 where no body is a single sphere, as only spheres are shared out; "
            f"there are {ranks}. Take one rank and several threads."
        )
    if params.contact_with_faces:
        refuse_faces("bodies", ranks)
