"""Checks that a device can compute all that a fluid's parameters ask for."""

from quintet.components.sph_fluid.params import SphFluidParams
from quintet.interfaces.errors import SceneError

# Every key of a fluid stands here, in `SUPPORTED`, or in the table of `limits`: a test fails
# if a new key is in neither.
SUPPORTED = frozenset(
    """material xsph shepard_every acoustic_damper spacing sound_speed fluid initial lost_limit
    remove_inside_bodies dimensions kernel smoothing staggered density gravity density_diffusion
    negative_pressure precision integration courant gauges wave viscosity.artificial
    viscosity.kinematic viscosity.form boundary.walls boundary.symmetry
    boundary.open_faces boundary.wall_velocity boundary.obstacles boundary.meshes boundary.motion
    boundary.pistons boundary.damping boundary.wall_offset boundary.sample_depth
    boundary.wall_viscosity_factor boundary.lubrication_films boundary.roughness
    boundary.potential_stiffness boundary.potential_exponent""".split()
)


def refuse_what_needs_the_processor(params: SphFluidParams, device: str) -> None:
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


def limits(params: SphFluidParams) -> dict[str, tuple[object, bool, str, str]]:
    """Keys that a device limits: the value, whether it is wrong, what is right, what to do."""
    edge = params.boundary
    lists = {
        f"boundary.{name}": (len(getattr(edge, name)), bool(getattr(edge, name)), "empty")
        for name in ("periodic", "inflow", "outflow")
    }
    choices = {
        "boundary.method": (edge.method, edge.method == "potential", "mdbc or dbc"),
    }
    return {key: (*limit, "Remove them") for key, limit in lists.items()} | {
        key: (*limit, "Change it") for key, limit in choices.items()
    }
