"""Bisection brackets a limit, also at 0, in few runs."""

import pytest

from quintet.coupler.study.bisection import bisect


@pytest.mark.parametrize("log", [False, True])
@pytest.mark.parametrize("ends", [(1.0, 100.0), (100.0, 1.0)])
def test_bisection_brackets_what_it_looks_for(log, ends):
    def holds(value):
        return value < 7.3 if ends[0] < ends[1] else value > 7.3

    good, bad = bisect(ends, holds, log, 0.01)
    assert holds(good) and not holds(bad) and abs(bad - good) <= 0.01 * 7.4
    assert bisect((1.0, 2.0), lambda _: True, log, 0.01) is None
    assert bisect((1.0, 2.0), lambda _: False, log, 0.01) is None


@pytest.mark.parametrize("ends", [(0.0, 1.0), (-1.0, 1.0), (1.0, -2.0)])
def test_a_limit_at_zero_takes_few_runs(ends):
    values = []

    def holds(value):
        values.append(value)
        return value == ends[0] or (value - 1e-12) * (ends[1] - ends[0]) < 0.0

    good, bad = bisect(ends, holds, False, 0.05)
    assert good <= 1e-12 <= bad or bad <= 1e-12 <= good
    assert abs(bad - good) <= 3e-6 and len(values) < 30
