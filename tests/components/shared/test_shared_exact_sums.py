"""Sums without an order: the same bits however the rows are shared out, and right."""

import math
from fractions import Fraction

import numpy as np
import pytest

from quintet.components.shared.exact_sums import bounds, sum_parts, total


def summed(columns, groups=1):
    parts = [
        sum_parts([column[k::groups] for column in columns], bounds(columns), len(columns[0]))
        for k in range(groups)
    ]
    return total(np.sum(parts, axis=0))


@pytest.mark.parametrize("spread", (0.0, 3.0, 30.0))
def test_order_and_shares_change_no_bit(spread):
    rng = np.random.default_rng(3)
    columns = [rng.normal(size=4001) * np.exp(spread * rng.normal(size=4001)) for _ in range(3)]
    reached = summed(columns)
    order = rng.permutation(4001)
    for other in (summed([column[order] for column in columns]), summed(columns, 3)):
        assert other.tobytes() == reached.tobytes()


def test_sums_are_as_near_as_numbers_can_be():
    rng = np.random.default_rng(4)
    numbers = rng.normal(size=2000)
    numbers = np.concatenate([numbers, -numbers[::-1] * (1.0 + 1e-12)])
    exact = float(sum(map(Fraction, numbers.tolist())))
    # The error is that of the largest term's last bits, not of the sum's own.
    assert abs(summed([numbers])[0] - exact) < 1e-20


def test_nothing_and_what_is_not_finite():
    assert summed([np.zeros(0), np.zeros(0)]).tolist() == [0.0, 0.0]
    for wrong in (math.inf, math.nan, 1e308):
        assert math.isnan(summed([np.array([1.0, wrong])])[0])
