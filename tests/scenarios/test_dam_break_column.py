"""A dam break meets a square column: how it pushes, and that the column feels what water gives."""

from collections.abc import Callable

import pytest

from quintet.coupler.files.recording import Recording

Run = Callable[..., dict]


@pytest.fixture(scope="module")
def found(run_scene: Run) -> dict:
    return run_scene("dam_break_column", "--preset", "quick", "--transport", "memory")


@pytest.mark.parametrize("name", ["impulse", "developed_force"])
def test_push_is_that_of_the_experiment(found: dict, name: str) -> None:
    one = found["by_name"][name]
    assert one["required"] and one["met"], one


@pytest.mark.parametrize("name", ["first_impulse", "peak", "arrival"])
def test_what_the_tip_does_is_told_beside_it(found: dict, name: str) -> None:
    one = found["by_name"][name]
    assert not one["required"] and one["value"] > 0.0


def test_column_feels_what_the_water_gives(found: dict) -> None:
    (link,) = found["ledger"]["links"]
    with Recording(found["folder"]) as recording:
        felt = recording.history("column", "measured_load.force", 0).sum(axis=0)
    assert felt == pytest.approx(link["impulse"], rel=1e-2)  # what was given last is felt later
    assert link["momentum_residual"] < 1e-12


@pytest.mark.full
def test_push_is_that_of_the_experiment_with_finer_particles(run_scene: Run) -> None:
    found = run_scene("dam_break_column", "--preset", "fine")
    for name in ("impulse", "developed_force"):
        assert found["by_name"][name]["met"], found["by_name"][name]
