"""What of a fluid cannot be shared out yet."""

from quintet.components.sph_fluid.params import SphFluidParams
from quintet.interfaces.errors import SceneError


def refuse_what_needs_one_rank(params: SphFluidParams, ranks: int) -> None:
    """Raise where a fluid on several ranks has a part that computes on one.

    Raises
    ------
    SceneError
        With the key, and what to do.
    """
    edge = params.boundary
    limits = {
        "boundary.method": (edge.method, edge.method == "potential", "mdbc or dbc"),
        "boundary.periodic": (edge.periodic, bool(edge.periodic), "empty"),
        "boundary.inflow": (len(edge.inflow), bool(edge.inflow), "empty"),
        "boundary.outflow": (len(edge.outflow), bool(edge.outflow), "empty"),
    }
    for key, (value, is_wrong, right) in limits.items():
        if is_wrong:
            raise SceneError(
                f"{key} must be {right} of a fluid on {ranks} ranks; found {value}. Change it, or "
                "take one rank."
            )
