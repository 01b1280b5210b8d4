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
def current_folder(tmp_path, monkeypatch):
    """A current folder with files that must not be run."""
    for name in NAMES:
        (tmp_path / f"{name}.py").write_text(f"raise SystemExit('{name} of the current folder')\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run_command(*arguments):
    """Run a command, started as from a shell; return its status and its output."""
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    result = subprocess.run(
        [COMMAND, *map(str, arguments)], capture_output=True, text=True, env=environment
    )
    return result.returncode, result.stdout + result.stderr


def short_run(scene):
    """Run a scene that comes with quintet for its first windows."""
    table = parse(library()[scene])
    preset = table.get("presets", {}).get("quick")
    window = {**table, **(preset or {})}.get("window", "auto")
    end = 1e-5 if window == "auto" else 10 * window
    preset_arguments = [] if preset is None else ["--preset", "quick"]
    output_settings = ["--set", "output.interval=0", "--set", "output.pictures=[]"]
    return ["run", scene, *preset_arguments, "--set", f"end={end}", *output_settings]


FEW = ("block_on_slope", "still_water", "two_springs")  # of each solver one, and a user's class
SCENES = [pytest.param(name, marks=[] if name in FEW else FULL) for name in sorted(library())]


@pytest.mark.parametrize("scene", SCENES)
def test_scenes_run_beside_files_with_names_of_modules(current_folder, scene):
    status, output = run_command(*short_run(scene), "--transport", "memory", "--out", "out")
    assert status in (0, 1), output
    assert "of the current folder" not in output and "done" in output


@pytest.mark.parametrize("transport", OVER)
@pytest.mark.parametrize("scene", ["two_springs", pytest.param("still_water", marks=FULL)])
def test_components_in_processes_run_beside_them_too(current_folder, scene, transport):
    status, output = run_command(*short_run(scene), "--transport", transport, "--out", "out")
    assert status in (0, 1), output
    assert "of the current folder" not in output and "done" in output


@pytest.mark.parametrize("transport", ["memory", *OVER])
def test_components_of_the_scenes_folder_come_after_all_that_is_installed(
    current_folder, transport
):
    status, output = run_command(
        "run", write_scene(current_folder, transport, 0.01), "--out", "out"
    )
    assert status == 0, output


def test_a_study_runs_beside_them_too(current_folder):
    path = write_scene(current_folder, end=0.005)
    path.write_text(path.read_text() + '[[study]]\nlabel = "as it is"\nsettings = {}\n')
    status, output = run_command("study", path, "--out", "out")
    assert "as it is: done" in output and status in (0, 1), output


def test_a_benchmark_and_the_laws_of_the_contract_are_tried_beside_them_too(current_folder):
    write_scene(current_folder)
    conform = ["conform", "--scene", "scene.toml", "--component", "ping"]
    for command in (["bench", "toys:COUNTED", "--case", "small"], conform):
        status, output = run_command(*command)
        assert status in (0, 1) and "of the current folder" not in output, output


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
def test_other_commands_run_beside_them_too(current_folder, command):
    status, output = run_command(*command)
    assert status == 0 and "of the current folder" not in output, output


def test_folders_come_last_and_the_latest_first_of_them(monkeypatch):
    monkeypatch.setattr(sys, "path", ["/installed"])
    monkeypatch.setattr(manifest, "_looked_in", [])
    manifest.look_in(["/one", "/here"])
    manifest.look_in(["/other", "/here", "/installed"])
    assert sys.path == ["/installed", "/other", "/here", "/one"]
