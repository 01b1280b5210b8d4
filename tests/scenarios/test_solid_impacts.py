"""Impacts of bodies of particles, coarse: a ball on a plate, a bar on a wall."""

from collections.abc import Callable

import pytest

Run = Callable[..., dict]


def test_a_ball_at_7400_m_per_s_leaves_its_crater_and_keeps_the_energy(run_scene: Run) -> None:
    results = run_scene("al_ball_7400", "--preset", "quick")
    assert all(outcome["met"] for outcome in results["expect"]), results["expect"]
    assert results["energy_gained"] < 3e-3


def test_a_bar_has_its_published_length_foot_and_strain(run_scene: Run) -> None:
    results = run_scene("taylor_bar_sph", "--preset", "quick")
    assert all(outcome["met"] for outcome in results["expect"]), results["expect"]
    assert results["energy_gained"] < 3e-3


def test_rubber_rings_bounce_off_whole(run_scene: Run) -> None:
    results = run_scene("rubber_rings", "--preset", "quick")
    assert all(outcome["met"] for outcome in results["expect"]), results["expect"]
    assert not results["warnings"]
    assert results["energy_gained"] < 3e-3


def test_a_ball_perforates_the_plate_that_stops_one_of_half_its_size(run_scene: Run) -> None:
    for preset in ("quick", "small"):
        spacing = ("--set", "components.impact.spacing=8e-4")
        results = run_scene("steel_ball_923", "--preset", preset, *spacing)
        assert all(outcome["met"] for outcome in results["expect"]), results["expect"]
        assert results["energy_gained"] < 3e-3


@pytest.mark.full
@pytest.mark.parametrize("preset", ["no_spall", "quarter"])
def test_the_ball_without_spall_and_in_three_dimensions(run_scene: Run, preset: str) -> None:
    results = run_scene("al_ball_7400", "--preset", preset)
    assert all(outcome["met"] for outcome in results["expect"]), results["expect"]
    assert results["energy_gained"] < 0.03
