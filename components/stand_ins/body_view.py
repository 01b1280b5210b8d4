"""What a picture shows of prescribed bodies."""

from collections.abc import Sequence

import numpy as np

from quintet.components.shared.geometry import body_view
from quintet.components.shared.geometry.planar_shapes import Disc, Polygon
from quintet.components.shared.geometry.shapes import Box, Shape, Sphere
from quintet.interfaces.component import Fields
from quintet.interfaces.rotation import matrix


def view(shapes: Sequence[Shape], pose: Fields) -> Fields:
    """Corners and faces of boxes and polygons, centres and radii of spheres and discs."""
    position, velocity = pose["motion.position"], pose["motion.velocity"]
    axes, spin = matrix(pose["motion.orientation"]), pose["motion.angular_velocity"]
    outlines = [_outline(shape) for shape in shapes]
    shown = body_view.bodies_view(outlines, position, axes, velocity, spin)
    return {name: array for name, array in shown.items() if name != "body"}


def _outline(shape: Shape) -> body_view.Outline:
    if isinstance(shape, Box):
        return body_view.box(shape.size)
    if isinstance(shape, Polygon):
        return body_view.polygon(shape.outline)
    assert isinstance(shape, Sphere | Disc)
    return body_view.Outline(np.zeros((1, 3)), np.array([shape.radius]))
