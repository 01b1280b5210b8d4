"""Checks that a device can compute all that a gas's parameters ask for."""

from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.errors import SceneError

# Every key of a gas stands here, in `SUPPORTED`, or in the table of `limits`: a test fails
# if a new key is in neither.
SUPPORTED = frozenset(
    """gas dimensions axisymmetric box sphere plate initial zones riemann vortex neighbours order
    limiter limiter_threshold courant viscous local_steps steady probes fronts particles
    boundaries.kind boundaries.state boundaries.total boundaries.pressure boundaries.velocity
    boundaries.temperature""".split()
)


def refuse_what_needs_the_processor(params: MeshlessGasParams, device: str) -> None:
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


def limits(params: MeshlessGasParams) -> dict[str, tuple[object, bool, str, str]]:
    """Keys that a device limits: the value, whether it is wrong, what is right, what to do."""
    rarefied = [n for n, boundary in params.boundaries.items() if boundary.accommodation]
    bodies = params.moving.bodies if params.moving is not None else ()
    return {
        "moving": (
            f"{len(bodies)} bodies", params.moving is not None, "left out", "Remove it"
        ),
        "boundaries.accommodation": (
            f"some of {', '.join(rarefied)}", bool(rarefied), "left out", "Remove it"
        ),
    }  # fmt: skip
