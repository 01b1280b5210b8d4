"""A dam break meets a fixed box, coarse: arrival, pressure, and the flow round the box."""

from collections.abc import Callable

import numpy as np
import pytest

from quintet.coupler.files.vtkhdf_reader import read_step, times

pytestmark = pytest.mark.slow

Run = Callable[..., dict]


def falls_short(reason: str) -> pytest.MarkDecorator:
    return pytest.mark.xfail(strict=True, raises=AssertionError, reason=reason)


LATE = falls_short("the tip is thinner than a particle, and late; less so with finer ones")


@pytest.fixture(scope="module")
def results(run_scene: Run) -> dict:
    return run_scene("dam_break_box", "--preset", "quick", "--set", "output.interval=0.3")


@pytest.mark.parametrize(
    "name",
    [
        "p1.peak",
        pytest.param("p1.arrival", marks=LATE),
        "p3.peak",
        pytest.param("p3.arrival", marks=LATE),
    ],
)
def test_pressure_is_that_of_the_experiment(results: dict, name: str) -> None:
    outcome = results["by_name"][name]
    assert outcome["met"], outcome


def test_water_reaches_the_box(results: dict) -> None:
    outcome = results["by_name"]["front.arrival"]
    assert outcome["value"] == pytest.approx(outcome["reference"], rel=0.2), outcome


def test_water_goes_round_the_box_and_not_into_it(results: dict) -> None:
    file = results["folder"] / "water.vtkhdf"
    points = read_step(file, len(times(file)) - 1)[1]["points"]
    depth = np.minimum(points - [2.3955, 0.2985, -1.0], [2.5565, 0.7015, 0.161] - points)
    assert depth.min(axis=1).max() < 0.05  # not a spacing deep
    assert points[:, 0].max() > 2.6
