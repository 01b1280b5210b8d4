"""Files that have the names of other modules, where a run is started, are never run instead."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from started import write_scene

from quintet.coupler.scene.read import library, parse
from quintet.interfaces import manifest

NAMES = ("random", "numpy", "csv", "quintet", "struct", "matplotlib", "zenoh", "mpi4py", "h5py")
OVER = [pytest.param("zenoh", marks=pytest.mark.zenoh), pytest.param("mpi", marks=pytest.mark.mpi)]
FULL = pytest.mark.full
COMMAND = Path(sys.executable).with_name("quintet")


@pytest.fixture
def here(tmp_path, monkeypatch):
    """A current folder with files that must not be run."""
    for name in NAMES:
        (tmp_path / f"{name}.py").write_text(f"raise SystemExit('{name} of the current folder')\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def ran(*arguments):
    """Run a command, started as from a shell; return its status and all that it said."""
    plain = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    found = subprocess.run(
        [COMMAND, *map(str, arguments)], capture_output=True, text=True, env=plain
    )
    return found.returncode, found.stdout + found.stderr


def briefly(scene):
    """Run a scene that comes with quintet for its first windows."""
    table = parse(library()[scene])
    preset = table.get("presets", {}).get("quick")
    window = {**table, **(preset or {})}.get("window", "auto")
    end = 1e-5 if window == "auto" else 10 * window
    quick = [] if preset is None else ["--preset", "quick"]
    plain = ["--set", "output.interval=0", "--set", "output.pictures=[]"]
    return ["run", scene, *quick, "--set", f"end={end}", *plain]


FEW = ("block_on_slope", "still_water", "two_springs")  # of each solver one, and a user's class
SCENES = [pytest.param(one, marks=[] if one in FEW else FULL) for one in sorted(library())]


@pytest.mark.parametrize("scene", SCENES)
def test_scenes_run_beside_files_with_names_of_modules(here, scene):
    status, said = ran(*briefly(scene), "--transport", "memory", "--out", "out")
    assert status in (0, 1), said
    assert "of the current folder" not in said and "done" in said


@pytest.mark.parametrize("transport", OVER)
@pytest.mark.parametrize("scene", ["two_springs", pytest.param("still_water", marks=FULL)])
def test_components_in_processes_run_beside_them_too(here, scene, transport):
    status, said = ran(*briefly(scene), "--transport", transport, "--out", "out")
    assert status in (0, 1), said
    assert "of the current folder" not in said and "done" in said


@pytest.mark.parametrize("transport", ["memory", *OVER])
def test_components_of_the_scenes_folder_come_after_all_that_is_installed(here, transport):
    status, said = ran("run", write_scene(here, transport, 0.01), "--out", "out")
    assert status == 0, said


def test_a_study_runs_beside_them_too(here):
    path = write_scene(here, end=0.005)
    path.write_text(path.read_text() + '[[study]]\nlabel = "as it is"\nsettings = {}\n')
    status, said = ran("study", path, "--out", "out")
    assert "as it is: done" in said and status in (0, 1), said


def test_a_benchmark_and_the_laws_of_the_contract_are_tried_beside_them_too(here):
    write_scene(here)
    conform = ["conform", "--scene", "scene.toml", "--component", "ping"]
    for command in (["bench", "toys:COUNTED", "--case", "small"], conform):
        status, said = ran(*command)
        assert status in (0, 1) and "of the current folder" not in said, said


@pytest.mark.full
@pytest.mark.parametrize(
    "command",
    [
        ["bench", "exchange", "--transport", "zenoh"],
        ["bench", "exchange", "--transport", "mpi"],
        ["list"],
        ["check", "dam_break_cubes", "--preset", "quick"],
    ],
    ids=" ".join,
)
def test_other_commands_run_beside_them_too(here, command):
    status, said = ran(*command)
    assert status == 0 and "of the current folder" not in said, said


def test_folders_come_last_and_the_latest_first_of_them(monkeypatch):
    monkeypatch.setattr(sys, "path", ["/installed"])
    monkeypatch.setattr(manifest, "_looked_in", [])
    manifest.look_in(["/one", "/here"])
    manifest.look_in(["/other", "/here", "/installed"])
    assert sys.path == ["/installed", "/other", "/here", "/one"]
