"""Bodies that fly through a gas with clouds of their own."""

from collections.abc import Callable

import pytest

Run = Callable[..., dict]


@pytest.mark.full
@pytest.mark.parametrize(
    "preset",
    [
        "fixed", "half", "quick", "oblique", "no_slip_fixed",
        "space_fixed", "space", "space_oblique_fixed", "space_oblique",
    ],
)  # fmt: skip
def test_what_a_body_feels_does_not_depend_on_who_moves(run_scene: Run, preset: str) -> None:
    found = run_scene("moving_sphere", "--preset", preset)
    assert all(one["met"] for one in found["expect"]), found["expect"]


@pytest.mark.full
def test_a_particle_that_crosses_a_shock_layer_raises_a_ring_of_pressure(run_scene: Run) -> None:
    found = run_scene("shock_layer_particle")
    assert all(one["met"] for one in found["expect"]), found["expect"]
    assert all(one["momentum_residual"] <= 1e-12 for one in found["ledger"]["links"])
