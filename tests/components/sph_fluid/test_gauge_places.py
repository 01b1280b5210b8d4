"""Gauges that no fluid can reach are refused before a run."""

import pytest

from quintet.coupler.scene.read import load
from quintet.interfaces.errors import SceneError


@pytest.mark.parametrize(
    ("key", "place", "words"),
    [
        ("pressure_gauges", [0.5, 0.1, 9.0], r"pressure_gauges\[0\] must be inside the walls al"),
        ("pressure_gauges", [-0.1, 0.1, 0.1], "along x"),
        ("level_gauges", [0.5, 7.0], r"level_gauges\[0\] must be inside the walls along y"),
    ],
)
def test_a_gauge_beyond_a_wall_is_refused(key, place, words):
    settings = [f"components.water.gauges={{{key} = [{place}]}}"]
    with pytest.raises(SceneError, match=words):
        load("dam_break_box", settings=settings)


def test_a_gauge_inside_an_obstacle_is_refused():
    settings = ["components.water.gauges.pressure_gauges=[[2.45, 0.6, 0.1]]"]
    with pytest.raises(SceneError, match=r"must not be inside boundary\.obstacles\[0\]"):
        load("dam_break_box", settings=settings)


def test_a_gauge_above_an_open_tank_is_accepted():
    settings = ["components.water.gauges.pressure_gauges=[[2.0, 0.6, 0.3]]"]
    assert load("dam_break_box", settings=settings)
