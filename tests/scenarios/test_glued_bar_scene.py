"""A wave crosses an interface of finite elements and particles that are glued to them."""

import csv
from collections.abc import Callable

import numpy as np
import pytest

from quintet.coupler.cli import main

Run = Callable[..., dict]
TRANSIT = 0.12 / 6108.0  # s, of a wave through the bar and the rod
LOADED = 3.93e-6  # s, end of the pulse


def test_nothing_is_warned_of_before_the_wave_has_reached_the_particles(run_scene: Run) -> None:
    """Until then the energy of the particles is rounding error."""
    settings = "--set", "end=6e-6", "--set", "expect=[]"
    results = run_scene("glued_bar", "--transport", "memory", *settings)
    assert results["warnings"] == []


def test_a_wave_passes_the_glue_both_ways_with_little_echo(run_scene: Run) -> None:
    results = run_scene("glued_bar", "--transport", "memory")
    for name in ("echo.in_elements", "echo.in_particles"):
        assert results["by_name"][name]["met"], results["by_name"][name]
    (link,) = results["ledger"]["links"]
    assert link["momentum_residual"] <= 1e-12
    assert link["kinematic_residual"] <= 1e-12
    assert results["warnings"] == []  # precursors of the wave cause none
    assert results["energy_gained"] < 0.03  # without the work of the pulse


def test_other_ratios_of_steps_are_refused_with_the_reason(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["check", "glued_bar", "--set", "links.0.substeps=2"])
    assert ended.value.code == 2
    message = " ".join(capsys.readouterr().err.split())
    assert "substeps must be 1; found 2: glue is stable only when both sides step once" in message


@pytest.mark.full
@pytest.mark.parametrize("transport", ["zenoh", "mpi"])
def test_bits_are_the_same_over_all_transports(
    run_scene: Run, capsys: pytest.CaptureFixture[str], transport: str
) -> None:
    folders = [
        str(run_scene("glued_bar", "--transport", kind, "--set", "end=4e-6")["folder"])
        for kind in ("memory", transport)
    ]
    with pytest.raises(SystemExit) as ended:
        main(["diff", *folders])
    assert ended.value.code == 0, capsys.readouterr().out


@pytest.mark.full
@pytest.mark.parametrize("transits", [30, 100])
def test_energy_of_the_coupled_bar_stays(run_scene: Run, transits: int) -> None:
    """Elements and particles of a step of their own size each, one exchange for every step."""
    settings = ["output.totals=2e-6", "output.record=false", f"end={transits * TRANSIT}"]
    options = [word for setting in settings for word in ("--set", setting)]
    results = run_scene("glued_bar", "--transport", "memory", *options)
    energy: dict[float, float] = {}
    with (results["folder"] / "ledger.csv").open() as file:
        for row in csv.DictReader(file):
            if row["internal"]:
                time, parts = float(row["time"]), ("kinetic", "potential", "internal")
                energy[time] = energy.get(time, 0.0) + sum(float(row[part]) for part in parts)
    energies = np.array([value for time, value in sorted(energy.items()) if time > LOADED])
    assert np.abs(energies / energies[0] - 1.0).max() < 0.01
