"""What a fluid requests before it is built: how surfaces are to be sampled."""

import math

import numpy as np

from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.setup.geometry import fluid_boxes
from quintet.interfaces.component import Array


def stated(params: SphFluidParams) -> dict[str, Array]:
    """Requests of the port `surface`: spacing, depth and inset of samples."""
    told = {
        "spacing": np.array([params.spacing]),
        "depth": np.array([sample_reach(params)]),
        "inset": np.array([params.boundary.sample_depth * params.spacing]),
    }
    if params.dimensions == 2:
        told["dimensions"] = np.array([2.0])
    return {f"surface.{name}": array for name, array in told.items()}


def sample_reach(params: SphFluidParams) -> float:
    """How far [m] samples reach below the outermost: as the kernel does, or all through a body."""
    reach = 2.0 * params.smoothing_length
    if not params.remove_inside_bodies:
        return reach
    # The volume of the samples says how much fluid the body displaces.
    return max(reach, *(math.dist(low, high) for low, high in fluid_boxes(params)))
