"""Checks of fluid in other shapes than boxes; imported only by a scene that has some."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.shared.geometry.shapes import Cylinder
from quintet.components.sph_fluid.setup.shape_filling import fill_shape
from quintet.components.sph_fluid.setup.shapes import Fluid, Prism, named_boxes, named_shapes
from quintet.interfaces.component import Array

NEAR = 0.5  # spacings, between particles of two shapes that do not overlap


def check_shapes(
    fluid: Fluid, obstacles: Sequence[Bounds], spacing: float, dimensions: int
) -> None:
    """Shapes fit the dimensions and overlap nothing."""
    planar, shapes = dimensions == 2, named_shapes(fluid)
    boxes = named_boxes(fluid)
    boxes += [(f"boundary.obstacles[{k}]", box) for k, box in enumerate(obstacles)]
    for number, (name, shape) in enumerate(shapes):
        body = shape.geometry
        if planar and not (isinstance(body, Cylinder | Prism) and body.axis in (1, "y")):
            raise ValueError(
                f"{name} must be a cylinder or a prism along y in two dimensions; found a "
                f"{shape.shape}. Change it, or set dimensions to 3."
            )
        points = fill_shape(shape, spacing, planar)
        for other_name, box in boxes:
            if count := int(_inside(points, box).sum()):
                raise ValueError(
                    f"{name} must not overlap {other_name}; {count} of its {len(points)} particles "
                    "stand in it. Cut one of them."
                )
        for other_name, earlier in shapes[:number]:
            if _overlap(points, fill_shape(earlier, spacing, planar), NEAR * spacing):
                raise ValueError(
                    f"{name} must not overlap {other_name}; particles of both stand nearer than "
                    f"{NEAR:g} spacings. Move or cut one of them."
                )


def _inside(points: Array, box: Bounds) -> NDArray[np.bool_]:
    low, high = np.array(box)
    return np.asarray(((points > low) & (points < high)).all(axis=1))


def _overlap(points: Array, other_points: Array, distance: float) -> bool:
    """Whether points of two sets are nearer than a distance [m]."""
    nearest, _ = cKDTree(points).query(other_points)
    return bool((nearest < distance).any())
