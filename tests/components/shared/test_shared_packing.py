"""Packed rows of neighbours of any width; lattices; single precision."""

from typing import NamedTuple

import numpy as np
import pytest
from numba import njit

from quintet.components.shared.geometry.lattice import cell_centres, lattice_points, spread_evenly
from quintet.components.shared.packing import PAIRS, empty_rows, pack_rows, pack_values
from quintet.components.shared.single_precision import SingleCopy, rounded
from quintet.components.shared.threads import Team


@njit
def pack(source, neighbour, count, filling, width):  # type: ignore[no-untyped-def]
    rows = empty_rows(count, width, source.dtype)
    full = pack_rows(0, count, neighbour, source, filling, rows)
    return rows[:full], pack_values(0, count, neighbour, source[:, 0], np.ones(count))


@pytest.mark.parametrize("width", [1, 3, 4, 8, 9, 13])
@pytest.mark.parametrize("count", [0, 3, 8, 11])
def test_rows_of_any_width_are_packed_and_filled_up(width: int, count: int) -> None:
    random = np.random.default_rng(1)
    source, neighbour = random.random((30, width)), random.integers(0, 30, 12).astype(np.int32)
    filling = tuple(float(-d) for d in range(width))
    rows, values = pack(source, neighbour, count, filling, width)
    assert len(rows) == -(-count // PAIRS) * PAIRS
    np.testing.assert_array_equal(rows[:count], source[neighbour[:count]])
    assert (rows[count:] == filling).all()
    np.testing.assert_array_equal(values, source[neighbour[:count], 0])


def test_a_box_is_filled_cell_by_cell_and_beyond() -> None:
    axes = [cell_centres(0.0, 1.0, 2, 1, 0), cell_centres(0.0, 1.0, 1), spread_evenly(0.0, 1.0, 2)]
    assert [axis.tolist() for axis in axes] == [[-0.25, 0.25, 0.75], [0.5], [0.0, 1.0]]
    points = lattice_points(axes)
    assert points[:4, 0].tolist() == [-0.25, 0.25, 0.75, -0.25] and points[3, 2] == 1.0
    reordered = lattice_points(axes, x_fastest=False)
    assert {*map(tuple, points.tolist())} == {*map(tuple, reordered.tolist())}
    assert reordered[1].tolist() == [-0.25, 0.5, 1.0]
    assert spread_evenly(0.0, 1.0, 1).tolist() == [0.5]


class Inner(NamedTuple):
    length: float
    choice: bool | None


class Outer(NamedTuple):
    inner: Inner
    seen: np.ndarray
    none: None


def test_laws_are_rounded_with_what_is_in_them() -> None:
    law = rounded(Outer(Inner(0.1, True), np.array([0.1]), None))
    assert law.inner.length == np.float32(0.1) and law.inner.choice is True
    assert law.seen.dtype == np.float32 and law.none is None
    assert rounded(None) is None


def test_a_single_copy_is_rounded_about_its_origin() -> None:
    source = 1e6 + np.random.default_rng(3).random((20, 5))
    copy = SingleCopy(source.shape, (1e6,) * 5).of(source, Team(1))
    assert copy.dtype == np.float32
    np.testing.assert_array_equal(copy, (source - 1e6).astype(np.float32))
