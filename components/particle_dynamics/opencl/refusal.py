"""Checks that a device can compute all that a lattice's parameters ask for."""

from quintet.components.particle_dynamics.params import ParticleLatticeParams
from quintet.components.shared.opencl.limits import Limit, refuse_wrong

# Every key of a lattice stands here, in `SUPPORTED`, or in the table of `limits`: a test fails
# if a new key is in neither.
SUPPORTED = frozenset(
    """lattice seven_roots damping frozen drive baths collision_rate seed boltzmann integrator
    courant substeps averages if_point_lost""".split()
)


def refuse_what_needs_the_processor(params: ParticleLatticeParams, device: str) -> None:
    """Refuse parameters that a device does not compute; see `refuse_wrong`."""
    refuse_wrong(limits(params), device)


def limits(params: ParticleLatticeParams) -> dict[str, Limit]:
    """Limits of keys on devices."""
    table = params.force_table
    return {"force_table": Limit(table, table is not None, "left out", "Give seven_roots")}
