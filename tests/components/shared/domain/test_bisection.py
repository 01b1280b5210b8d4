"""Cells distributed among ranks: balanced, compact, independent of the cells' order."""

import numpy as np
import pytest

from quintet.components.shared.domain.bisection import bisect
from quintet.interfaces.errors import SceneError


def box(*sides):
    return np.stack(np.meshgrid(*map(np.arange, sides), indexing="ij"), -1).reshape(-1, 3)


@pytest.mark.parametrize("ranks", [1, 2, 3, 4, 7])
def test_parts_of_equal_cells_differ_by_less_than_a_cell_at_each_cut(ranks):
    cells = box(11, 5, 3)
    counts = np.bincount(bisect(cells, np.ones(len(cells)), ranks), minlength=ranks)
    assert np.abs(counts - len(cells) / ranks).max() <= 2.0
    assert counts.sum() == len(cells)


def test_heavy_cells_are_shared_out_by_their_weight():
    cells = box(100, 1, 1)
    weights = np.where(cells[:, 0] < 10, 9.0, 1.0)  # 90 in the first ten, 90 in the others
    assert (bisect(cells, weights, 2) == (cells[:, 0] >= 10)).all()


def test_the_order_of_the_cells_does_not_matter():
    cells, random = box(6, 5, 4), np.random.default_rng(1)
    weights = random.random(len(cells))
    order = random.permutation(len(cells))
    assert (bisect(cells[order], weights[order], 5) == bisect(cells, weights, 5)[order]).all()


def test_cuts_go_across_the_longest_extent():
    owner = bisect(box(8, 4, 2), np.ones(64), 4).reshape(8, 4, 2)
    assert (owner[:4] < 2).all() and (owner[4:] >= 2).all()


@pytest.mark.parametrize("ranks", [3, 5, 8])
def test_every_rank_has_a_cell_also_where_one_cell_has_all_the_work(ranks):
    weights = np.zeros(8)
    weights[3] = 1.0
    assert set(bisect(box(8, 1, 1), weights, ranks).tolist()) == set(range(ranks))


def test_more_ranks_than_cells_are_refused():
    with pytest.raises(SceneError, match="there are 3 cells for 4 ranks"):
        bisect(box(3, 1, 1), np.ones(3), 4)
