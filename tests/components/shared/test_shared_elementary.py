"""Elementary functions without branches, against those of numpy."""

import numpy as np
import pytest
from numba import njit

from quintet.components.shared import elementary


@njit
def _evaluate(x, y, out):
    for k in range(len(x)):
        out[0, k] = elementary.logarithm(x[k])
        out[1, k] = elementary.exponential(y[k])
        out[2, k] = elementary.power(x[k], 0.168)
        out[3, k] = elementary.logarithm_of_few_digits(x[k])
        out[4, k] = elementary.exponential_of_few_digits(y[k])


def test_logarithm_exponential_and_power_are_those_of_the_library():
    x = np.concatenate([np.logspace(-30, 30, 2001), np.linspace(0.5, 2.0, 2001)])
    y = np.linspace(-600.0, 600.0, len(x))
    out = np.empty((5, len(x)))
    _evaluate(x, y, out)
    assert np.abs(out[0] - np.log(x)).max() < 1e-13 * np.log(1e30)
    assert out[1] == pytest.approx(np.exp(y), rel=1e-12)
    assert out[2] == pytest.approx(x**0.168, rel=1e-12)
    assert np.abs(out[3] - np.log(x)).max() < 2e-6
    assert out[4] == pytest.approx(np.exp(y), rel=4e-6)


def test_at_their_ends_they_stay_finite():
    x, y, out = np.array([0.0, -1.0, 1.0]), np.array([-1e9, 1e9, 0.0]), np.empty((5, 3))
    _evaluate(x, y, out)
    assert np.isfinite(out).all()
    assert out[0, 2] == 0.0 and out[1, 2] == 1.0 and out[2, 0] < 1e-40
