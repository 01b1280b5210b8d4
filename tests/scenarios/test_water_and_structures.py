"""Water on and around elastic structures: what crosses the link, and what these do."""

import csv
from collections.abc import Callable
from pathlib import Path

import pytest

from quintet.coupler.cli import main

Run = Callable[..., dict]
GATE = str(Path(__file__).parent / "elastic_gate.toml")
COARSE = (
    "components.water.spacing=0.1",
    "components.water.fluid=[[[0.0,0.0,0.0],[1.0,0.5,2.0]]]",
    "components.water.boundary.walls=[[0.0,0.0,-0.3],[1.0,0.5,2.3]]",
    "components.plate.parts.0.highest=[1.0,0.5,0.0]",
    "components.plate.parts.0.elements=[20,1,4]",
    "components.plate.integration=reduced",
    "end=0.03",
)


def _options(settings: tuple[str, ...]) -> list[str]:
    return [part for one in settings for part in ("--set", one)]


def test_water_on_a_plate_bends_it_and_the_link_conserves_momentum(run_scene: Run) -> None:
    found = run_scene("water_on_plate", "--transport", "memory", *_options(COARSE))
    (link,) = found["ledger"]["links"]
    assert link["momentum_residual"] <= 1e-12
    assert link["angular_residual"] <= 1e-12
    assert link["energy_residual"] < 1e-2
    # It bears nearly all of the weight of the water, over 0.03 s; the walls some at its ends.
    assert link["impulse"][2] == pytest.approx(-0.5 * 19620.0 * 0.03, rel=0.1)


SHORT = ("end=0.002",)


@pytest.mark.parametrize(("acceleration", "most"), [("iqn-ils", 4.0), ("aitken", 4.0)])
def test_a_gate_lighter_than_its_water_is_iterated_in_few_repetitions(
    run_scene: Run, acceleration: str, most: float
) -> None:
    """Wetted on one side, sampled on all: both sides of the link do the same work."""
    chosen = (*SHORT, f"iteration.acceleration={acceleration}")
    found = run_scene(GATE, "--transport", "memory", *_options(chosen))
    (link,) = found["ledger"]["links"]
    assert link["momentum_residual"] <= 1e-12
    assert link["energy_residual"] < 0.1
    with (found["folder"] / "convergence.csv").open() as file:
        repeated = [int(row["repetitions"]) for row in csv.DictReader(file)]
    assert sum(repeated) / len(repeated) < most


def test_a_plate_thinner_than_the_water_can_see_is_refused(
    capsys: pytest.CaptureFixture[str], tmp_path: object
) -> None:
    thin = (
        "components.gate.parts.0.highest=[0.102,0.0125,0.079]",
        "components.gate.coupled_faces=[{lowest=[0.1,0.0,0.0],highest=[0.102,1.0,0.079]}]",
        "end=1e-3",
    )
    out = ["--out", f"{tmp_path}/thin", "--transport", "memory"]
    with pytest.raises(SystemExit) as ended:
        main(["run", GATE, *out, *_options(thin)])
    assert ended.value.code == 2
    said = " ".join(capsys.readouterr().err.split())
    assert "a body must be at least 0.0025 m thick between its faces" in said
