"""A user's files are never deleted: a run's folder is new, or one that this program wrote."""

import hashlib
import json
import signal
import sys

import pytest
from started import Started, write_scene

import quintet
from quintet.coupler.cli import main
from quintet.coupler.files.run_files import LOCK, MARKER, RECORDING, read_marker
from quintet.coupler.run import results
from quintet.coupler.run.folder import FORMER
from quintet.interfaces.errors import DiskError, SceneError

OVER = [pytest.param("zenoh", marks=pytest.mark.zenoh), pytest.param("mpi", marks=pytest.mark.mpi)]
STUDY = (
    '[[study]]\nlabel = "a"\nsettings = {}\n[[study]]\nlabel = "b"\nsettings = { end = 0.004 }\n'
)


def status(*arguments):
    with pytest.raises(SystemExit) as exit_info:
        main([str(argument) for argument in arguments])
    return exit_info.value.code


def content(folder):
    """All files of a folder, the lock apart."""
    files = (path for path in sorted(folder.rglob("*")) if path.is_file() and path.name != LOCK)
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in files
    }


@pytest.fixture
def scene(tmp_path, monkeypatch):
    """A scene in a current folder of its own, and a first run of it in `out`."""
    monkeypatch.chdir(tmp_path)
    path = write_scene(tmp_path, end=0.005)
    path.write_text("# mine\n" + path.read_text() + STUDY)
    return path


def test_a_run_does_not_touch_the_folder_of_its_scene(scene, tmp_path, capsys):
    (tmp_path / "log").mkdir()
    (tmp_path / "log" / "diary.txt").write_text("mine")
    (tmp_path / "mine.vtkhdf").write_text("mine")
    old_content = content(tmp_path)
    for command in ("run", "study"):
        assert status(command, scene, "--out", ".") == 2
        assert status(command, scene, "--out", ".", "--force") == 2
    message = capsys.readouterr().err
    assert message.count("it holds files that no run left (log, mine.vtkhdf, scene.toml, ...)") == 4
    assert content(tmp_path) == old_content


@pytest.mark.parametrize("name", ["../../x", "/x", "a/b", "..", "", ".hidden", "a b"])
def test_the_name_of_a_scene_is_no_path(scene, name, capsys):
    assert status("run", scene, "--set", f'name="{name}"') == 2
    assert (
        "scene.name must be a plain name of letters, digits, _ . and -, begin"
        in capsys.readouterr().err
    )


def test_runs_without_a_folder_are_numbered(scene, tmp_path, capsys):
    for folder in ("toy", "toy-2", "toy-3"):
        assert status("run", scene) == 0
        assert f"left in runs/{folder}\n" in capsys.readouterr().out
        assert read_marker(tmp_path / "runs" / folder).scene == "toy"
    first_content = content(tmp_path / "runs" / "toy")
    assert status("run", scene, "--force", "--set", "end=0.003") == 0
    assert "left in runs/toy\n" in capsys.readouterr().out
    assert json.loads((tmp_path / "runs/toy/results.json").read_text())["windows"] == 3
    assert content(tmp_path / "runs" / "toy").keys() == first_content.keys()


def test_a_run_is_replaced_only_where_asked_and_only_what_it_wrote(scene, tmp_path, capsys):
    out = tmp_path / "out"
    assert status("run", scene, "--out", out) == 0
    first_content = content(out)
    assert {MARKER, "scene.toml", "results.json"} <= first_content.keys()
    assert status("run", scene, "--out", out) == 2
    assert (
        f"--out {out}: it holds a run of toy. Name another folder, or replace it with --force."
        in (capsys.readouterr().err)
    )
    assert content(out) == first_content
    for name in ("notes.txt", "mine.vtkhdf", "mine.png", "convergence-mine.csv", "log/mine.log"):
        (out / name).write_text("mine")
    assert status("run", scene, "--out", out, "--force", "--set", "end=0.003") == 0
    assert json.loads((out / "results.json").read_text())["windows"] == 3
    assert (out / "notes.txt").read_text() == (out / "mine.vtkhdf").read_text() == "mine"
    assert content(out).keys() == first_content.keys() | {
        "notes.txt", "mine.vtkhdf", "mine.png", "convergence-mine.csv", "log/mine.log"
    }  # fmt: skip


@pytest.mark.parametrize(
    "arguments", [("--swap", "ping=nothing"), ("--elsewhere", "ping"), ("--set", "end=-1")]
)
def test_a_refused_run_leaves_the_former_one(scene, tmp_path, arguments):
    assert status("run", scene, "--out", "out") == 0
    old_content = content(tmp_path / "out")
    assert status("run", scene, "--out", "out", "--force", *arguments) == 2
    assert content(tmp_path / "out") == old_content


def test_a_run_that_is_refused_as_ports_are_joined_leaves_the_former_one(
    scene, tmp_path, monkeypatch
):
    from quintet.coupler.run import simulate

    def refuse(*_):
        raise SceneError("no")

    assert status("run", scene, "--out", "out") == 0
    old_content = content(tmp_path / "out")
    monkeypatch.setattr(simulate, "run", refuse)
    assert status("run", scene, "--out", "out", "--force") == 2
    assert content(tmp_path / "out") == old_content
    assert not (tmp_path / "out" / FORMER).exists()


