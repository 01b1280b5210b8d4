"""Dust in gas over a direct link, and spheres on springs, against exact solutions."""

import json
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from quintet.coupler.files.recording import Recording
from quintet.coupler.report.diff import compare
from quintet.coupler.run import snapshots
from quintet.coupler.run.simulate import make_folder, simulate
from quintet.coupler.scene.read import load
from quintet.coupler.scene.scene import ComponentPlan
from quintet.interfaces.errors import SceneError

Run = Callable[..., dict]
MEMORY = ("--transport", "memory")


def closes(results: dict) -> None:
    """Check that momentum and heat over the links balance to rounding."""
    for link in results["ledger"]["links"]:
        assert link["momentum_residual"] <= 1e-12
        assert link["heat_residual"] <= 1e-12


def test_dust_and_a_stream_relax_to_each_other_as_four_equations_have_it(run_scene: Run) -> None:
    results = run_scene("dust_in_stream", *MEMORY)
    closes(results)
    assert max(results["by_name"][name]["value"] for name in ("velocity", "launched")) < 1e-4
    assert results["by_name"]["temperature"]["met"]
    with Recording(results["folder"]) as recording:
        for name in ("momentum", "energy"):
            drift = recording.field("gas", f"balance.{name}_drift")
            assert np.abs(drift).max() < 1e-12


def test_behind_a_shock_dust_and_gas_relax_as_conservation_laws_have_it(run_scene: Run) -> None:
    results = run_scene("dusty_shock", "--preset", "quick", *MEMORY)
    closes(results)
    assert all(outcome["met"] for outcome in results["expect"]), results["expect"]
    with Recording(results["folder"]) as recording:
        for name in ("mass", "momentum", "energy"):
            drift = recording.field("gas", f"balance.{name}_drift")
            assert np.abs(drift).max() < 1e-9  # nodes in even rows; the inflow is hardly met


def test_the_last_of_a_row_of_spheres_swings_as_the_first_did(run_scene: Run) -> None:
    results = run_scene("newtons_cradle", "--preset", "quick", *MEMORY)
    assert all(outcome["met"] for outcome in results["expect"]), results["expect"]
    assert results["energy_gained"] < 1e-6


@pytest.mark.full
def test_a_grain_relaxes_and_falls_as_stokes_has_it(run_scene: Run) -> None:
    """u (1 - exp(-t/τ)) along the stream and g τ (1 - exp(-t/τ)) down it, over the link."""
    end, pull, stream = 3e-3, 2e4, 100.0  # s, m/s2, m/s
    settings = {"end": end, "components.dust.gravity": f"[0.0, 0.0, {-pull}]"}
    settings["components.gas.particles.reaction"] = "false"
    options = [word for name, value in settings.items() for word in ("--set", f"{name}={value}")]
    results = run_scene("dust_in_stream", *MEMORY, *options)
    with Recording(results["folder"]) as recording:
        times = recording.times("dust")
        velocity = recording.field("dust", "spheres.velocity")[:, 0]
    viscosity = 1.78e-5 * (300.0 / 273.15) ** 1.5 * (273.15 + 110.4) / (300.0 + 110.4)
    tau = 2000.0 * 1e-10 / (18.0 * viscosity)
    share = 1.0 - np.exp(-times / tau)
    assert np.abs(velocity[:, 0] - stream * share).max() < 1e-4 * stream
    assert np.abs(velocity[:, 2] + pull * tau * share).max() < 1e-4 * pull * tau
    closes(results)


@pytest.mark.full
@pytest.mark.parametrize("preset", ["compressible", "henderson"])
def test_other_correlations_end_in_the_same_equilibrium(run_scene: Run, preset: str) -> None:
    results = run_scene("dusty_shock", "--preset", preset, *MEMORY)
    closes(results)
    assert results["by_name"]["pressure"]["met"]


@pytest.mark.full
@pytest.mark.zenoh
@pytest.mark.parametrize("scene", ["dusty_shock", "dust_in_stream"])
def test_two_processes_and_a_resumption_give_the_bits_of_one_process(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, scene: str
) -> None:
    monkeypatch.setattr(snapshots, "remove", lambda paths: None)
    settings = ("end=1e-4", "output.snapshots=3e-5")

    def scene_over(transport: str):
        return load(scene, settings=settings, transport=transport)

    for transport in ("memory", "zenoh"):
        loaded = scene_over(transport)
        make_folder(loaded, tmp_path / transport)
        assert simulate(loaded, tmp_path / transport) in (0, 1)  # too short for what is expected
    resumed = tmp_path / "again"
    shutil.copytree(tmp_path / "zenoh", resumed)
    files = sorted(resumed.glob("snapshot-*.h5"), key=snapshots.window_of)
    assert simulate(scene_over("zenoh"), resumed, files[0]) in (0, 1)
    assert compare(tmp_path / "memory", tmp_path / "zenoh") is None
    assert compare(tmp_path / "memory", resumed) is None


LARGE = "components.dust.spheres.1.radius=0.01"  # nodes are 0.01 m apart


def test_spheres_larger_than_the_spacing_are_refused_as_the_scene_is_checked() -> None:
    with pytest.raises(SceneError, match=r"largest_diameter requests; found 0\.02 m of item 16"):
        load("dust_in_stream", settings=[LARGE])


def test_spheres_larger_than_the_spacing_are_refused_before_the_first_window(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """A kind may know its first fields only after the start, as with layers of nodes."""
    monkeypatch.setattr(ComponentPlan, "initial", lambda _: {})
    scene = load("dust_in_stream", settings=[LARGE, 'transport="memory"'])
    make_folder(scene, tmp_path)
    assert simulate(scene, tmp_path) == 2
    results = json.loads((tmp_path / "results.json").read_text())
    assert results["status"] == "refused" and results["windows"] == 0
    assert "dust.spheres.diameter must be at most 0.01 m" in results["cause"]
