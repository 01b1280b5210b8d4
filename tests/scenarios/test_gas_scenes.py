"""Shock tubes, a vortex and a wedge, coarse: errors against exact solutions, and balances."""

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from quintet.coupler.report.diff import compare
from quintet.coupler.run import snapshots
from quintet.coupler.run.simulate import make_folder, simulate
from quintet.coupler.scene.read import load

Run = Callable[..., dict]


@pytest.mark.parametrize("scene", ["shock_tube", "vortex", "wedge"])
def test_a_gas_does_as_its_exact_solution_says(run_scene: Run, scene: str) -> None:
    results = run_scene(scene, "--preset", "quick")
    assert all(outcome["met"] for outcome in results["expect"]), results["expect"]


@pytest.mark.full
@pytest.mark.parametrize("preset", ["lax", "rarefactions", "woodward_colella", "noh", "vacuum"])
def test_harder_tubes_do_as_their_exact_solutions_say(run_scene: Run, preset: str) -> None:
    results = run_scene("shock_tube", "--preset", preset)
    assert all(outcome["met"] for outcome in results["expect"]), results["expect"]


@pytest.mark.full
def test_errors_fall_by_their_orders(run_scene: Run) -> None:
    def error(scene: str, spacing: float, *options: str) -> float:
        results = run_scene(scene, "--set", f"components.gas.box.spacing={spacing}", *options)
        return float(results["by_name"]["density"]["value"])

    vortex = [error("vortex", 10.0 / nodes) for nodes in (24, 48, 96)]
    assert vortex[0] > 2.0**2.3 * vortex[1] and vortex[1] > 2.0**2.3 * vortex[2]
    sod = [error("shock_tube", 1.0 / (nodes - 1)) for nodes in (100, 200, 400)]
    assert sod[0] > 2.0 * sod[1] and sod[1] > 2.0 * sod[2]
    for jitter, order in ((0.0, 1.0), (0.6, 0.88)):
        rough = ("--set", f"components.gas.box.jitter={jitter}")
        sod = [error("shock_tube", 1.0 / (nodes - 1), *rough) for nodes in (100, 400)]
        assert sod[0] > 4.0**order * sod[1]


@pytest.mark.full
def test_a_wedge_may_be_a_wall(run_scene: Run) -> None:
    results = run_scene("wedge", "--preset", "wall")
    assert all(outcome["met"] for outcome in results["expect"]), results["expect"]


@pytest.mark.full
@pytest.mark.parametrize(
    "transport",
    [
        pytest.param("zenoh", marks=pytest.mark.zenoh),
        pytest.param("mpi", marks=pytest.mark.mpi),
    ],
)
def test_every_transport_gives_a_gas_the_same_bits(run_scene: Run, transport: str) -> None:
    over_default = run_scene("shock_tube", "--preset", "quick")
    over_transport = run_scene("shock_tube", "--preset", "quick", "--transport", transport)
    assert compare(over_default["folder"], over_transport["folder"]) is None


def test_a_gas_goes_on_from_a_snapshot_with_the_same_bits(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(snapshots, "remove", lambda paths: None)
    settings = ("output.snapshots=0.1", "output.pictures=[]")
    scene = load("shock_tube", "quick", settings)
    first, resumed = tmp_path / "first", tmp_path / "again"
    make_folder(scene, first)
    assert simulate(scene, first) == 0
    shutil.copytree(first, resumed)
    files = sorted(resumed.glob("snapshot-*.h5"), key=snapshots.window_of)
    assert simulate(load("shock_tube", "quick", settings), resumed, files[0]) == 0
    assert compare(first, resumed) is None
