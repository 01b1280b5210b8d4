"""A standing wave, coarse: its period, and how it fades."""

from collections.abc import Callable

import pytest

from quintet.coupler.files.recording import Recording

Run = Callable[..., dict]


@pytest.fixture(scope="module")
def results(run_scene: Run) -> dict:
    return run_scene("standing_wave", "--preset", "quick")


@pytest.mark.parametrize("name", ["period", "decay"])
def test_wave_is_that_of_linear_theory(results: dict, name: str) -> None:
    outcome = results["by_name"][name]
    assert outcome["met"], outcome


def test_wave_starts_with_its_energy_and_falls_in_the_middle(results: dict) -> None:
    with Recording(results["folder"]) as recording:
        kinetic = recording.history("water", "motion_gauge.kinetic", 0)
        level = recording.history("water", "level_gauge.height", 0)
    assert kinetic[0] == pytest.approx(0.25 * 1000.0 * 9.81 * 0.02**2 * 0.1, rel=0.02)
    assert level[0] == pytest.approx(0.5, abs=0.005)
    assert level[20] < level[0] - 0.01  # a quarter of a period later
