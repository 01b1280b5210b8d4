"""Gaps between fixed blocks: into which water goes, and how hard it presses there."""

from collections.abc import Callable

import pytest

Run = Callable[..., dict]

pytestmark = pytest.mark.slow
WIDE = ("gap_1.25", "gap_1.5", "gap_2", "gap_3", "gap_4")


def test_films_mend_narrow_gaps_and_leave_those_that_particles_fill(run_scene: Run) -> None:
    found, alone = (
        run_scene(
            "gap", "--preset", "quick", "--set", f"components.water.boundary.lubrication_films={on}"
        )["by_name"]
        for on in ("true", "false")
    )
    assert len(found) == 10
    assert all(one["met"] for one in found.values()), found
    for name in WIDE:  # the first is as wide as films reach, to rounding
        assert found[name]["value"] == pytest.approx(alone[name]["value"], rel=1e-12)
    assert not any(alone[name]["met"] for name in ("gap_0.1", "gap_0.25", "gap_0.5"))
