"""A team hands out each row once, and returns results in the order of the rows."""

from itertools import pairwise
from threading import Barrier, get_ident

import numpy as np
import pytest

from quintet.components.shared.threads import Team


@pytest.mark.parametrize("size", [1, 2, 3])
@pytest.mark.parametrize("rows", [0, 1, 19, 20, 1000])
def test_each_row_is_handed_out_once(rows: int, size: int) -> None:
    visits = np.zeros(rows, int)

    def count(first: int, last: int, step: int) -> tuple[int, int]:
        visits[first:last] += step
        return first, last

    spans = Team(size, fewest=10).run(count, rows, 1)
    assert (visits == 1).all()
    assert spans[0][0] == 0 and spans[-1][1] == rows
    assert all(span[1] == next_span[0] for span, next_span in pairwise(spans))


@pytest.mark.parametrize("size", [2, 3])
def test_as_many_threads_work_as_were_asked_for(size: int) -> None:
    barrier = Barrier(size)

    def wait(first: int, last: int) -> int:
        barrier.wait(5.0)
        return get_ident()

    assert len(set(Team(size, fewest=1, shares=1).run(wait, size))) == size


@pytest.mark.parametrize("row", [0, 99])
def test_what_fails_in_a_share_fails_the_call(row: int) -> None:
    def fail(first: int, last: int) -> None:
        if first <= row < last:
            raise ValueError(f"row {row}")

    with pytest.raises(ValueError, match=f"row {row}"):
        Team(2, fewest=10).run(fail, 100)
