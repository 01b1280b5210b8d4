"""What of a solid cannot be shared out yet."""

from quintet.components.shared.contact.one_rank import refuse_faces
from quintet.components.sph_solid.params import SphSolidParams
from quintet.interfaces.errors import SceneError


def refuse_what_needs_one_rank(params: SphSolidParams, ranks: int) -> None:
    """Raise where a solid on several ranks has a part that computes on one.

    Raises
    ------
    SceneError
        With the key, and what to do.
    """
    if params.axisymmetric:
        raise SceneError(
            f"axisymmetric must be false of a solid on {ranks} ranks; it is true. Take one rank."
        )
    if params.contact_with_faces:
        refuse_faces("a solid", ranks)
