"""Sums independent of order: the same bits for any distribution of rows, and accurate."""

import math
from fractions import Fraction

import numpy as np
import pytest

from quintet.components.shared.exact_sums import bounds, sum_parts, total


def sum_columns(columns, groups=1):
    parts = [
        sum_parts([column[k::groups] for column in columns], bounds(columns), len(columns[0]))
        for k in range(groups)
    ]
    return total(np.sum(parts, axis=0))


@pytest.mark.parametrize("spread", (0.0, 3.0, 30.0))
def test_order_and_shares_change_no_bit(spread):
    rng = np.random.default_rng(3)
    columns = [rng.normal(size=4001) * np.exp(spread * rng.normal(size=4001)) for _ in range(3)]
    expected = sum_columns(columns)
    order = rng.permutation(4001)
    for sums in (sum_columns([column[order] for column in columns]), sum_columns(columns, 3)):
        assert sums.tobytes() == expected.tobytes()


def test_sums_are_as_near_as_numbers_can_be():
    rng = np.random.default_rng(4)
    numbers = rng.normal(size=2000)
    numbers = np.concatenate([numbers, -numbers[::-1] * (1.0 + 1e-12)])
    exact = float(sum(map(Fraction, numbers.tolist())))
    # The error is the last bits of the largest term, not of the sum.
    assert abs(sum_columns([numbers])[0] - exact) < 1e-20


def test_nothing_and_what_is_not_finite():
    assert sum_columns([np.zeros(0), np.zeros(0)]).tolist() == [0.0, 0.0]
    for number in (math.inf, math.nan, 1e308):
        assert math.isnan(sum_columns([np.array([1.0, number])])[0])
