"""No command changes a byte of a file that is not its own, and each says so in one sentence."""

import json
import subprocess
import sys

import pytest
from started import same, write_scene
from test_folder import content, status

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
def here(tmp_path, monkeypatch):
    """A folder with a scene and other files of a user, which is the current one."""
    monkeypatch.chdir(tmp_path)
    write_scene(tmp_path, end=0.005)
    (tmp_path / "log").mkdir()
    (tmp_path / "log" / "ping.log").write_text("mine")
    for name in ("results.json", "recording.h5", "ping.vtkhdf", "scene.png", "study.json"):
        (tmp_path / name).write_text("mine")
    return tmp_path


def only_sentence(capsys, words):
    said = [one for one in capsys.readouterr().err.splitlines() if one]
    assert len(said) == 1 and said[0].startswith("quintet: ") and words in said[0], said


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("kind", FOREIGN)
def test_json_goes_to_no_foreign_file(here, capsys, command, kind):
    (here / kind).write_text(FOREIGN[kind])
    before = content(here)
    assert status(*COMMANDS[command], "--json", kind) == 2
    only_sentence(capsys, f"--json {kind}: it must be new, or what this command left there before")
    assert content(here) == before


def test_json_that_the_same_command_left_is_replaced(here):
    for _ in range(2):
        assert status(*COMMANDS["conform"], "--json", "found.json") in (0, 1)
        assert json.loads((here / "found.json").read_text())["kind"] == "toys:Toy"


@pytest.mark.parametrize("command", ["run", "study", "stability"])
@pytest.mark.parametrize("where", [".", "log", "link"])
def test_a_folder_of_the_user_stays_as_it_is(here, capsys, command, where):
    (here / "link").symlink_to(here)
    before = content(here)
    extra = (
        '[[stability]]\nparameter = "components.ping.pause"\nfrom = 0.0\nto = 1.0\n'
        if command == "stability"
        else ""
    )
    (here / "scene.toml").write_text((here / "scene.toml").read_text() + extra)
    if command == "study":
        (here / "scene.toml").write_text(
            (here / "scene.toml").read_text() + '[[study]]\nlabel = "a"\nsettings = {}\n'
        )
    before = content(here)
    for force in ([], ["--force"]):
        assert status(command, "scene.toml", "--out", where, *force) == 2
        only_sentence(capsys, "it holds files that no run left")
        assert content(here) == before


def started(*arguments):
    command = [sys.executable, "-m", "quintet.coupler.cli", "run", "scene.toml", *arguments]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def test_of_runs_at_once_in_one_folder_one_runs_and_the_others_say_so(here):
    runs = [started("--out", "out") for _ in range(AT_ONCE)]
    said = [run.communicate(timeout=120)[1] for run in runs]
    assert sorted(run.returncode for run in runs) == [0] + [2] * (AT_ONCE - 1)
    for run, text in zip(runs, said, strict=True):
        if run.returncode:
            assert len(text.splitlines()) == 1
            assert "another run is using it." in text or "it holds a run of toy." in text
    assert status("run", "scene.toml", "--out", "alone") == 0
    assert same(here / "alone", here / "out")
    assert content(here / "out").keys() == content(here / "alone").keys()


def test_runs_at_once_without_a_folder_have_one_each(here):
    runs = [started() for _ in range(AT_ONCE)]
    for run in runs:
        assert run.communicate(timeout=120) and run.returncode == 0
    assert status("run", "scene.toml", "--out", "alone") == 0
    folders = sorted((here / "runs").iterdir())
    assert [one.name for one in folders] == ["toy", *(f"toy-{n + 2}" for n in range(AT_ONCE - 1))]
    for folder in folders:
        assert (folder / MARKER).is_file() and same(here / "alone", folder)
