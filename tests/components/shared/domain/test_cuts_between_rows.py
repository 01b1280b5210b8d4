"""Space cut between rows of cells: balanced, without gaps, a part for every rank."""

import numpy as np
import pytest

from quintet.components.shared.domain import cuts
from quintet.components.shared.domain.cuts import cut_between_rows, owners
from quintet.interfaces.errors import StepError


class Alone:
    """Stand-in for the communicator of several ranks; this process holds all rows."""

    def __init__(self, size):
        self.size = size


@pytest.fixture(autouse=True)
def all_rows_here(monkeypatch):
    for name in ("greatest", "least", "counted"):
        monkeypatch.setattr(cuts, name, lambda _, numbers: numbers)


def box(*sides):
    return np.stack(np.meshgrid(*map(np.arange, sides), indexing="ij"), -1).reshape(-1, 3)


@pytest.mark.parametrize("ranks", [1, 2, 3, 4, 7, 16])
def test_parts_differ_by_few_rows_of_cells(ranks):
    cells = box(12, 9, 5) - 3
    owner = owners(cut_between_rows(Alone(ranks), cells, np.ones(len(cells), np.int64)), cells)
    counts = np.bincount(owner, minlength=ranks)
    assert counts.sum() == len(cells) and counts.min() > 0
    assert np.abs(counts - len(cells) / ranks).max() <= 5.0 * np.ceil(np.log2(ranks + 1))


def test_heavy_rows_are_shared_out_by_their_weight():
    cells = box(100, 1, 1)
    weights = np.where(cells[:, 0] < 10, 9, 1)  # 90 in the first ten, 90 in the others
    owner = owners(cut_between_rows(Alone(2), cells, weights), cells)
    assert (owner == (cells[:, 0] >= 10)).all()


def test_what_lies_far_outside_has_an_owner():
    cells = box(8, 4, 2)
    cuts = cut_between_rows(Alone(4), cells, np.ones(64, np.int64))
    far_cells = np.array([[-1000, 0, 0], [1000, 0, 0], [0, 10**9, -(10**9)]])
    assert set(owners(cuts, far_cells)) <= {0, 1, 2, 3}
    assert owners(cuts, far_cells)[0] < 2 <= owners(cuts, far_cells)[1]


def test_all_weight_in_two_cells_is_one_for_each():
    cells = np.array([[0, 0, 0]] * 99 + [[0, 7, 0]])
    owner = owners(cut_between_rows(Alone(2), cells, np.ones(100, np.int64)), cells)
    assert (owner == [0] * 99 + [1]).all()


def test_each_of_several_ranks_has_a_row_of_cells_however_heavy_one_is():
    cells = box(1, 4, 1)
    owner = owners(cut_between_rows(Alone(4), cells, np.array([1000, 1, 1, 1])), cells)
    assert owner.tolist() == [0, 1, 2, 3]


def test_too_many_ranks_are_refused():
    with pytest.raises(StepError, match=r"one cell left .* Take fewer ranks than 3"):
        cut_between_rows(Alone(3), np.array([[0, 0, 0], [0, 1, 0]]), np.ones(2, np.int64))
