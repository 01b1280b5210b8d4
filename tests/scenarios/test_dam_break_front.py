"""The front of a dam break, coarse: two experiments, and the bound of Ritter."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from quintet.coupler.files.recording import Recording

Run = Callable[..., dict]


@pytest.fixture(scope="module")
def results(run_scene: Run) -> dict:
    return run_scene("dam_break_front", "--preset", "quick")


@pytest.mark.parametrize("name", ["front.martin_moyce", "front.koshizuka_oka"])
def test_front_is_that_of_the_experiment(results: dict, name: str) -> None:
    outcome = results["by_name"][name]
    assert outcome["within"] == 0.05
    assert outcome["met"], outcome


def test_front_goes_on_and_is_never_faster_than_ritters(results: dict) -> None:
    with Recording(results["folder"]) as recording:
        times = recording.times("water")
        front = recording.history("water", "front_gauge.position", 0)
    assert front[0] == pytest.approx(1.0)
    assert front[-1] > 4.0
    speed = np.diff(front) / np.diff(times)
    assert speed[times[1:] > 0.3].min() > 0.0
    # 2 sqrt(g H); readings pass from particle to particle, so over ten of them.
    smooth = (front[10:] - front[:-10]) / (times[10:] - times[:-10])
    assert smooth.max() < 2.0 * math.sqrt(9.81 * 2.0)
