"""A damped oscillation gives back its period and its decay, noise or not."""

import math

import numpy as np
import pytest

from quintet.coupler.measures.oscillation import fit
from quintet.coupler.measures.time_series import Curve, distance

PERIOD, DECAY = 0.37, 0.8  # s, 1/s


def oscillation(begin, end, count, noise=0.0, decay=DECAY):
    times = np.linspace(begin, end, count)
    values = 3.0 + np.exp(-decay * times) * 0.02 * np.sin(2.0 * math.pi / PERIOD * times + 0.4)
    return Curve(times, values + noise * np.random.default_rng(4).normal(size=count))


@pytest.mark.parametrize(("begin", "end"), [(0.0, 2.0), (0.7, 1.1), (5.0, 6.63)])
@pytest.mark.parametrize("decay", [DECAY, 0.0, -0.3])
def test_exact_oscillation_gives_period_and_decay(begin, end, decay):
    fitted = fit(oscillation(begin, end, 200, decay=decay))
    assert fitted.period == pytest.approx(PERIOD, rel=1e-8)
    assert fitted.decay == pytest.approx(decay, abs=1e-7)


def test_noise_moves_them_little():
    fitted = fit(oscillation(0.0, 2.0, 400, noise=0.002))  # a tenth of the amplitude
    assert fitted.period == pytest.approx(PERIOD, rel=5e-3)
    assert fitted.decay == pytest.approx(DECAY, rel=0.1)


def test_what_does_not_oscillate_has_neither():
    times = np.linspace(0.0, 2.0, 100)
    for values in (np.full(100, 3.0), times):
        assert all(map(math.isnan, fit(Curve(times, values))))
    assert math.isnan(fit(Curve(times[:5], times[:5] ** 2)).period)


def test_relative_distance_is_over_the_size_of_the_reference():
    line = Curve(np.array([0.0, 2.0]), np.array([1.0, 3.0]))
    target = Curve(np.array([0.0, 1.0, 2.0]), np.array([1.0, 2.0, 2.0]))
    assert distance(line, target, relative=False) == pytest.approx(math.sqrt(1.0 / 3.0))
    assert distance(line, target, relative=True) == pytest.approx(1.0 / 3.0)


def test_a_long_curve_is_fitted_as_well():
    fitted = fit(oscillation(0.0, 20.0, 100_000))
    assert fitted.period == pytest.approx(PERIOD, rel=1e-8)
    assert fitted.decay == pytest.approx(DECAY, abs=1e-7)
