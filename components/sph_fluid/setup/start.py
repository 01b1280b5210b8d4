"""What a fluid states before it is built: how surfaces are sampled, and where it begins."""

import numpy as np

from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.setup.geometry import FACES, Box, closed_faces, slab_thickness
from quintet.interfaces.component import Array


def stated(params: SphFluidParams) -> dict[str, Array]:
    """States of the port `surface`: spacing, depth and inset of samples; water, tank, obstacles."""
    edge, length = params.boundary, params.smoothing_length
    closed = (*closed_faces(params), *edge.symmetry)
    told = {
        "spacing": np.array([params.spacing]),
        "depth": np.array([2.0 * length]),  # the radius of the kernel
        "inset": np.array([edge.sample_depth * params.spacing]),
        # What bodies stand in is removed where a scene asks for it.
        "wet": _corners(() if params.remove_inside_bodies else params.boxes),
        "solid": _corners(edge.solids),
        "tank": _corners(() if edge.tank is None else (edge.tank,)),
        "closed": np.array([[float(face in closed) for face in FACES]]),
    }
    if params.dimensions == 2:
        told |= {
            "dimensions": np.array([2.0]),
            "thickness": np.array([slab_thickness(params)]),
        }
    return {f"surface.{name}": array for name, array in told.items()}


def _corners(boxes: tuple[Box, ...]) -> Array:
    """Lowest and highest corners (n, 2, 3) m."""
    return np.array(boxes, np.float64).reshape(-1, 2, 3)
