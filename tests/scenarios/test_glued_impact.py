"""A ball strikes particles that are glued to finite elements, coarse and short."""

from collections.abc import Callable

import pytest

from quintet.coupler.cli import main

Run = Callable[..., dict]
QUICK = ("al_ball_7400_glued", "--preset", "quick")


@pytest.fixture(scope="module")
def found(run_scene: Run) -> dict:
    return run_scene(*QUICK, "--transport", "memory")


def test_crater_and_rear_are_those_of_particles_alone(found: dict) -> None:
    assert all(one["met"] for one in found["expect"]), found["expect"]


def test_momentum_and_energy_pass_the_glue(found: dict) -> None:
    (link,) = found["ledger"]["links"]
    assert link["momentum_residual"] <= 1e-12
    assert found["energy_gained"] < 3e-3


@pytest.mark.full
@pytest.mark.parametrize("transport", ["zenoh", "mpi"])
def test_bits_are_the_same_over_all_transports(
    run_scene: Run, capsys: pytest.CaptureFixture[str], found: dict, transport: str
) -> None:
    other = run_scene(*QUICK, "--transport", transport)
    with pytest.raises(SystemExit) as ended:
        main(["diff", str(found["folder"]), str(other["folder"])])
    assert ended.value.code == 0, capsys.readouterr().out


@pytest.mark.full
@pytest.mark.parametrize("preset", ["", "half"])
def test_a_plate_with_a_rim_of_elements_is_struck_as_one_of_particles(
    run_scene: Run, preset: str
) -> None:
    chosen = ("--preset", preset) if preset else ()
    found = run_scene("al_ball_7400_glued", "--transport", "memory", *chosen)
    assert all(one["met"] for one in found["expect"]), found["expect"]
    (link,) = found["ledger"]["links"]
    assert link["momentum_residual"] <= 1e-12
    assert found["energy_gained"] < 0.03
