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
    """Their energy, rounding until then, is no matter."""
    settings = "--set", "end=6e-6", "--set", "expect=[]"
    found = run_scene("glued_bar", "--transport", "memory", *settings)
    assert found["warnings"] == []


def test_a_wave_passes_the_glue_both_ways_with_little_echo(run_scene: Run) -> None:
    found = run_scene("glued_bar", "--transport", "memory")
    for name in ("echo.in_elements", "echo.in_particles"):
        assert found["by_name"][name]["met"], found["by_name"][name]
    (link,) = found["ledger"]["links"]
    assert link["momentum_residual"] <= 1e-12
    assert link["kinematic_residual"] <= 1e-12
    assert found["warnings"] == []  # what runs ahead of the wave decides nothing
    assert found["energy_gained"] < 0.03  # the work of the pulse is none that is made


def test_other_ratios_of_steps_are_refused_with_the_reason(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["check", "glued_bar", "--set", "links.0.substeps=2"])
    assert ended.value.code == 2
    said = " ".join(capsys.readouterr().err.split())
    assert "substeps must be 1; found 2: glue is stable only when both sides step once" in said


@pytest.mark.full
@pytest.mark.parametrize("transport", ["zenoh", "mpi"])
def test_bits_are_the_same_over_all_transports(
    run_scene: Run, capsys: pytest.CaptureFixture[str], transport: str
) -> None:
    folders = [
        str(run_scene("glued_bar", "--transport", one, "--set", "end=4e-6")["folder"])
        for one in ("memory", transport)
    ]
    with pytest.raises(SystemExit) as ended:
        main(["diff", *folders])
    assert ended.value.code == 0, capsys.readouterr().out


@pytest.mark.full
@pytest.mark.parametrize("transits", [30, 100])
def test_energy_of_the_coupled_bar_stays(run_scene: Run, transits: int) -> None:
    """Elements and particles of a step of their own size each, one exchange for every step."""
    settings = ["output.totals=2e-6", "output.record=false", f"end={transits * TRANSIT}"]
    options = [part for one in settings for part in ("--set", one)]
    found = run_scene("glued_bar", "--transport", "memory", *options)
    energy: dict[float, float] = {}
    with (found["folder"] / "ledger.csv").open() as file:
        for row in csv.DictReader(file):
            if row["internal"]:
                time, parts = float(row["time"]), ("kinetic", "potential", "internal")
                energy[time] = energy.get(time, 0.0) + sum(float(row[one]) for one in parts)
    known = np.array([value for time, value in sorted(energy.items()) if time > LOADED])
    assert np.abs(known / known[0] - 1.0).max() < 0.01
