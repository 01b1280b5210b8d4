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


def test_films_leave_gaps_alone_that_particles_enter(run_scene: Run) -> None:
    # The ladder of the scene has rungs with other walls, which films do not go with.
    short = ("--preset", "quick", "--set", "study=[]", "--set")
    found, alone = (
        run_scene("gap", *short, f"components.water.gaps={on}")["by_name"]
        for on in ("true", "false")
    )
    assert found == alone
