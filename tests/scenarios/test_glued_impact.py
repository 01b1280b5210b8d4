"""A ball strikes particles that are glued to finite elements, coarse and short."""

from collections.abc import Callable

import pytest

from quintet.coupler.cli import main

Run = Callable[..., dict]
QUICK = ("al_ball_7400_glued", "--preset", "quick")


@pytest.fixture(scope="module")
def results(run_scene: Run) -> dict:
    return run_scene(*QUICK, "--transport", "memory")


def test_crater_and_rear_are_those_of_particles_alone(results: dict) -> None:
    assert all(outcome["met"] for outcome in results["expect"]), results["expect"]


def test_momentum_and_energy_pass_the_glue(results: dict) -> None:
    (link,) = results["ledger"]["links"]
    assert link["momentum_residual"] <= 1e-12
    assert results["energy_gained"] < 3e-3


@pytest.mark.full
@pytest.mark.parametrize("transport", ["zenoh", "mpi"])
def test_bits_are_the_same_over_all_transports(
    run_scene: Run, capsys: pytest.CaptureFixture[str], results: dict, transport: str
) -> None:
    over_transport = run_scene(*QUICK, "--transport", transport)
    with pytest.raises(SystemExit) as ended:
        main(["diff", str(results["folder"]), str(over_transport["folder"])])
    assert ended.value.code == 0, capsys.readouterr().out


@pytest.mark.full
@pytest.mark.parametrize("preset", ["", "half"])
def test_a_plate_with_a_rim_of_elements_is_struck_as_one_of_particles(
    run_scene: Run, preset: str
) -> None:
    chosen = ("--preset", preset) if preset else ()
    results = run_scene("al_ball_7400_glued", "--transport", "memory", *chosen)
    assert all(outcome["met"] for outcome in results["expect"]), results["expect"]
    (link,) = results["ledger"]["links"]
    assert link["momentum_residual"] <= 1e-12
    assert results["energy_gained"] < 0.03
