"""A square floats in two dimensions, ten spacings across: how deep it lies, and its period."""

from collections.abc import Callable

import pytest

from quintet.coupler.cli import main
from quintet.scenarios.floating_cube.linear import added, period

Run = Callable[..., dict]


def test_square_heaves_and_comes_to_rest_as_linear_theory_and_archimedes_say(
    run_scene: Run,
) -> None:
    results = run_scene("floating_square", "--preset", "quick")
    (link,) = results["ledger"]["links"]
    assert link["momentum_residual"] < 1e-12
    for name in ("draught", "period"):
        assert results["by_name"][name]["met"], results["by_name"][name]


def test_reference_is_that_of_a_rectangle_in_infinite_water() -> None:
    # On cells of 0.015 m the period is 1 % above the one carried on to none.
    assert period(0.015, planar=True)[0] == pytest.approx(0.828, rel=0.015)
    # DNV-RP-C205, table D-1: C_A = 1.65 at 0.625 wide for its height, (π/2) a² C_A / (2a d) = 0.81.
    assert added(3.0, 2.25, 0.015, float("inf"), planar=True) == pytest.approx(0.81, rel=0.05)


def test_two_dimensions_beside_three_are_refused_before_anything_starts(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["check", "floating_square", "--set", "components.water.dimensions=3"])
    assert ended.value.code == 2
    message = " ".join(capsys.readouterr().err.split())
    assert "both sides must have two dimensions or both three; square has two, water" in message