@pytest.mark.mpi
def test_without_a_launcher_the_former_run_stays(scene, tmp_path, monkeypatch):
    assert status("run", scene, "--out", "out") == 0
    old_content = content(tmp_path / "out")
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(sys, "executable", str(tmp_path / "python"))
    assert status("run", scene, "--out", "out", "--force", "--transport", "mpi") == 2
    assert status("run", scene, "--out", "new", "--transport", "mpi") == 2
    assert content(tmp_path / "out") == old_content and not (tmp_path / "new").exists()


@pytest.mark.parametrize("transport", OVER)
def test_a_run_in_processes_replaces_a_former_one_alike(scene, tmp_path, transport):
    assert status("run", scene, "--out", "out", "--transport", transport) == 0
    first_content = content(tmp_path / "out")
    assert status("run", scene, "--out", "out", "--transport", transport, "--force") == 0
    assert content(tmp_path / "out").keys() == first_content.keys()


def test_a_file_and_a_folder_that_cannot_be_written_are_told_in_a_sentence(scene, tmp_path, capsys):
    (tmp_path / "file").write_text("mine")
    assert status("run", scene, "--out", "file") == 2
    assert status("run", scene, "--out", "file/below") == 2
    assert status("run", scene, "--out", "/proc/none") == 2
    message = capsys.readouterr().err
    assert "it must be a folder; it is a file. Name another." in message
    assert message.count("it cannot be written (") == 2 and "Traceback" not in message
    assert (tmp_path / "file").read_text() == "mine"


def test_two_runs_in_one_folder_do_not_mix(tmp_path, capsys):
    path = write_scene(tmp_path, end=0.1, pong="pause = 0.02")
    run = Started(path)
    run.wait_until(lambda: (run.folder / "recording.h5").is_file())
    for command in (["run", path, "--out", run.folder, "--force"], ["run", "--resume", run.folder]):
        assert status(*command) == 2
    message = capsys.readouterr().err
    assert "another run is using it. Wait for its end, or name another folder." in message
    assert run.wait() == 0 and run.results["windows"] == 100


def test_the_lock_of_a_process_that_died_is_no_obstacle(tmp_path):
    path = write_scene(tmp_path, end=0.1, pong="pause = 0.02")
    run = Started(path, "--set", "output.snapshots=0.01")
    run.wait_until(lambda: list(run.folder.glob("snapshot-*.h5")))
    run.process.send_signal(signal.SIGKILL)
    run.wait()
    assert (run.folder / LOCK).exists()
    assert status("run", "--resume", run.folder) == 0


def test_only_a_run_is_resumed(scene, tmp_path, capsys):
    assert status("run", "--resume", tmp_path) == 2
    assert f"{tmp_path}: it must be the folder of a run" in capsys.readouterr().err
    assert status("study", scene, "--out", "all") == 0
    assert status("run", "--resume", "all") == 2
    assert "it must be the folder of a run; it is that of a study." in capsys.readouterr().err


def test_a_study_replaces_only_what_a_study_wrote(scene, tmp_path, capsys):
    out = tmp_path / "all"
    assert status("study", scene, "--out", out) == 0
    first_content = content(out)
    assert status("study", scene, "--out", out) == 2
    assert "it holds a study of toy." in capsys.readouterr().err
    assert status("run", scene, "--out", out, "--force") == 2
    assert content(out) == first_content
    assert status("study", scene, "--out", out, "--keep") == 0
    (out / "notes.txt").write_text("mine")
    assert status("study", scene, "--out", out, "--force") == 0
    assert content(out).keys() == first_content.keys() | {"notes.txt"}
    assert (out / "a" / "run.log").read_text()


def test_a_study_begins_nothing_where_a_run_would_meet_foreign_files(scene, tmp_path):
    out = tmp_path / "all"
    assert status("study", scene, "--out", out) == 0
    (out / "b" / MARKER).unlink()
    old_content = content(out)
    assert status("study", scene, "--out", out, "--keep") == 2
    assert content(out) == old_content


def test_python_follows_the_same_rules(scene, tmp_path):
    assert quintet.run(scene).folder == tmp_path / "runs" / "toy"
    assert quintet.run(scene).folder == tmp_path / "runs" / "toy-2"
    with pytest.raises(SceneError, match="it holds a run of toy"):
        quintet.run(scene, out="runs/toy")
    with pytest.raises(SceneError, match="it holds files that no run left"):
        quintet.run(scene, out=".", force=True)
    assert quintet.run(scene, out="runs/toy", force=True).ok
    with pytest.raises(SceneError, match="it must be the folder of a run"):
        quintet.resume(tmp_path)


def test_a_marker_cannot_name_files_outside_its_folder(scene, tmp_path):
    assert status("run", scene, "--out", "out") == 0
    marker = json.loads((tmp_path / "out" / MARKER).read_text())
    marker["files"] += ["../scene.toml", str(scene)]
    (tmp_path / "out" / MARKER).write_text(json.dumps(marker))
    assert status("run", scene, "--out", "out", "--force") == 0
    assert scene.read_text().startswith("# mine")


def test_a_run_whose_results_cannot_be_written_leaves_its_recording(scene, monkeypatch, capsys):
    def fail(*_):
        raise DiskError("results.json: it cannot be written.")

    monkeypatch.setattr(results, "write", fail)
    assert status("run", scene, "--out", "kept") == 2
    assert "results.json: it cannot be written." in capsys.readouterr().err
    assert (scene.parent / "kept" / RECORDING).stat().st_size > 0
