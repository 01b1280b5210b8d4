"""Checks that a device can compute all that the parameters of bodies ask for."""

from quintet.components.shared.opencl.limits import Limit, refuse_wrong
from quintet.components.sph_solid.params import SphSolidParams

# Every key of the bodies stands here, in `SUPPORTED`, or in the table of `limits`: a test fails
# if a new key is in neither.
SUPPORTED = frozenset(
    """spacing bodies dimensions axisymmetric smoothing symmetry fixed glued gravity gauges levels
    courant viscosity_linear viscosity_quadratic kernel_correction total_lagrangian
    contact_with_faces""".split()
)


def refuse_what_needs_the_processor(params: SphSolidParams, device: str) -> None:
    """Refuse parameters that a device does not compute; see `refuse_wrong`."""
    refuse_wrong(limits(params), device)


def limits(params: SphSolidParams) -> dict[str, Limit]:
    """Limits of keys on devices."""
    stress = params.artificial_stress
    return {
        "artificial_stress": Limit(f"{stress:g}", stress > 0.0, "0", "Remove it"),
    }
