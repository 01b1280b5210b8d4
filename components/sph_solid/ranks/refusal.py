"""What of a solid cannot be shared out yet."""

from quintet.components.sph_solid.method import method
from quintet.components.sph_solid.params import SphSolidParams
from quintet.interfaces.errors import SceneError


def refuse_what_needs_one_rank(params: SphSolidParams, ranks: int) -> None:
    """Raise where a solid on several ranks has a part that computes on one.

    Raises
    ------
    SceneError
        With the key, and what to do.
    """
    wrong = {
        "axisymmetric": params.axisymmetric,
        "total_lagrangian": method(params).total_lagrangian,
    }
    for key, is_wrong in wrong.items():
        if is_wrong:
            raise SceneError(
                f"{key} must be false of a solid on {ranks} ranks; it is true, as it is of elastic "
                "bodies that do not say so. Set it to false, or take one rank."
                if key == "total_lagrangian"
                else f"{key} must be false of a solid on {ranks} ranks; it is true. Take one rank."
            )
