"""The main job, small: fluid and bodies, in one process and in several."""

import json
from pathlib import Path

import pytest
import pyvista

from quintet.coupler.cli import main
from quintet.coupler.files.recording import Recording
from quintet.coupler.files.vtkhdf_reader import scene as read_scene
from quintet.coupler.files.vtkhdf_reader import times
from quintet.coupler.report.diff import compare

SCENE = str(Path(__file__).parent / "small_dam.toml")
STRUCK = ("--set", "end=0.15")  # s


def run(out: Path, *options: str, status: int = 0) -> dict:
    with pytest.raises(SystemExit) as ended:
        main(["run", SCENE, "--out", str(out), *options])
    results = json.loads((out / "results.json").read_text())
    assert ended.value.code == status, results
    return results


@pytest.fixture(scope="module")
def live(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict]:
    out = tmp_path_factory.mktemp("live")
    return out, run(out)


@pytest.fixture(scope="module")
def struck(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of a run until the water has struck the cube, in one process."""
    out = tmp_path_factory.mktemp("struck")
    (link,) = run(out, *STRUCK)["ledger"]["links"]
    assert link["impulse"][0] > 0.0
    return out


def test_water_pushes_the_cube_downstream(live: tuple[Path, dict]) -> None:
    with Recording(live[0]) as recording:
        x = recording.history("cube", "motion.position", 0)[:, 0]
    assert x[-1] > x[0] + 0.005


def test_momentum_closes_to_rounding(live: tuple[Path, dict]) -> None:
    (link,) = live[1]["ledger"]["links"]
    assert 0.0 < link["impulse"][0]
    assert link["momentum_residual"] < 1e-12


@pytest.mark.parametrize(("window", "ratio"), [(2e-4, 1), (1.4e-3, 7), (1e-2, 50)])
def test_momentum_closes_at_every_ratio(tmp_path: Path, window: float, ratio: int) -> None:
    # The courant number sets the fluid's step, and with it how often it steps in a window.
    # In windows of fifty steps the coupling makes energy, and is told to be unstable.
    status = 1 if ratio == 50 else 0
    results = run(tmp_path, "--set", f"window={window}", "--set", "end=0.2", status=status)
    assert ("stability" in [warning["subject"] for warning in results["warnings"]]) == (status == 1)
    steps = results["timing"]["components"]["water"]["steps"]
    assert steps / results["windows"] == pytest.approx(ratio, rel=0.3)
    (link,) = results["ledger"]["links"]
    assert link["impulse"][0] > 0.0
    assert link["momentum_residual"] < 1e-12


@pytest.mark.zenoh
def test_zenoh_gives_the_same_bits(struck: Path, tmp_path: Path) -> None:
    run(tmp_path, *STRUCK, "--transport", "zenoh")
    assert compare(struck, tmp_path) is None


@pytest.mark.mpi
def test_mpi_gives_the_same_bits(struck: Path, tmp_path: Path) -> None:
    run(tmp_path, *STRUCK, "--transport", "mpi")
    assert compare(struck, tmp_path) is None


def test_threads_change_no_bit(struck: Path, tmp_path: Path) -> None:
    run(tmp_path, *STRUCK, "--transport", "zenoh", "--set", "components.water.threads=2")
    assert compare(struck, tmp_path) is None


def test_a_replayed_cube_gives_the_water_the_same_bits(struck: Path, tmp_path: Path) -> None:
    setting = 'output.fields=["water.surface_load.force"]'  # which no link reads now
    run(tmp_path, *STRUCK, "--swap", f"cube=replay@{struck}", "--set", setting)
    with Recording(struck) as original, Recording(tmp_path) as replayed:
        force = "surface_load.force"
        assert original.field("water", force).tobytes() == replayed.field("water", force).tobytes()


def test_a_prescribed_cube_runs(tmp_path: Path) -> None:
    results = run(tmp_path, *STRUCK, "--swap", "cube=prescribed")
    assert results["status"] == "done"


def test_views_are_left_for_every_component(live: tuple[Path, dict]) -> None:
    views = ["cube.vtkhdf", "cube.walls.vtkhdf", "water.vtkhdf", "water.walls.vtkhdf"]
    assert sorted(path.name for path in live[0].glob("*.vtkhdf")) == views


def test_pyvista_opens_all_views_at_all_steps(live: tuple[Path, dict]) -> None:
    for path in live[0].glob("*.vtkhdf"):
        reader = pyvista.get_reader(str(path)).reader
        reader.UpdateInformation()
        assert reader.GetNumberOfSteps() == len(times(path)) > 0
        for k, time in enumerate(times(path)):
            reader.SetStep(k)
            reader.Update()
            mesh = pyvista.wrap(reader.GetOutput())
            assert reader.GetTimeValue() == time and mesh.n_points and mesh.n_cells
            assert list(mesh.field_data["scene"]) == [read_scene(path)] == ["small_dam"]
            if path.name == "water.vtkhdf":
                units = "points m; velocity m/s; density kg/m3; pressure Pa"
                assert list(mesh.field_data["units"]) == [units]
