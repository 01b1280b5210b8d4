"""``quintet conform``: the laws it tries, one line for each, and the exit status."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from quintet.coupler.cli import main
from quintet.coupler.conform.laws import LAWS, name_of
from quintet.scenarios.two_springs import springs

KEEPS = """
from quintet.scenarios.two_springs.springs import Mass
class Keeps(Mass):
    '''It keeps what it takes.'''
    def take(self, fields):
        self.push = fields.get("load.force", self.push)
"""
PARAMS = """
mass = 1.0
stiffness = 100.0
arm = [0.0, 0.0, 0.5]
start = [0.0, 0.0, 0.5]
"""
INPUTS = """
[conform]
dt = 0.002
rest."load.force" = [[0.0, 0.0, 0.0]]
rest."foot.position" = [[0.0, 0.0, 0.0]]
rest."foot.velocity" = [[0.0, 0.0, 0.0]]
scale."load.force" = 5.0
scale."foot.position" = 0.1
"""


@pytest.fixture
def conform(capsys):
    """Run the command; return its status, its output and its errors."""

    def run(*arguments):
        with pytest.raises(SystemExit) as exit_info:
            main(["conform", *map(str, arguments)])
        screen = capsys.readouterr()
        return exit_info.value.code, screen.out, screen.err

    return run


def _file(folder, text):
    path = folder / "mass.toml"
    path.write_text(text)
    return path


def test_a_kind_that_keeps_all_laws_ends_with_0(conform):
    status, output, _ = conform("echo")
    assert status == 0
    lines = output.splitlines()
    assert lines[0] == "echo, four items"
    assert "  passed          outputs are copies" in lines
    assert "  does not apply  rotations are unit quaternions: it gives no rotation" in lines
    assert re.fullmatch(r"echo conforms; \d+ passed, 0 failed, \d+ do not apply", lines[-1])
    assert len(lines) == len(LAWS) + 2


def test_a_broken_law_ends_with_1_and_is_told_in_a_sentence(conform, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "kept.py").write_text(KEEPS)
    json_path = tmp_path / "found.json"
    path = _file(tmp_path, PARAMS + INPUTS)
    status, output, _ = conform("kept:Keeps", "--params", path, "--json", json_path)
    assert status == 1
    assert (
        "  failed          received arrays are neither written to nor kept: take, bind: " in output
    )
    assert "Keep copies: np.array(fields[key])." in output
    table = json.loads(json_path.read_text())
    assert (table["kind"], table["conforms"]) == ("kept:Keeps", False)
    (case,) = table["cases"]
    assert case["case"] == "mass.toml"
    assert [entry["law"] for entry in case["laws"]] == [name_of(law) for law in LAWS]
    failed = [entry["law"] for entry in case["laws"] if entry["status"] == "failed"]
    assert failed == ["received arrays are neither written to nor kept"]


def test_parameters_of_a_file_with_what_it_takes(conform, tmp_path):
    kind = "quintet.scenarios.two_springs.springs:Mass"
    status, output, _ = conform(kind, "--params", _file(tmp_path, PARAMS + INPUTS))
    assert status == 0 and "  passed          two half steps come to one" in output
    status, output, _ = conform(kind, "--params", _file(tmp_path, PARAMS))
    assert status == 0  # no port is joined then


@pytest.mark.parametrize("name", ["lower", "upper"])
def test_the_tutorial_conforms_as_its_scene_joins_it(conform, name):
    status, output, _ = conform("--scene", "two_springs", "--component", name)
    assert status == 0
    assert output.startswith(f"springs:Mass, {name} of two_springs\n")


def test_a_scene_gives_what_partners_tell_and_where_data_lies(conform):
    settings = ["--preset", "quick"]
    status, output, _ = conform("--scene", "floating_cube", "--component", "water", *settings)
    assert status == 0
    assert "  passed          two half steps come to one" in output


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["ecko"], "conform ecko is not known. Did you mean echo?"),
        (["nowhere:Mass"], "conform nowhere:Mass: it cannot be imported"),
        (["json:loads"], "is not a Component"),
        (["json:nothing"], "has no attribute 'nothing'"),
        (
            ["echo", "--case", "five items"],
            "case five items is not known. Did you mean four items?",
        ),
        ([f"{springs.__name__}:Mass"], "it publishes no case. Give its parameters with --params"),
        (["echo", "--params", "{mass}"], "mass.toml.mass is not known"),
        (["{kind}", "--params", "{wrong}"], "conform.tired is not known"),
        (["{kind}", "--params", "{rest}"], "found load.colour. Correct the case."),
        (["{kind}", "--params", "{shape}"], "load.force must have shape (n, 3); found (1, 2)"),
        (["{kind}", "--params", "{scale}"], "found load.force moved, but not at rest"),
        (["{kind}", "--params", "{type}"], "conform.dt must be a number; found 'long'"),
        (["{kind}", "--params", "nowhere.toml"], "parameters must be valid TOML"),
        (["echo", "--scene", "two_springs"], "needs --scene with --component"),
        (["echo", "--preset", "quick"], "--preset and --set belong to --scene"),
        (["--scene", "two_springs", "--component", "uper"], "Did you mean upper?"),
        (["echo", "--scene", "two_springs", "--component", "upper"], "Leave the kind out."),
        ([], "conform needs a KIND"),
    ],
)
def test_bad_input_ends_with_2_before_any_law_is_tried(conform, tmp_path, arguments, words):
    texts = {
        "mass": PARAMS,
        "wrong": PARAMS + "[conform]\ntired = true\n",
        "rest": PARAMS + '[conform]\nrest."load.colour" = [[1.0]]\n',
        "shape": PARAMS + '[conform]\nrest."load.force" = [[1.0, 0.0]]\n',
        "scale": PARAMS + '[conform]\nscale."load.force" = 1.0\n',
        "type": PARAMS + '[conform]\ndt = "long"\n',
    }
    places = {"kind": f"{springs.__name__}:Mass"}
    for name, text in texts.items():
        folder = tmp_path / name
        folder.mkdir()
        places[name] = str(_file(folder, text))
    status, output, mistake = conform(*[argument.format(**places) for argument in arguments])
    assert status == 2 and not output
    assert words in mistake


def test_a_third_party_runs_the_laws_from_the_installed_package(tmp_path):
    """In a folder of its own, without the files of the repository."""
    (tmp_path / "own.py").write_text(Path(springs.__file__).read_text())
    _file(tmp_path, PARAMS + INPUTS)
    line = [sys.executable, "-m", "quintet.coupler.cli", "conform", "own:Mass"]
    result = subprocess.run(
        [*line, "--params", "mass.toml"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONSAFEPATH": "1"},
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert result.returncode == 0, result.stdout + result.stderr
    assert "own:Mass conforms" in result.stdout
