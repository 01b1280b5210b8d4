"""Gauges that no fluid can reach are refused before a run."""

import re

import pytest
from fluid_params import nested
from tubes import TUBE, tube

from quintet.components.sph_fluid import SphFluidParams
from quintet.coupler.scene.read import load
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import read


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


@pytest.mark.parametrize(
    ("section", "changes", "words"),
    [
        (0.1, {}, "0.15 m or more from its face x-, or it misses"),
        (1.9, {}, r"0.15 m or more from its face x\+, .* found x = 1.9 m"),
        (2.5, {}, r"must be inside the tank, 0.15 m or more from its face x\+"),
        (0.1, {"boundary.inflow": [], "boundary.outflow": [], "boundary.open_faces": ["x+"]},
         "0.15 m or more from its face x-"),
        (2.1, {"boundary.inflow": [], "boundary.outflow": [], "boundary.periodic": ["x"],
               "boundary.open_faces": []}, r"inside the tank, 0 m or more from its face x\+"),
    ],
)  # fmt: skip
def test_a_section_that_misses_flow_is_refused(section, changes, words):
    settings = TUBE | {"gauges.discharge_gauges": [section], "gauges.velocity_gauges": []} | changes
    params, mistakes = read(SphFluidParams, nested(settings), "water")
    assert params is None
    assert any(re.search(words, mistake) for mistake in mistakes), mistakes


@pytest.mark.parametrize(
    ("section", "changes"),
    [
        (0.15, {}),
        (1.95, {"boundary.inflow": [], "boundary.outflow": []}),
        (2.0, {"boundary.inflow": [], "boundary.outflow": [], "boundary.periodic": ["x"],
               "boundary.open_faces": []}),
    ],
)  # fmt: skip
def test_a_section_reads_all_flow_at_free_and_periodic_faces(section, changes):
    fluid = tube(**{"gauges.discharge_gauges": [section], "gauges.velocity_gauges": []} | changes)
    assert fluid.params.gauges.discharge_gauges == (section,)
