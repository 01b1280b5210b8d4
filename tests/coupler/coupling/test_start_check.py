"""Loads that act a window late are warned of where a motion changes much in that window."""

from types import SimpleNamespace

import numpy as np
import pytest

from quintet.coupler.coupling.judgement.start_check import StartCheck

KEY = ("plate", "faces.position")
LOADED, FREE = [3], []  # transfers whose impulses wait for the next window


def check_of(ways, late, windows=(0.1, 0.1)):
    """A check that has seen the first two windows [s] of a run, with ways [m] in each."""
    check, at = StartCheck(), np.zeros((5, 3))
    transfers = [SimpleNamespace(taker=name) for name in ("water", "water", "water", "plate")]
    for done, (way, window) in enumerate(zip(ways, windows, strict=True), 1):
        check.check(
            SimpleNamespace(
                windows=SimpleNamespace(done=done),
                last_dt=window,
                previous={"plate": {"faces.position": at}},
                outputs={"plate": {"faces.position": at + way}},
                exchange=SimpleNamespace(transfers=transfers),
                late=late,
            ),
            [KEY],
        )
        at = at + way
        saved, check = check.save(), StartCheck()
        check.load(saved)
    return check


RANGE = np.sqrt(15.0)  # of 1 m at every point


def test_a_motion_that_the_first_loads_begin_in_the_second_window_is_late():
    text = check_of((0.0, 0.3), LOADED).warning(KEY, RANGE, 0.1)
    assert "moves a window of 0.1 s late" in text and "by 30 % of its range" in text
    assert text.endswith("Set window to 0.003 s or less.")
    assert check_of((0.0, 0.05), LOADED).warning(KEY, RANGE, 0.1) == ""


@pytest.mark.parametrize(
    ("ways", "late", "windows"),
    [
        ((0.3, 0.3), LOADED, (0.1, 0.1)),
        ((0.15, 0.3), LOADED, (0.05, 0.1)),
        ((0.0, 0.3), FREE, (0.1, 0.1)),
    ],
)
def test_an_even_motion_and_one_that_no_late_load_begins_are_resolved(ways, late, windows):
    assert check_of(ways, late, windows).warning(KEY, RANGE, 0.1) == ""
