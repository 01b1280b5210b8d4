"""A plate strikes another, coarse: the jumps of a shock, the release, and where it spalls."""

from collections.abc import Callable

import pytest

Run = Callable[..., dict]


@pytest.fixture(scope="module")
def results(run_scene: Run) -> dict:
    return run_scene("flyer", "--preset", "quick")


def test_shock_release_and_spall_are_where_the_material_has_them(results: dict) -> None:
    assert all(outcome["met"] for outcome in results["expect"]), results["expect"]


def test_energy_is_kept_through_shock_release_and_spall(results: dict) -> None:
    assert results["energy_gained"] < 1e-3


@pytest.mark.full
@pytest.mark.parametrize("preset", ["steel", "fast", "thick"])
def test_other_materials_and_speeds_are_as_close(run_scene: Run, preset: str) -> None:
    results = run_scene("flyer", "--preset", preset)
    assert all(outcome["met"] for outcome in results["expect"]), results["expect"]
