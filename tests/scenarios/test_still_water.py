"""Water at rest, coarse: it stays where it is, under its hydrostatic pressure."""

from collections.abc import Callable

import pytest

Run = Callable[..., dict]


@pytest.fixture(scope="module")
def results(run_scene: Run) -> dict:
    return run_scene("still_water", "--preset", "quick")


@pytest.mark.parametrize(
    "name", ["floor.pressure", "middle.pressure", "wall.pressure", "level", "speed"]
)
def test_still_water_stays_still(results: dict, name: str) -> None:
    outcome = results["by_name"][name]
    assert outcome["met"], outcome
