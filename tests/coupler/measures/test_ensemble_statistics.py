"""Statistics of an ensemble, and the interval of a calibration, against numbers known."""

import math

import numpy as np
import pytest

from quintet.coupler.measures.ensemble_statistics import band, statistics
from quintet.coupler.measures.misfit_profile import misfit_interval
from quintet.coupler.measures.time_series import Curve


def test_the_interval_of_the_mean_is_students():
    summary = statistics([1.0, 2.0, 3.0, 4.0, 5.0])
    assert summary.mean == 3.0 and summary.deviation == pytest.approx(math.sqrt(2.5))
    half = 2.7764451 * math.sqrt(2.5 / 5.0)  # t of 4 degrees of freedom at 97.5 %
    assert summary.interval == pytest.approx((3.0 - half, 3.0 + half))
    assert summary.quantiles == pytest.approx((1.2, 2.0, 3.0, 4.0, 4.8))


def test_one_run_has_no_spread_and_none_has_nothing():
    summary = statistics([2.0])
    assert summary.deviation is None and summary.interval is None and summary.mean == 2.0
    assert statistics([]) is None
    assert summary.inside(2.0) is summary.inside(1.0) is None
    line = Curve(np.array([0.0, 1.0]), np.array([0.0, 1.0]))
    assert band([line]).share_inside(line) is None and band([line, line]).share_inside(line) == 1.0


def test_the_interval_covers_the_mean_as_often_as_it_says():
    random = np.random.default_rng(1)
    samples = [statistics(list(random.normal(7.0, 2.0, 8))) for _ in range(2000)]
    share = np.mean([low <= 7.0 <= high for low, high in (s.interval for s in samples)])
    assert share == pytest.approx(0.95, abs=0.015)


def test_a_band_holds_nine_tenths_of_evenly_spread_lines():
    times = np.linspace(0.0, 1.0, 11)
    lines = [Curve(times, slope * times) for slope in np.linspace(0.0, 1.0, 101)]
    envelope = band(lines)
    assert envelope.low[-1] == pytest.approx(0.05) and envelope.high[-1] == pytest.approx(0.95)
    assert envelope.median[-1] == pytest.approx(0.5)
    assert envelope.share_inside(Curve(times[1:], 0.5 * times[1:])) == 1.0
    assert envelope.share_inside(Curve(times[1:], 0.99 * times[1:])) == 0.0
    assert envelope.share_inside(Curve(times + 5.0, times)) is None


def test_the_interval_of_a_parabola_is_where_it_rises():
    values = np.linspace(-1.0, 1.0, 41)
    interval = misfit_interval(values, values**2, 0.25)
    assert (interval.low, interval.high) == pytest.approx((-0.5, 0.5), abs=1e-2)
    assert not interval.open_below and not interval.open_above


def test_an_interval_that_the_runs_do_not_close_is_open():
    interval = misfit_interval([0.3, 0.1, 0.2], [0.5, 0.0, 0.05], 0.1)
    assert interval.open_below and not interval.open_above and interval.low == 0.1
    assert interval.high == pytest.approx(0.2 + 0.1 * 0.05 / 0.45)


def test_all_lows_of_a_ragged_misfit_count():
    interval = misfit_interval([0.0, 1.0, 2.0, 3.0, 4.0], [9.0, 0.0, 5.0, 0.5, 9.0], 1.0, False)
    assert (interval.low, interval.high) == (1.0, 3.0)
