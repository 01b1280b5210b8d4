"""What of a fluid cannot be computed on a device yet."""

from quintet.components.sph_fluid.params import SphFluidParams
from quintet.interfaces.errors import SceneError


def refuse_what_needs_the_processor(params: SphFluidParams, device: str) -> None:
    """Raise where a fluid on a device has a part that the processor alone computes.

    Raises
    ------
    SceneError
        With all the keys, and what to do.
    """
    edge, kinematic = params.boundary, params.viscosity.kinematic
    rubs = params.mirrored and kinematic > 0.0 and edge.wall_viscosity_factor > 0.0
    wrong = {
        "boundary.method": (edge.method, edge.method == "potential", "mdbc or dbc"),
        "boundary.symmetry": (list(edge.symmetry), bool(edge.symmetry), "empty"),
        "boundary.periodic": (list(edge.periodic), bool(edge.periodic), "empty"),
        "boundary.inflow": (len(edge.inflow), bool(edge.inflow), "empty"),
        "boundary.outflow": (len(edge.outflow), bool(edge.outflow), "empty"),
        "boundary.motion": ("a motion", edge.motion is not None, "left out"),
        "boundary.pistons": (len(edge.pistons), bool(edge.pistons), "empty"),
        "viscosity.kinematic": (kinematic, rubs, "0 with mirrored walls that rub"),
        "integration": (params.integration, params.integration != "extrapolated", "extrapolated"),
        "xsph": (params.xsph, params.xsph > 0.0, "0"),
        "shepard_every": (params.shepard_every, params.shepard_every > 0, "0"),
        "acoustic_damper": (params.acoustic_damper, params.acoustic_damper > 0.0, "0"),
    }
    mistakes = [
        f"{key} must be {right} of a fluid on the device {device}; found {value}. Change it, or "
        'set device = "cpu".'
        for key, (value, is_wrong, right) in wrong.items()
        if is_wrong
    ]
    if mistakes:
        raise SceneError(mistakes)
