"""Gaps between fixed blocks: into which water goes, and how hard it presses there."""

from collections.abc import Callable

import pytest

Run = Callable[..., dict]

pytestmark = pytest.mark.slow
THIN = ("gap_0.5", "gap_0.75", "gap_1")


def test_water_fills_gaps_of_five_quarters_of_a_spacing_and_more(run_scene: Run) -> None:
    found = run_scene("gap", "--preset", "quick")
    wide = {name: one for name, one in found["by_name"].items() if name not in THIN}
    assert len(wide) == 5
    assert all(one["met"] for one in wide.values()), wide


@pytest.mark.xfail(raises=AssertionError, reason="films push where particles push already")
def test_films_press_in_the_narrow_gaps_too(run_scene: Run) -> None:
    found = run_scene("gap", "--preset", "quick", "--set", "components.water.gaps=true")
    assert all(one["met"] for one in found["by_name"].values()), found["by_name"]
