"""Checks that a device can compute all that the parameters of bodies ask for."""

from quintet.components.sph_solid.method import method
from quintet.components.sph_solid.params import SphSolidParams
from quintet.interfaces.errors import SceneError

# Every key of the bodies stands here, in `SUPPORTED`, or in the table of `limits`: a test fails
# if a new key is in neither.
SUPPORTED = frozenset(
    """spacing bodies dimensions axisymmetric smoothing symmetry fixed glued gravity gauges levels
    courant viscosity_linear viscosity_quadratic kernel_correction""".split()
)


def refuse_what_needs_the_processor(params: SphSolidParams, device: str) -> None:
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


def limits(params: SphSolidParams) -> dict[str, tuple[object, bool, str, str]]:
    """Keys that a device limits: the value, whether it is wrong, what is right, what to do."""
    faces = params.contact_with_faces
    stress, keeps = params.artificial_stress, method(params).total_lagrangian
    by_default = " by default, for all materials are elastic"
    value = f"{str(keeps).lower()}{by_default if params.total_lagrangian is None else ''}"
    remedy = "Set it to false"
    return {
        "contact_with_faces": (str(faces).lower(), faces, "false", remedy),
        "artificial_stress": (f"{stress:g}", stress > 0.0, "0", "Remove it"),
        "total_lagrangian": (value, keeps, "false", remedy),
    }
