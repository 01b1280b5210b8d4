"""Checks that a device can compute all that a fluid's parameters ask for."""

from quintet.components.shared.opencl.limits import Limit, refuse_wrong
from quintet.components.sph_fluid.params import SphFluidParams

# Every key of a fluid stands here, in `SUPPORTED`, or in the table of `limits`: a test fails
# if a new key is in neither.
SUPPORTED = frozenset(
    """material xsph shepard_every acoustic_damper spacing sound_speed fluid initial lost_limit
    remove_inside_bodies dimensions kernel smoothing staggered density gravity density_diffusion
    negative_pressure precision integration courant gauges wave viscosity.artificial
    viscosity.kinematic viscosity.form boundary.walls boundary.symmetry boundary.inflow boundary.outflow
    boundary.open_faces boundary.wall_velocity boundary.obstacles boundary.meshes boundary.motion
    boundary.pistons boundary.damping boundary.wall_offset boundary.sample_depth
    boundary.wall_viscosity_factor boundary.lubrication_films boundary.roughness
    boundary.potential_stiffness boundary.potential_exponent""".split()
)


def refuse_what_needs_the_processor(params: SphFluidParams, device: str) -> None:
    """Refuse parameters that a device does not compute; see `refuse_wrong`."""
    refuse_wrong(limits(params), device)


def limits(params: SphFluidParams) -> dict[str, Limit]:
    """Limits of keys on devices."""
    edge = params.boundary
    counts = {name: len(getattr(edge, name)) for name in ("periodic",)}
    is_potential = edge.method == "potential"
    return {
        f"boundary.{name}": Limit(count, count > 0, "empty", "Remove them")
        for name, count in counts.items()
    } | {"boundary.method": Limit(edge.method, is_potential, "mdbc or dbc", "Change it")}
