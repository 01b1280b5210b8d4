"""What a picture shows of prescribed bodies."""

from collections.abc import Sequence

import numpy as np

from quintet.components.shared.geometry.shapes import Box, Disc, Polygon, Shape, Sphere
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.faces import CORNERS, FACES, stacked
from quintet.interfaces.rotation import matrix


def view(shapes: Sequence[Shape], pose: Fields) -> Fields:
    """Corners and faces of boxes and polygons, centres and radii of spheres and discs."""
    order = sorted(range(len(shapes)), key=lambda k: not isinstance(shapes[k], Sphere | Disc))
    arms: list[Array] = []  # m, in the body's frame
    cells: list[Array] = []
    radii: list[Array] = []
    count = 0
    for shape in (shapes[k] for k in order):
        corners, radius = np.zeros((1, 3)), 0.0
        if isinstance(shape, Box):
            corners = CORNERS * 0.5 * np.array(shape.size)
            cells.append(count + FACES)
        elif isinstance(shape, Polygon):
            corners = np.insert(shape.outline, 1, 0.0, axis=1)
            cells.append(count + np.arange(len(corners))[None])
        elif isinstance(shape, Sphere | Disc):
            radius = shape.radius
        arms.append(corners)
        radii.append(np.full(len(corners), radius))
        count += len(corners)
    owner = np.repeat(order, [len(one) for one in arms])
    arm = np.einsum("nij,nj->ni", matrix(pose["motion.orientation"])[owner], np.concatenate(arms))
    turning = np.cross(pose["motion.angular_velocity"][owner], arm)
    shown = {
        "points": pose["motion.position"][owner] + arm,
        "velocity": pose["motion.velocity"][owner] + turning,
        "radius": np.concatenate(radii),
    }
    return shown | ({"cells": stacked(cells)} if cells else {})
