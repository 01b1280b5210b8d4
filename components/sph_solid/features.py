"""Optional physics as objects: which sums over pairs a scene needs."""

from typing import TYPE_CHECKING

from quintet.components.shared.materials.solid import Solid
from quintet.components.shared.threads import Team
from quintet.components.sph_solid.method import method
from quintet.components.sph_solid.neighbours import symmetry_planes
from quintet.components.sph_solid.pair_sums import CurrentSums, PairSums
from quintet.components.sph_solid.params import SphSolidParams
from quintet.components.sph_solid.ranks.method import Ranks
from quintet.components.sph_solid.ranks.one import OneRank
from quintet.components.sph_solid.state import State
from quintet.interfaces.component import Fields, Keys, Resources

if TYPE_CHECKING:
    from quintet.components.sph_solid.partner_faces import PartnerFaces

PENALTY = 1.0  # α of Ganzenmüller's force against motion that no deformation sees


def ranks(params: SphSolidParams, resources: Resources) -> Ranks:
    """The ranks that share the particles, with planes of symmetry."""
    communicator, planes = resources.communicator, symmetry_planes(params)
    if communicator is None or communicator.size == 1:
        return OneRank(planes)
    # Only a solid of several ranks loads mpi4py.
    from quintet.components.sph_solid.ranks.refusal import refuse_what_needs_one_rank
    from quintet.components.sph_solid.ranks.several import SeveralRanks

    refuse_what_needs_one_rank(params, communicator.size)
    return SeveralRanks(communicator, planes)


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


def partner_faces(
    static: Fields, joined: Keys, state: State, laws: list[Solid], spacing: float
) -> "PartnerFaces | None":
    """Faces of a partner's mesh that particles touch; None where no link joins them."""
    if "contact_faces" not in joined:
        return None
    # Scenes without contact of two components do not import it.
    from quintet.components.sph_solid.partner_faces import PartnerFaces

    return PartnerFaces(static, state, laws, spacing)
