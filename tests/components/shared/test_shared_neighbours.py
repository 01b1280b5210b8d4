"""Neighbour lists hold all pairs within reach, and report when they are outdated."""

import numpy as np
import pytest
from numba import njit

from quintet.components.shared.search.cells import (
    LAYER,
    ROW,
    grid_around,
    key_of,
    keys_of,
    row_of_keys,
    sorted_into,
)
from quintet.components.shared.search.neighbours import neighbours_within
from quintet.components.shared.search.verlet_list import longest, slack
from quintet.components.shared.symmetry import Plane, SymmetryImages, neighbours_and_images
from quintet.components.shared.threads import Team


def test_neighbour_lists_hold_all_pairs_within_reach() -> None:
    points = np.random.default_rng(1).random((300, 3)) * [1.0, 0.5, 0.2]
    grid = grid_around(points[:200], 0.15)
    groups = [points[:200], points[200:]]
    points = np.concatenate([group[sorted_into(group, grid)[2]] for group in groups])
    neighbours = neighbours_within(0.15, points, 200, Team(1))
    distance = np.linalg.norm(points[:, None] - points[None], axis=2)
    for i in range(300):
        expected = np.flatnonzero(distance[i] < 0.15)
        listed = np.sort(neighbours.list[neighbours.begin[i] : neighbours.end[i]])
        assert np.array_equal(listed, expected if i < 200 else expected[expected < 200])
        first = neighbours.list[neighbours.begin[i] : neighbours.middle[i]]
        assert (first < 200).all()


def test_images_are_neighbours_too() -> None:
    points = np.random.default_rng(2).random((200, 3)) * [0.5, 0.5, 0.2]
    box = ((0.0, 0.0, 0.0), (0.5, 0.5, 0.2))
    images = SymmetryImages([Plane.of_face(face, box) for face in ("x-", "y+")])
    all_points = images.find(points, 0.15)
    assert len(all_points) > 200 and images.all_images(points).shape == (800, 3)
    buffer, team = np.zeros(0, np.int32), Team(1)
    one_group = np.ones(len(all_points), bool)
    neighbours = neighbours_and_images(all_points, one_group, 200, 200, 0.15, team, None, buffer)
    distance = np.linalg.norm(points[:, None] - all_points[None], axis=2)
    for i in range(200):
        listed = np.sort(neighbours.list[neighbours.begin[i] : neighbours.end[i]])
        assert np.array_equal(listed, np.flatnonzero(distance[i] < 0.15))


def test_images_mirror_positions_vectors_and_values() -> None:
    box = ((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    images = SymmetryImages([Plane.of_face("z+", box)])
    points = np.array([[0.2, 0.3, 0.9], [0.2, 0.3, 0.1]])
    assert len(images.find(points, 0.2)) == 3
    rows = images.with_room(np.column_stack([points, points[:, :2]]), 2)
    images.write_positions(rows, 2)
    np.testing.assert_allclose(rows[2], [0.2, 0.3, 1.1, 0.2, 0.3], rtol=1e-15)
    images.write_vectors(rows, 2)
    assert rows[2].tolist() == [0.2, 0.3, -0.9, 0.2, 0.3]
    values = np.array([7, 8, 0])
    images.write_values(values, 2)
    assert values[2] == 7


@pytest.mark.parametrize("distance", [0.009, 0.011])
def test_a_list_is_outworn_when_two_may_have_come_nearer_by_the_skin(distance: float) -> None:
    assert (slack(0.02, distance) < 0.0) == (distance > 0.01)
    assert (slack(0.02, 0.005, distance + 0.005) < 0.0) == (distance > 0.01)
    assert longest(np.array([[0.0, 0.0, 1.0, 9.0], [0.0, 3.0, 4.0, 9.0]])) == 5.0


@njit
def key_at(x, y, z, width):  # type: ignore[no-untyped-def]
    return key_of(x, y, z, width)


@njit
def rows_between(keys, first, last):  # type: ignore[no-untyped-def]
    """Call a function that only kernels can call."""
    return row_of_keys(keys, first, last)


def test_keys_find_what_is_in_cells_next_to_one_another_however_far_apart() -> None:
    random = np.random.default_rng(5)
    points = np.concatenate([random.random((300, 3)), [[1e9, -1e9, 1e12]]])
    width = 0.2
    keys = keys_of(points, np.arange(len(points)), width)
    assert keys[7] == key_at(*points[7].tolist(), width)
    order = np.argsort(keys, kind="stable")
    sorted_keys = keys[order]
    distance = np.linalg.norm(points[:, None] - points[None], axis=2)
    for i in range(len(points)):
        near: set[int] = set()
        for z in (-LAYER, 0, LAYER):
            for y in (-ROW, 0, ROW):
                begin, end = rows_between(sorted_keys, keys[i] + z + y - 1, keys[i] + z + y + 1)
                near |= set(order[begin:end].tolist())
        assert set(np.flatnonzero(distance[i] < width).tolist()) <= near
