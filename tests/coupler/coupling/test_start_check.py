"""Loads that act a window late are warned of where a motion changes much in that window."""

from types import SimpleNamespace

import numpy as np
import pytest

from quintet.coupler.coupling.judgement.start_check import StartCheck

KEY = ("plate", "faces.position")
LOADED, FREE = [3], []  # transfers whose impulses wait for the next window
LOAD, NONE = np.ones((5, 3)), np.zeros((5, 3))  # N s, of the first window
TRANSFERS = [SimpleNamespace(giver="plate", taker="water", reads=("faces.position",))] * 3
TRANSFERS.append(SimpleNamespace(giver="water", taker="plate", reads=("load.force", "load.place")))
GIVES = {
    "water": {
        "load.force": SimpleNamespace(centring="impulse"),
        "load.place": SimpleNamespace(centring="instant"),
    }
}


def check_of(ways, late=LOADED, windows=0.1, load=LOAD):
    """A check that has seen windows [s] of a run, with ways [m] in each."""
    check, position = StartCheck(), np.zeros((5, 3))
    fields = {"load.force": load, "load.place": np.ones((5, 3))}
    for number, (way, window) in enumerate(np.broadcast(ways, windows), 1):
        check.check(
            SimpleNamespace(
                windows=SimpleNamespace(done=number),
                last_dt=window,
                previous={"plate": {"faces.position": position}, "water": fields},
                outputs={"plate": {"faces.position": position + way}, "water": fields},
                exchange=SimpleNamespace(transfers=TRANSFERS, gives=GIVES),
                late=late,
            ),
            [KEY] if number <= 2 else (),
        )
        position = position + way
        saved, check = check.save(), StartCheck()
        check.load(saved)
    return check


def test_a_motion_that_the_first_loads_begin_in_the_second_window_is_late():
    text = check_of((0.0, 0.3, 0.7)).warning(KEY, 0.1)
    assert "moves a window of 0.1 s late" in text and "by 30 % of its range" in text
    assert text.endswith("Set window to 0.003 s or less.")
    assert check_of((0.0, 0.05, 0.95)).warning(KEY, 0.1) == ""


def test_the_range_of_a_motion_is_that_of_all_windows():
    assert "by 30 %" in check_of((0.0, 0.3, 0.7, -0.7)).warning(KEY, 0.1)
    assert "by 23 %" in check_of((0.0, 0.3, -0.8, 1.3, -0.8)).warning(KEY, 0.1)


def test_a_motion_before_any_load_is_not_late():
    assert check_of((0.0, 0.3, 0.7), load=NONE).warning(KEY, 0.1) == ""


@pytest.mark.parametrize(
    ("ways", "late", "windows"),
    [
        ((0.3, 0.3, 0.4), LOADED, 0.1),
        ((0.15, 0.3, 0.55), LOADED, (0.05, 0.1, 0.1)),
        ((0.0, 0.3, 0.7), FREE, 0.1),
    ],
)
def test_an_even_motion_and_one_that_no_late_load_begins_are_resolved(ways, late, windows):
    assert check_of(ways, late, windows).warning(KEY, 0.1) == ""
