"""Orders, limits and shares of errors that are known."""

import numpy as np
import pytest

from quintet.coupler.measures.convergence import Limit, observed_order, richardson
from quintet.coupler.measures.error_split import REST, Trend, shares

SIZES = [0.4, 0.2, 0.1, 0.05]


def test_orders_are_those_of_exact_powers():
    order = observed_order(SIZES, [2.0 * h**1.5 for h in SIZES])
    assert order.order == pytest.approx(1.5) and order.constant == pytest.approx(2.0)
    assert (order.low, order.high) == pytest.approx((1.5, 1.5), abs=1e-6)
    assert observed_order([0.1], [1.0]) is None
    assert observed_order([0.1, 0.1], [1.0, 2.0]) is None
    assert observed_order([0.1, 0.2], [0.0, 1.0]) is None


def test_two_sizes_have_an_order_without_an_interval():
    order = observed_order([0.2, 0.1], [0.4, 0.1])
    assert order.order == pytest.approx(2.0) and order.low is None and order.high is None


def test_the_interval_is_that_of_a_linear_regression():
    """As numpy gives the variance of a slope, and a table Student's quantile for two degrees."""
    errors = [0.17, 0.039, 0.011, 0.0024]
    order = observed_order(SIZES, errors)
    fit, variance = np.polyfit(np.log(SIZES), np.log(errors), 1, cov=True)
    half = 4.302653 * np.sqrt(variance[0, 0])
    assert order.order == pytest.approx(fit[0])
    assert (order.low, order.high) == pytest.approx((fit[0] - half, fit[0] + half), rel=1e-6)


@pytest.mark.parametrize("finest", [0.0, 0.025])
def test_the_interval_holds_the_true_order_as_often_as_it_says(finest):
    rng = np.random.default_rng(1)
    h, trials, inside = np.array(SIZES), 400, 0
    for _ in range(trials):
        errors = 3.0 * (h**2 - finest**2) * np.exp(0.05 * rng.standard_normal(len(h)))
        order = observed_order(SIZES, errors, finest)
        inside += order.low <= 2.0 <= order.high
    assert inside / trials == pytest.approx(0.95, abs=0.03)


def test_errors_against_the_finest_run_give_the_order_against_the_limit():
    finest = 0.025
    errors = [0.7 * (h**2 - finest**2) for h in SIZES]
    order = observed_order(SIZES, errors, finest)
    assert order.order == pytest.approx(2.0, abs=1e-4)
    assert order.at(0.1) == pytest.approx(0.007, rel=1e-3)
    assert observed_order(SIZES, errors).order > 2.1  # as if the finest run were exact


@pytest.mark.parametrize("errors", [[0.1] * 3, [0.1, 0.2, 0.4], [0.1, 1e-9, 1e-18]])
def test_errors_against_the_finest_run_that_follow_no_power_have_no_order(errors):
    assert observed_order(SIZES[:3], errors, 0.05) is None


@pytest.mark.parametrize("sizes", [SIZES, [0.4, 0.2, 0.15], [0.31, 0.2, 0.05]])
def test_richardson_finds_the_limit_in_any_ratio_of_sizes(sizes):
    limit = richardson(sizes, [3.0 - 2.0 * h**1.5 for h in sizes])
    assert limit.order == pytest.approx(1.5) and limit.value == pytest.approx(3.0)
    assert limit.at(0.1) == pytest.approx(-2.0 * 0.1**1.5)
    assert limit.uncertainty == pytest.approx(1.25 * 2.0 * min(sizes) ** 1.5)


def test_values_that_do_not_settle_have_no_limit():
    assert richardson([0.4, 0.2, 0.1], [1.0, 2.0, 1.0]) is None  # not monotonic
    assert richardson([0.4, 0.2, 0.1], [1.0, 2.0, 4.0]) is None  # runs away
    assert richardson([0.4, 0.2, 0.1], [1.0, 2.0, 2.0]) is None
    assert richardson([0.4, 0.2], [1.0, 2.0]) is None


def test_the_error_is_split_by_what_each_kind_contributes():
    spacing, coupling = Limit(0.0, 0.0, 2.0, 3.0), Limit(0.0, 0.0, 1.0, -1.0)
    trends = {"spacing": Trend(spacing, None), "coupling": Trend(coupling, None)}
    sizes = {"spacing": 0.1, "coupling": 0.02}  # contributions of 0.03 and -0.02
    split = shares(trends, sizes, 0.06)  # so that 0.05 are left
    assert split == pytest.approx({"spacing": 0.3, "coupling": 0.2, REST: 0.5})
    split = shares(trends, sizes, None)
    assert split == pytest.approx({"spacing": 0.6, "coupling": 0.4})


def test_what_a_kind_contributes_may_not_be_known():
    trends = {"spacing": Trend(Limit(0.0, 0.0, 2.0, 3.0), None), "coupling": Trend(None, None)}
    split = shares(trends, {"spacing": 0.1, "coupling": 0.02}, -0.03)
    assert split == pytest.approx({"spacing": 1 / 3, "coupling": None, REST: 2 / 3})
    by_order = Trend(None, observed_order([0.2, 0.1], [0.04, 0.01]))
    split = shares({"time step": by_order}, {"time step": 0.1}, -0.02)
    assert split == pytest.approx({"time step": 0.5, REST: 0.5})
