"""A dam break strikes a square column: its impulse, and equal momentum on both sides."""

from collections.abc import Callable

import pytest

from quintet.coupler.files.recording import Recording

Run = Callable[..., dict]


@pytest.fixture(scope="module")
def results(run_scene: Run) -> dict:
    return run_scene("dam_break_column", "--preset", "quick", "--transport", "memory")


@pytest.mark.parametrize("name", ["impulse", "developed_force"])
def test_push_is_that_of_the_experiment(results: dict, name: str) -> None:
    outcome = results["by_name"][name]
    assert outcome["required"] and outcome["met"], outcome


@pytest.mark.parametrize("name", ["first_impulse", "peak", "arrival"])
def test_what_the_tip_does_is_told_beside_it(results: dict, name: str) -> None:
    outcome = results["by_name"][name]
    assert not outcome["required"] and outcome["value"] > 0.0


def test_column_feels_what_the_water_gives(results: dict) -> None:
    (link,) = results["ledger"]["links"]
    with Recording(results["folder"]) as recording:
        felt = recording.history("column", "measured_load.force", 0).sum(axis=0)
    assert felt == pytest.approx(link["impulse"], rel=1e-2)  # the last window's acts later
    assert link["momentum_residual"] < 1e-12


@pytest.mark.full
def test_push_is_that_of_the_experiment_with_finer_particles(run_scene: Run) -> None:
    results = run_scene("dam_break_column", "--preset", "fine")
    for name in ("impulse", "developed_force"):
        assert results["by_name"][name]["met"], results["by_name"][name]
