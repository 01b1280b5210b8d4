"""A tank that rolls, coarse: the water rises at the sensor as it did in the experiment."""

from collections.abc import Callable

import pytest

Run = Callable[..., dict]


@pytest.fixture(scope="module")
def results(run_scene: Run) -> dict:
    return run_scene("spheric_10", "--preset", "quick", "--set", "end=1.0")


def test_the_water_rises_at_the_sensor_before_it_breaks(results: dict) -> None:
    rise = results["by_name"]["rise"]
    assert rise["met"], rise


def test_the_work_of_the_roll_is_counted(results: dict) -> None:
    energy = results["ledger"]["energy_balance"]["components"]["water"]
    assert energy["outside"] > 0.0
    assert energy["change"] == pytest.approx(energy["outside"], rel=0.01)  # nothing breaks yet
