"""Windows: exact ticks to the end, as long as the state allows, few changes of length."""

import math

import numpy as np
import pytest

from quintet.coupler.coupling.windows import CALM, Windows, auto_length, in_ticks, run_windows
from quintet.interfaces.errors import StepError


def lengths(windows, stable=lambda time: math.inf, limit=100_000):
    """Ticks of all windows to the end, where the state allows `stable` [s] at each time [s]."""
    ticks = []
    while not windows.finished and len(ticks) < limit:
        ticks.append(windows.next(stable(windows.time)))
        windows.advance(ticks[-1])
    return np.array(ticks)


@pytest.mark.parametrize("end", [1.0, 0.3, 1.8, 1e-6, 12345.678])
def test_fixed_windows_are_one_tick_each_and_end_at_the_end(end):
    windows = run_windows(end, end / 7.05, follows=False, exact=False)
    assert (lengths(windows) == 1).all() and windows.done == 7
    assert windows.time == 7 * (end / 7)


@pytest.mark.parametrize(
    ("end", "length", "count"),
    [
        (1.0, 0.67, 2),
        (0.8, 1.5e-4, 5333),
        (1.0, 0.5, 2),
        (1.0, 0.4999, 2),
        (1.0, 0.49, 3),
        (1.0, 3.0, 1),
    ],
)
def test_fixed_windows_are_hardly_longer_than_asked(end, length, count):
    windows = run_windows(end, length, follows=False, exact=False)
    assert windows.end == count and windows.tick <= 1.01 * length


@pytest.mark.parametrize("end", [1.0, 0.3, 1.8, 1e-6, 12345.678])
def test_windows_that_follow_end_exactly_at_the_end(end):
    windows = run_windows(end, math.inf, follows=True, exact=True)
    lengths(windows, lambda time: end / 97.3)
    assert windows.time == end  # to the bit


def test_fixed_windows_beside_a_group_that_follows_end_exactly_too():
    windows = run_windows(0.3, 0.1, follows=False, exact=True)
    ticks = lengths(windows)
    assert len(ticks) == 3 and windows.time == 0.3
    assert np.ptp(ticks) <= 1


@pytest.mark.parametrize("stable", [0.013, 1.7e-5])
def test_lengths_have_four_significant_bits_and_lose_little(stable):
    windows = run_windows(1.0, math.inf, follows=True, exact=True)
    ticks = int(lengths(windows, lambda time: stable, limit=1)[0])
    assert ticks.bit_length() - 4 <= (ticks & -ticks).bit_length() - 1
    assert 8 / 9 * stable < ticks * windows.tick <= stable


def test_a_number_is_met_exactly_while_the_state_allows_it():
    windows = run_windows(12.0, 0.2, follows=True, exact=True)
    seconds = windows.tick * lengths(windows, lambda time: 0.05 if 5.0 < time < 6.0 else 0.2)
    np.testing.assert_allclose(seconds[:25], 0.2, rtol=1e-12)
    assert windows.time == 12.0


def test_windows_shorten_at_once_and_lengthen_twofold_after_a_calm():
    windows = run_windows(200.0, math.inf, follows=True, exact=True)
    seconds = windows.tick * lengths(windows, lambda time: 0.8 if 10.0 < time < 20.0 else 6.4)
    starts = np.concatenate([[0.0], np.cumsum(seconds)])
    assert seconds[(starts[:-1] > 10.0) & (starts[:-1] < 20.0)].max() <= 0.8
    short = np.flatnonzero(seconds <= 0.8)
    assert len(short) >= CALM  # it waits before it lengthens
    assert (seconds[1:] / seconds[:-1])[:-2].max() <= 2.0


def test_a_step_that_hovers_about_a_limit_soon_changes_no_length():
    random = np.random.default_rng(2)
    windows = run_windows(50.0, math.inf, follows=True, exact=True)
    ticks = lengths(windows, lambda time: 0.1 * (1.0 + 0.1 * random.random()))
    assert len(set(ticks[20:-3].tolist())) == 1


def test_windows_meet_pictures_and_snapshots_without_slivers():
    windows = run_windows(1.0, math.inf, follows=True, exact=True)
    windows.stops = [in_ticks(0.25, windows.tick)]
    windows.marks = (in_ticks(0.6, windows.tick),)
    ticks = lengths(windows, lambda time: 0.03)
    ends = np.cumsum(ticks) * windows.tick
    for time in (0.25, 0.5, 0.6, 0.75, 1.0):
        assert np.abs(ends - time).min() <= windows.tick
    assert ticks.min() * windows.tick > 0.4 * 0.028


def test_a_state_that_allows_no_step_is_refused():
    windows = run_windows(1.0, math.inf, follows=True, exact=True)
    for stable in (0.0, -1.0, math.nan):
        with pytest.raises(StepError, match="the stable step must be positive"):
            windows.next(stable)
    with pytest.raises(StepError, match=r"the stable step must be at least 2.22e-16 s"):
        windows.next(1e-17)


@pytest.mark.parametrize(
    ("stable", "equal", "length", "why"),
    [
        ([1e-3, 2e-4], [], 1e-3, "the largest stable step"),
        ([1e-3, 1e-6], [], 64e-6, "64 times the smallest"),
        ([math.inf, 1e-3], [], 1e-3, "the largest stable step"),  # a path that allows any step
        ([1e-3, 2e-4], [1e-3, 2e-4], 2e-4, "that must step equally"),
        ([math.inf], [], math.inf, "a 100th of the run"),
    ],
)
def test_auto_is_the_largest_finite_step_within_bounds(stable, equal, length, why):
    window, reason = auto_length(stable, equal)
    assert window == pytest.approx(length) and why in reason


def test_windows_of_a_group_divide_those_around_it():
    windows = Windows(1.0, 1)
    windows.divide(0.02, 0.003)
    assert (lengths(windows) == 1).all() and windows.end == 7
    assert windows.time == pytest.approx(0.02, rel=1e-15)
    windows.divide(0.01, 0.003)
    assert len(lengths(windows)) == 4 and windows.done == 11


@pytest.mark.parametrize("stable", [0.025, 0.5, math.inf])
def test_windows_of_a_group_that_may_be_longer_are_those_around_it(stable):
    outer = run_windows(0.48, 0.02, follows=False, exact=True)
    inner = Windows(outer.tick, 1, follows=True)
    while not outer.finished:
        inner.end = outer.next(math.inf)
        inner.begin()
        done = inner.done
        lengths(inner, lambda time: stable)
        outer.advance(inner.end)
        assert inner.done == done + 1


def test_saved_windows_go_on_alike():
    def stable(time):
        return 0.02 if 0.2 < time < 0.3 else 0.07

    original, restored = (run_windows(2.0, math.inf, follows=True, exact=True) for _ in range(2))
    lengths(original, stable, limit=20)
    restored.load(original.save())
    assert (lengths(original, stable) == lengths(restored, stable)).all()
