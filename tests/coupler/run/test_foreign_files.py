"""No command changes a byte of a foreign file, and each refuses it in one sentence."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from started import same, write_scene
from test_folder import content, status

from quintet.coupler.files.json_file import JsonFile
from quintet.coupler.files.run_files import MARKER

AT_ONCE = 4
FOREIGN = {
    "text": "# notes of mine\n",
    "other.json": '{"mine": [1, 2]}',
    "list.json": '[{"name": "mine"}]',
    "run": '{"scene": "toy", "status": "done"}',
}
COMMANDS = {
    "study": ["study", "scene.toml"],
    "stability": ["stability", "scene.toml"],
    "scan": ["scan", "scene.toml"],
    "bench": ["bench", "toys:COUNTED"],
    "bench exchange": ["bench", "exchange"],
    "conform": ["conform", "--scene", "scene.toml", "--component", "ping"],
}


@pytest.fixture
def user_folder(tmp_path, monkeypatch):
    """The current folder, with a scene and other files of a user."""
    monkeypatch.chdir(tmp_path)
    write_scene(tmp_path, end=0.005)
    (tmp_path / "log").mkdir()
    (tmp_path / "log" / "ping.log").write_text("mine")
    for name in ("results.json", "recording.h5", "ping.vtkhdf", "scene.png", "study.json"):
        (tmp_path / name).write_text("mine")
    return tmp_path


def only_sentence(capsys, sentence):
    lines = [line for line in capsys.readouterr().err.splitlines() if line]
    assert len(lines) == 1 and lines[0].startswith("quintet: ") and sentence in lines[0], lines


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("kind", FOREIGN)
def test_json_goes_to_no_foreign_file(user_folder, capsys, command, kind):
    (user_folder / kind).write_text(FOREIGN[kind])
    old_content = content(user_folder)
    assert status(*COMMANDS[command], "--json", kind) == 2
    only_sentence(capsys, f"--json {kind}: it must be new, or what this command left there before")
    assert content(user_folder) == old_content


@pytest.mark.parametrize("kind", ["pipe", "folder"])
def test_json_goes_to_plain_files_only(user_folder, capsys, kind):
    os.mkfifo("pipe")
    os.mkdir("folder")
    assert status(*COMMANDS["conform"], "--json", kind) == 2
    only_sentence(capsys, f"--json {kind}: it must be a plain file; it is none. Name another.")


def test_json_needs_a_folder_that_can_be_written(user_folder, capsys, monkeypatch):
    """A file in a folder that is read-only cannot be replaced."""
    (user_folder / "found.json").write_text("")
    monkeypatch.setattr(os, "access", lambda place, _: Path(place) != user_folder)
    assert status(*COMMANDS["conform"], "--json", "found.json") == 2
    only_sentence(capsys, "--json found.json: it must be a file that can be written")


def test_a_link_to_a_json_file_stays(user_folder):
    (user_folder / "link.json").symlink_to("found.json")
    JsonFile(user_folder / "link.json", ("kind",)).write({"kind": "toys:Toy"})
    assert (user_folder / "link.json").is_symlink()
    assert json.loads((user_folder / "found.json").read_text()) == {"kind": "toys:Toy"}


def test_json_that_the_same_command_left_is_replaced(user_folder):
    for _ in range(2):
        assert status(*COMMANDS["conform"], "--json", "found.json") in (0, 1)
        assert json.loads((user_folder / "found.json").read_text())["kind"] == "toys:Toy"


@pytest.mark.parametrize("command", ["run", "study", "stability"])
@pytest.mark.parametrize("out", [".", "log", "link"])
def test_a_folder_of_the_user_stays_as_it_is(user_folder, capsys, command, out):
    (user_folder / "link").symlink_to(user_folder)
    old_content = content(user_folder)
    stability = (
        '[[stability]]\nparameter = "components.ping.pause"\nfrom = 0.0\nto = 1.0\n'
        if command == "stability"
        else ""
    )
    (user_folder / "scene.toml").write_text((user_folder / "scene.toml").read_text() + stability)
    if command == "study":
        (user_folder / "scene.toml").write_text(
            (user_folder / "scene.toml").read_text() + '[[study]]\nlabel = "a"\nsettings = {}\n'
        )
    old_content = content(user_folder)
    for force in ([], ["--force"]):
        assert status(command, "scene.toml", "--out", out, *force) == 2
        only_sentence(capsys, "it holds files that no run left")
        assert content(user_folder) == old_content


def started(*arguments):
    command = [sys.executable, "-m", "quintet.coupler.cli", "run", "scene.toml", *arguments]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def test_of_runs_at_once_in_one_folder_one_runs_and_the_others_say_so(user_folder):
    runs = [started("--out", "out") for _ in range(AT_ONCE)]
    errors = [run.communicate(timeout=120)[1] for run in runs]
    assert sorted(run.returncode for run in runs) == [0] + [2] * (AT_ONCE - 1)
    for run, text in zip(runs, errors, strict=True):
        if run.returncode:
            assert len(text.splitlines()) == 1
            assert "another run is using it." in text or "it holds a run of toy." in text
    assert status("run", "scene.toml", "--out", "alone") == 0
    assert same(user_folder / "alone", user_folder / "out")
    assert content(user_folder / "out").keys() == content(user_folder / "alone").keys()


def test_runs_at_once_without_a_folder_have_one_each(user_folder):
    runs = [started() for _ in range(AT_ONCE)]
    for run in runs:
        assert run.communicate(timeout=120) and run.returncode == 0
    assert status("run", "scene.toml", "--out", "alone") == 0
    folders = sorted((user_folder / "runs").iterdir())
    assert [path.name for path in folders] == ["toy", *(f"toy-{n + 2}" for n in range(AT_ONCE - 1))]
    for folder in folders:
        assert (folder / MARKER).is_file() and same(user_folder / "alone", folder)
