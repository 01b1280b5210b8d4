"""What of a lattice cannot be shared out."""

from quintet.components.particle_dynamics.params import ParticleLatticeParams
from quintet.interfaces.errors import SceneError


def refuse_what_needs_one_rank(params: ParticleLatticeParams, ranks: int) -> None:
    """Raise SceneError where several ranks cannot share the points out."""
    damping = params.damping
    if damping is not None and damping.range == "all" and damping.coefficient > 0.0:
        raise SceneError(
            "damping: the range all needs every pair of points, so the lattice cannot be shared "
            f"out; found {ranks} ranks. Take one rank, or the range cut-off."
        )
