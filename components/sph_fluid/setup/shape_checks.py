"""What concerns fluid in other shapes than boxes; imported only by a scene that has some."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from quintet.components.sph_fluid.setup.geometry import Box
from quintet.components.sph_fluid.setup.shape_filling import fill_shape

if TYPE_CHECKING:
    from quintet.components.sph_fluid.params import SphFluidParams

Array = NDArray[np.float64]
NEAR = 0.5  # spacings, between particles of two shapes that do not overlap


def check_shapes(params: "SphFluidParams") -> None:
    """Shapes fit the dimensions and overlap nothing."""
    planar = params.dimensions == 2
    for number, shape in enumerate(params.shapes):
        name = f"shapes[{number}]"
        if planar and (shape.shape not in ("cylinder", "prism") or shape.axis != "y"):
            raise ValueError(
                f"{name} must be a cylinder or a prism along y in two dimensions; found a "
                f"{shape.shape}, axis {shape.axis}. Change it, or set dimensions to 3."
            )
        points = fill_shape(shape, params.spacing, planar)
        others = [(f"fluid[{k}]", box) for k, box in enumerate(params.fluid)]
        others += [(f"boundary.obstacles[{k}]", b) for k, b in enumerate(params.boundary.obstacles)]
        for other, box in others:
            if count := int(_inside(points, box).sum()):
                raise ValueError(
                    f"{name} must not overlap {other}; {count} of its {len(points)} particles "
                    "stand in it. Cut one of them."
                )
        for k, earlier in enumerate(params.shapes[:number]):
            there = fill_shape(earlier, params.spacing, planar)
            if _overlap(points, there, NEAR * params.spacing):
                raise ValueError(
                    f"{name} must not overlap shapes[{k}]; particles of both stand nearer than "
                    f"{NEAR:g} spacings. Move or cut one of them."
                )


def _inside(points: Array, box: Box) -> NDArray[np.bool_]:
    low, high = np.array(box)
    return np.asarray(((points > low) & (points < high)).all(axis=1))


def _overlap(points: Array, others: Array, distance: float) -> bool:
    """Whether points of two sets are nearer than a distance [m], by the cells that they are in."""
    low, high = points.min(axis=0) - distance, points.max(axis=0) + distance
    near = others[((others > low) & (others < high)).all(axis=1)]
    if not len(near):
        return False
    cell = np.floor((points - low) / distance).astype(np.int64)
    taken = {tuple(one) for one in cell.tolist()}
    steps = np.stack(np.meshgrid(*[[-1, 0, 1]] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    for place in near:
        here = np.floor((place - low) / distance).astype(np.int64)
        if any(tuple(one) in taken for one in (here + steps).tolist()):
            if (np.linalg.norm(points - place, axis=1) < distance).any():
                return True
    return False
