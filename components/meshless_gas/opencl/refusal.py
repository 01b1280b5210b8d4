"""Checks that a device can compute all that a gas's parameters ask for."""

from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.shared.opencl.limits import Limit, refuse_wrong

# Every key of a gas stands here, in `SUPPORTED`, or in the table of `limits`: a test fails
# if a new key is in neither.
SUPPORTED = frozenset(
    """gas dimensions axisymmetric box sphere plate initial zones riemann vortex neighbours order
    limiter limiter_threshold courant viscous local_steps steady probes fronts particles
    boundaries.kind boundaries.state boundaries.total boundaries.pressure boundaries.velocity
    boundaries.temperature""".split()
)


def refuse_what_needs_the_processor(params: MeshlessGasParams, device: str) -> None:
    """Refuse parameters that a device does not compute; see `refuse_wrong`."""
    refuse_wrong(limits(params), device)


def limits(params: MeshlessGasParams) -> dict[str, Limit]:
    """Limits of keys on devices."""
    rarefied = [n for n, boundary in params.boundaries.items() if boundary.accommodation]
    bodies = params.moving.bodies if params.moving is not None else ()
    return {
        "moving": Limit(
            f"bodies: {len(bodies)}", params.moving is not None, "left out", "Remove it"
        ),
        "boundaries.accommodation": Limit(
            f"some of {', '.join(rarefied)}", bool(rarefied), "left out", "Remove it"
        ),
    }  # fmt: skip
