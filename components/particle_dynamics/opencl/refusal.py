"""Checks that a device can compute all that a lattice's parameters ask for."""

from quintet.components.particle_dynamics.params import ParticleLatticeParams
from quintet.components.shared.opencl.limits import Limit, refuse_wrong
from quintet.interfaces.errors import SceneError

# Every key of a lattice stands here, in `SUPPORTED`, or in the table of `limits`: a test fails
# if a new key is in neither.
SUPPORTED = frozenset(
    """lattice seven_roots damping frozen drive baths collision_rate seed boltzmann integrator
    courant substeps averages if_point_lost""".split()
)


def refuse_what_needs_the_processor(params: ParticleLatticeParams, device: str) -> None:
    """Refuse parameters that a device does not compute; see `refuse_wrong`."""
    refuse_wrong(limits(params), device)


def refuse_what_needs_one_rank(params: ParticleLatticeParams, ranks: int) -> None:
    """Refuse collisions, which need one rank.

    Raises
    ------
    SceneError
        With the key, and what to do.
    """
    rate = params.collision_rate
    if rate > 0.0:
        raise SceneError(
            f"collision_rate must be 0 on devices of {ranks} ranks, as collisions change one "
            f'another\'s velocities; found {rate:g}. Set ranks = 1, or device = "cpu".'
        )


def limits(params: ParticleLatticeParams) -> dict[str, Limit]:
    """Limits of keys on devices."""
    table = params.force_table
    return {"force_table": Limit(table, table is not None, "left out", "Give seven_roots")}
