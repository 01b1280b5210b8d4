"""Sorting by cell keeps the order within a cell, whatever the number of points."""

import numpy as np
import pytest

from quintet.components.shared.search.cells import Grid, corners, grid_around, sorted_into

BOX = np.array([[0.0, 0.0, 0.0], [0.9, 0.5, 0.2]])


def box() -> Grid:
    return grid_around(BOX, 0.3)


@pytest.mark.parametrize("columns", [3, 4])
@pytest.mark.parametrize("count", [0, 1, 2, 2000])
def test_points_are_sorted_by_cell_in_the_order_they_came_in(count: int, columns: int) -> None:
    points = np.random.default_rng(3).random((count, columns))
    points[:, :3] = 4.0 * points[:, :3] - 1.5  # many to a cell, and some outside
    grid = box()
    cell, start, order = sorted_into(points, grid)
    np.testing.assert_array_equal(order, np.argsort(cell, kind="stable"))
    np.testing.assert_array_equal(start, np.searchsorted(cell[order], np.arange(len(start))))
    (low, high), reach = BOX, 1.001 * 0.3
    outside = ((points[:, :3] < low - reach) | (points[:, :3] > high + 1.5 * reach)).any(axis=1)
    assert (cell[outside] == grid.cells).all()
    assert (cell <= grid.cells).all()


def test_corners_hold_all_points_and_touch_them() -> None:
    points = np.random.default_rng(4).normal(size=(50, 4))
    low, high = corners(points)
    np.testing.assert_array_equal(low, points[:, :3].min(axis=0))
    np.testing.assert_array_equal(high, points[:, :3].max(axis=0))
