"""Gaps between fixed blocks: into which water goes, and how hard it presses there."""

from collections.abc import Callable

import pytest

from quintet.scenarios.gap.table import main

Run = Callable[..., dict]

pytestmark = pytest.mark.full
WIDE = ("gap_1.25", "gap_1.5", "gap_2", "gap_3", "gap_4")


def test_films_mend_narrow_gaps_and_leave_those_that_particles_fill(
    run_scene: Run, capsys: pytest.CaptureFixture[str]
) -> None:
    films = "components.water.boundary.lubrication_films"
    settings = ("--preset", "quick", "--set", "output.interval=0.1")
    runs = [run_scene("gap", *settings, "--set", f"{films}={on}") for on in ("true", "false")]
    with_films, without_films = (run["by_name"] for run in runs)
    assert len(with_films) == 10
    assert all(outcome["met"] for outcome in with_films.values()), with_films
    for name in WIDE:  # the first is as wide as films reach, to rounding
        assert with_films[name]["value"] == pytest.approx(without_films[name]["value"], rel=1e-12)
    assert not any(without_films[name]["met"] for name in ("gap_0.1", "gap_0.25", "gap_0.5"))
    capsys.readouterr()
    main([str(run["folder"]) for run in runs])
    rows = [line.split("|") for line in capsys.readouterr().out.splitlines()]
    assert len(rows) == 2 + 10
    filled = float(rows[-1][2].split(",")[0])  # pressure in the widest gap, over that outside
    assert filled == pytest.approx(1.0, abs=0.2)
