"""Where there can be films in narrow gaps."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from quintet.components.sph_fluid.params import SphFluidParams


def why_no_films(params: "SphFluidParams") -> str:
    """Why a fluid can have no films; "" if it can."""
    if params.boundary.method != "mdbc":
        return f"boundary.method {params.boundary.method} knows none"
    if params.dimensions == 2:
        return "in two dimensions water cannot flow in from the side"
    if params.boundary.symmetry:
        return "films know no planes of symmetry"
    return ""
