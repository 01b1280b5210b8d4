"""What a fluid requests before it is built: how surfaces are to be sampled."""

import numpy as np

from quintet.components.sph_fluid.params import SphFluidParams
from quintet.interfaces.component import Array


def stated(params: SphFluidParams) -> dict[str, Array]:
    """Requests of the port `surface`: spacing, depth and inset of samples."""
    told = {
        "spacing": np.array([params.spacing]),
        "depth": np.array([2.0 * params.smoothing_length]),  # the radius of the kernel
        "inset": np.array([params.boundary.sample_depth * params.spacing]),
    }
    if params.dimensions == 2:
        told["dimensions"] = np.array([2.0])
    return {f"surface.{name}": array for name, array in told.items()}
