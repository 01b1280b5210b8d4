"""Checks that a device can compute all that a lattice's parameters ask for."""

from quintet.components.particle_dynamics.params import ParticleLatticeParams
from quintet.interfaces.errors import SceneError

# Every key of a lattice stands here, in `SUPPORTED`, or in the table of `limits`: a test fails
# if a new key is in neither.
SUPPORTED = frozenset(
    """lattice seven_roots damping frozen drive baths collision_rate seed boltzmann integrator
    courant substeps averages if_point_lost""".split()
)


def refuse_what_needs_the_processor(params: ParticleLatticeParams, device: str) -> None:
    """Refuse parameters that a device does not compute; pyopencl is not needed for it.

    Raises
    ------
    SceneError
        With all keys at fault, the values found, and what to do.
    """
    sentences = [
        f"on device {device}, {key} must be {right}; found {value}. {remedy}, "
        'or set device = "cpu".'
        for key, (value, is_wrong, right, remedy) in limits(params).items()
        if is_wrong
    ]
    if sentences:
        raise SceneError(sentences)


def limits(params: ParticleLatticeParams) -> dict[str, tuple[object, bool, str, str]]:
    """Keys that a device limits: the value, whether it is wrong, what is right, what to do."""
    table = params.force_table
    return {"force_table": (table, table is not None, "left out", "Give seven_roots")}
