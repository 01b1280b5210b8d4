"""Polygons with different numbers of corners in one array, for views."""

from collections.abc import Iterable, Sequence
from itertools import pairwise

import numpy as np

from quintet.interfaces.component import Array, Fields

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
