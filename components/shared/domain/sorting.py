"""Rows brought to the rank that owns their cell, and into the order in which one rank has them."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.domain.cuts import Cut, cut_between_rows, owners
from quintet.components.shared.domain.extremes import greatest, least
from quintet.components.shared.domain.migration import move
from quintet.components.shared.search.cells import Grid, corners, grid_between, number_cells
from quintet.interfaces.component import Array

Whole = NDArray[np.int64]
CELL = 32  # bits of a key below the number of the cell


class Sorted(NamedTuple):
    """What a rank owns from now on."""

    keys: Whole  # (m,) numbers that rise in the order in which one rank would have the rows
    arrays: list[NDArray[Any]]  # in that order
    cuts: list[Cut]  # between the parts of space of all ranks


def grid_of_all(communicator: Any, points: Array, reach: float) -> Grid:
    """Cells around the points (n, 3 or more) m of all ranks, as `grid_around` makes them."""
    low, high = corners(points) if len(points) else (np.full(3, np.inf), np.full(3, -np.inf))
    return grid_between(least(communicator, low), greatest(communicator, high), reach)


def sort_by_cell(
    communicator: Any, grid: Grid, points: Array, keys: Whole, weights: Whole,
    arrays: Sequence[NDArray[Any]],
) -> Sorted:  # fmt: skip
    """Cut space by the weights of rows; bring all to their owners, sorted by cell.

    Rows of one cell keep their order, so that all ranks together have the order that sorting on
    one would give.

    Parameters
    ----------
    communicator : mpi4py communicator
    grid : Grid
        The same on all ranks, around all rows.
    points : (n, 3 or more) float array, m
    keys : (n,) int array
        Numbers that rise in the order of the rows of all ranks.
    weights : (n,) int array
        Work of each row.
    arrays : sequence of (n, *shape) arrays
        Of 8-byte numbers.
    """
    number = np.empty(len(points), np.int64)
    number_cells(points, grid, number)
    cells = _layers(number, grid)
    cuts = cut_between_rows(communicator, cells, weights)
    number, keys, *moved = move(communicator, owners(cuts, cells), (number, keys, *arrays))
    order = np.lexsort((keys, number))
    number = number[order]
    begins = np.searchsorted(number, number)
    new_keys = (number << CELL) + np.arange(len(number)) - begins
    return Sorted(new_keys, [array.take(order, axis=0) for array in moved], cuts)


def cells_around(points: Array, grid: Grid) -> Whole:
    """Layers (n, 3) of the cells of points (n, 3 or more) m, beyond the grid too."""
    axes = (grid.first, grid.second, grid.third)
    starts = (grid.x, grid.y, grid.z)
    layers = [
        np.floor((points[:, axis] - start) * grid.per_metre)
        for axis, start in zip(axes, starts, strict=True)
    ]
    return np.clip(np.column_stack(layers), -1e9, 1e9).astype(np.int64)


def _layers(number: Whole, grid: Grid) -> Whole:
    """Layers (n, 3) of numbered cells, along the axes of their grid."""
    x, rest = number % grid.nx, number // grid.nx
    return np.column_stack([x, rest % grid.ny, rest // grid.ny])
