"""Points, radii and faces that pictures show of rigid bodies."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from quintet.components.shared.geometry.box_faces import CORNERS, FACES
from quintet.components.shared.geometry.polygons import in_space
from quintet.interfaces.component import Array
from quintet.interfaces.faces import stacked


class Outline(NamedTuple):
    """Points of one body, in body axes."""

    points: Array  # (k, 3) m
    radii: Array  # (k,) m, 0 at corners
    faces: Array | None = None  # (f, corners) rows of points


def box(size: Sequence[float]) -> Outline:
    """Corners and faces of a box of edges `size` [m] about its centre."""
    return Outline(CORNERS * 0.5 * np.array(size), np.zeros(8), FACES)


def polygon(corners: Array) -> Outline:
    """Corners (k, 2) m of a polygon in the plane of x and z."""
    count = len(corners)
    return Outline(in_space(corners), np.zeros(count), np.arange(count)[None])


def bodies_view(
    outlines: Sequence[Outline], position: Array, axes: Array, velocity: Array, spin: Array
) -> dict[str, Array]:
    """View of bodies: points with their velocity, radius and body, and faces.

    Parameters
    ----------
    outlines : sequence of Outline
        Of n bodies.
    position, velocity : (n, 3) float array, m and m/s
    axes : (n, 3, 3) float array
        Rotation matrices, body -> world.
    spin : (n, 3) float array, rad/s
    """
    counts = [len(outline.points) for outline in outlines]
    body = np.repeat(np.arange(len(outlines)), counts)
    arms = [outline.points @ turn.T for outline, turn in zip(outlines, axes, strict=True)]
    arm = np.concatenate(arms)
    shown = {
        "points": position[body] + arm,
        "velocity": velocity[body] + np.cross(spin[body], arm),
        "radius": np.concatenate([outline.radii for outline in outlines]),
        "body": body,
    }
    first = np.cumsum([0, *counts])
    faces = [
        outline.faces + row
        for outline, row in zip(outlines, first, strict=False)
        if outline.faces is not None
    ]
    return shown | ({"cells": stacked(faces)} if faces else {})
