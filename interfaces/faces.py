"""Faces of boxes, and polygons with different numbers of corners in one array, for views."""

from collections.abc import Iterable, Sequence
from itertools import pairwise, product

import numpy as np

from quintet.interfaces.component import Array, Fields

CORNERS = np.array(list(product((-1.0, 1.0), repeat=3)))  # of a box about the origin, z fastest
# Corners around each face of a box, seen from outside.
BOX_FACES = {
    "x-": (0, 1, 3, 2),
    "x+": (4, 6, 7, 5),
    "y-": (0, 4, 5, 1),
    "y+": (2, 3, 7, 6),
    "z-": (0, 2, 6, 4),
    "z+": (1, 5, 7, 3),
}
FACES = np.array(list(BOX_FACES.values()))

# What stands still, of the walls of a component.
WALL, CLAMPED, SYMMETRY = 0, 1, 2


def stacked(cells: Iterable[Array]) -> Array:
    """Polygons (m, k) of several arrays (m_i, k_i) in one, -1 after the last corner of each."""
    every = [np.asarray(block, np.int64) for block in cells]
    width = max(block.shape[1] for block in every)
    return np.concatenate(
        [
            np.pad(block, ((0, 0), (0, width - block.shape[1])), constant_values=-1)
            for block in every
        ]
    )


def polygons(corners: Sequence[Array]) -> Fields:
    """Points and cells of a view of polygons, each given by its corners (k, 3) m."""
    if not corners:
        return {}
    first = np.cumsum([0, *map(len, corners)])
    cells = [np.arange(a, b)[None] for a, b in pairwise(first)]
    return {"points": np.concatenate(corners), "cells": stacked(cells)}


def box(low: Sequence[float], high: Sequence[float], faces: Iterable[str]) -> list[Array]:
    """Corners (4, 3) m of some faces of a box between two of its corners."""
    middle, half = np.add(low, high) / 2.0, np.subtract(high, low) / 2.0
    corners = middle + half * CORNERS
    return [corners[list(BOX_FACES[face])] for face in faces]
