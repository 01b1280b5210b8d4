"""Checks that a device can compute all that the parameters of bodies ask for."""

from quintet.components.shared.opencl.limits import Limit, refuse_wrong
from quintet.components.sph_solid.method import method
from quintet.components.sph_solid.params import SphSolidParams

# Every key of the bodies stands here, in `SUPPORTED`, or in the table of `limits`: a test fails
# if a new key is in neither.
SUPPORTED = frozenset(
    """spacing bodies dimensions axisymmetric smoothing symmetry fixed glued gravity gauges levels
    courant viscosity_linear viscosity_quadratic kernel_correction""".split()
)


def refuse_what_needs_the_processor(params: SphSolidParams, device: str) -> None:
    """Refuse parameters that a device does not compute; see `refuse_wrong`."""
    refuse_wrong(limits(params), device)


def limits(params: SphSolidParams) -> dict[str, Limit]:
    """Limits of keys on devices."""
    faces = params.contact_with_faces
    stress, keeps = params.artificial_stress, method(params).total_lagrangian
    by_default = " by default, for all materials are elastic"
    value = f"{str(keeps).lower()}{by_default if params.total_lagrangian is None else ''}"
    remedy = "Set it to false"
    return {
        "contact_with_faces": Limit(str(faces).lower(), faces, "false", remedy),
        "artificial_stress": Limit(f"{stress:g}", stress > 0.0, "0", "Remove it"),
        "total_lagrangian": Limit(value, keeps, "false", remedy),
    }
