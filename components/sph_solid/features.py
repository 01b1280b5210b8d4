"""Optional physics as objects: which sums over pairs a scene needs."""

from quintet.components.shared.threads import Team
from quintet.components.sph_solid.method import method
from quintet.components.sph_solid.pair_sums import CurrentSums, PairSums
from quintet.components.sph_solid.params import SphSolidParams

PENALTY = 1.0  # α of Ganzenmüller's force against motion that no deformation sees


def pair_sums(params: SphSolidParams, team: Team) -> PairSums:
    """Sums over particles, over rings, or over the neighbours of the start."""
    if params.axisymmetric:
        # Scenes without rings do not import them.
        from quintet.components.sph_solid.axisymmetric import ImageLists

        return CurrentSums(ImageLists(params.length, team), team)
    if method(params).total_lagrangian:
        # Nor sums over the neighbours of the start.
        from quintet.components.sph_solid.reference_sums import ReferenceSums

        return ReferenceSums(PENALTY, params.spacing, team)
    return CurrentSums(lambda state, lists: lists.arrays, team)
