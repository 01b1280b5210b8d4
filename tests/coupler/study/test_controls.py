"""A tolerance must reject a wrong result; status 1 reports a tolerance that does not."""

import json
import os
import signal
import subprocess
import sys
import time
from collections import Counter

import pytest
from spring_scene import command, command_json, write

from quintet.coupler.scene.read import load, load_variants
from quintet.coupler.study.control_judgement import judge, margin, without_control

SOFT = """
[[control]]
name = "softer"
settings = { "components.spring.stiffness" = 90.0 }
rejects = ["end"]
reason = "the spring swings more slowly"
"""
FINER = """
[[control]]
name = "finer"
settings = { "components.spring.step" = 0.01 }
rejects = ["end"]
reason = "nothing is wrong with it"
"""
COARSE = """
[presets.coarse]
"components.spring.step" = 0.1
[presets.fine]
"components.spring.step" = 0.01
[presets.other]
"expect.0.within" = 0.1
[presets.without]
expect = []
[[control]]
name = "softer"
preset = "{preset}"
settings = {{ "components.spring.stiffness" = 90.0 }}
rejects = ["end"]
reason = "the spring swings more slowly"
"""
ZERO = """
[[expect]]
name = "still"
component = "spring"
field = "motion.position"
axis = 1
measure = "max"
value = 0.0
within = 0.0
unit = "m"
source = "it swings along x"
"""


def scene(folder, tables):
    """The scene of a spring with a tolerance that both steps meet."""
    return write(folder, tables, within=0.02)


def journal(folder):
    """How often each event is noted in the journal."""
    path = folder / "sweep.log"
    lines = path.read_text().splitlines() if path.is_file() else []
    return Counter(line.split()[2] for line in lines)


def rows(content):
    return [row for scene in content for row in scene["rows"]]


@pytest.mark.slow
def test_a_control_that_is_rejected_has_a_margin_above_one(tmp_path, capsys):
    status, report = command_json("controls", scene(tmp_path, SOFT))
    (row,) = rows(report)
    assert status == 0 and row["verdict"] == "rejected" and row["control"] == "softer"
    assert row["margin"] == pytest.approx(abs(row["value"] - row["reference"]) / row["within"])
    assert row["margin"] > 1.0 and report[0]["scene"] == "spring"
    assert "softer" in capsys.readouterr().out

    status, second_report = command_json("controls", tmp_path / "scene.toml")
    assert status == 0 and second_report == report and journal(tmp_path / "all")["started"] == 1
    assert "found complete" in capsys.readouterr().out


@pytest.mark.slow
def test_a_tolerance_that_its_control_passes_is_too_wide(tmp_path, capsys):
    status, report = command_json("controls", scene(tmp_path, SOFT + FINER))
    output = capsys.readouterr().out
    assert status == 1 and [row["verdict"] for row in rows(report)] == ["rejected", "PASSES"]
    assert (
        "spring: expectation end, control finer: a tolerance that its control passes is" in output
    )
    assert rows(report)[1]["margin"] < 1.0


@pytest.mark.slow
def test_an_expectation_without_a_control_is_told(tmp_path, capsys):
    status, report = command_json("controls", scene(tmp_path, ZERO + SOFT))
    assert status == 1 and rows(report)[1]["verdict"] == "NO CONTROL"
    assert "spring: expectation still: no control names it" in capsys.readouterr().out


@pytest.mark.slow
@pytest.mark.parametrize(("preset", "verdict"), [("fine", "rejected"), ("coarse", "BASE REJECTED")])
def test_what_a_preset_is_rejected_for_without_the_settings_is_no_control(
    tmp_path, preset, verdict
):
    status, report = command_json("controls", scene(tmp_path, COARSE.format(preset=preset)))
    (row,) = rows(report)
    assert row["verdict"] == verdict and status == (verdict != "rejected")
    assert (row["base_margin"] > 1.0) == (preset == "coarse")
    assert journal(tmp_path / "all")["started"] == 2


@pytest.mark.slow
def test_a_tolerance_of_zero_rejects_by_an_infinite_margin(tmp_path, capsys):
    tables = SOFT.replace('stiffness" = 90.0', 'start" = [0.9, 0.5, 0.0]')
    tables = tables.replace('["end"]', '["end", "still"]')
    status, report = command_json("controls", scene(tmp_path, ZERO + tables))
    assert status == 0 and [row["margin"] is None for row in rows(report)] == [False, True]
    assert "Infinity" not in (tmp_path / "found.json").read_text()
    assert command("controls", "--show", tmp_path / "found.json") == 0
    assert "| still | softer | 0.5 m | 0 | 0 | ∞ |" in capsys.readouterr().out


@pytest.mark.slow
def test_a_run_that_fails_rejects_nothing(tmp_path, capsys):
    path = scene(tmp_path, SOFT)
    code = tmp_path / "toy_spring.py"
    failing_code = "def stable_dt(self):\n        if self.params.stiffness < 95.0:\n"
    failing_code += "            raise ValueError('broken on purpose')"
    code.write_text(code.read_text().replace("def stable_dt(self):", failing_code))
    status, report = command_json("controls", path)
    assert status == 3 and rows(report)[0]["verdict"] == "FAILED"
    output = " ".join(capsys.readouterr().out.split())
    assert "its run is not done" in output and "broken on purpose" in output


@pytest.mark.slow
def test_controls_that_were_killed_run_only_what_is_not_done(tmp_path):
    slow_code = "def stable_dt(self):\n        import time\n        time.sleep(0.02)"
    path = scene(tmp_path, SOFT + FINER.replace("0.01", "0.005"))
    code = tmp_path / "toy_spring.py"
    code.write_text(code.read_text().replace("def stable_dt(self):", slow_code))
    out = tmp_path / "all"
    line = [sys.executable, "-m", "quintet.coupler.cli", "controls", str(path), "--out", str(out)]
    process = subprocess.Popen(line, stdout=subprocess.DEVNULL, start_new_session=True)
    limit = time.monotonic() + 60.0
    while not (journal(out)["done"] == 1 and journal(out)["started"] == 2):
        assert time.monotonic() < limit, "it did not come to that"
        time.sleep(0.01)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    status, report = command_json("controls", path)
    assert status == 1 and [row["verdict"] for row in rows(report)] == ["rejected", "PASSES"]
    events = [line.split()[1:] for line in (out / "sweep.log").read_text().splitlines()]
    done_runs = [name for name, event in events if event == "done"]
    starts = Counter(name for name, event in events if event in ("started", "resumed"))
    assert len(set(done_runs)) == len(done_runs) == 2 and starts[done_runs[0]] == 1


@pytest.mark.slow
def test_the_file_keeps_the_rows_of_other_scenes(tmp_path):
    path = tmp_path / "found.json"
    path.write_text(json.dumps([{"scene": "another", "rows": []}]))
    _, report = command_json("controls", scene(tmp_path, SOFT))
    assert [entry["scene"] for entry in report] == ["another", "spring"]


WRONG = {
    "unknown expectation": (
        SOFT.replace('"end"', '"ends"'),
        "control.softer: rejects ends is not known. Did you mean end?",
    ),
    "unknown path": (
        SOFT.replace("stiffness", "stifness"),
        "control.softer: components.spring.stifness is not known. Did you mean stiffness?",
    ),
    "unknown key": (SOFT + 'because = "1"\n', "control.softer.because is not known"),
    "no reason": (SOFT.replace("reason", "#"), "control.softer.reason"),
    "empty reason": (SOFT.replace("the spring swings more slowly", ""), "reason must not be empty"),
    "rejects nothing": (SOFT.replace('["end"]', "[]"), "rejects must name an expectation"),
    "changes nothing": (
        SOFT.replace('"components.spring.stiffness" = 90.0', ""),
        "settings must change the scene; found none. Set what is wrong.",
    ),
    "changes the tolerance": (
        SOFT.replace("components.spring.stiffness", "expect.0.within"),
        "control.softer: rejects end: a control must be judged by the expectation of the scene; "
        "found another within.",
    ),
    "another tolerance of its preset": (
        COARSE.format(preset="other"),
        "control.softer: rejects end: a control must be judged by the expectation of the scene",
    ),
    "a preset without the expectation": (
        COARSE.format(preset="without"),
        "control.softer: rejects end: preset without must have this expectation; it has not.",
    ),
    "unknown preset": (
        COARSE.format(preset="corse"),
        "control.softer: preset corse is not known. Did you mean coarse?",
    ),
    "a name twice": (SOFT + SOFT, "control: 2 have the name 'softer'. Give each its own."),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
@pytest.mark.parametrize("name", ["check", "controls"])
def test_a_wrong_control_is_refused_before_anything_starts(
    tmp_path, capsys, monkeypatch, name, case
):
    monkeypatch.chdir(tmp_path)
    tables, sentence = WRONG[case]
    assert command(name, scene(tmp_path, tables), *(["--import"] if name == "check" else [])) == 2
    assert sentence in capsys.readouterr().err
    assert not (tmp_path / "runs").exists()


OPTIONS = {
    "nothing": ((), "controls needs one of a scene, --all and --show. Give one of them."),
    "two": (("two_springs", "--all"), "controls needs one of a scene, --all and --show."),
    "no such file": (("--show", "none.json"), "--show none.json: there is no such file."),
    "another file": (("--show", "letter.txt"), "--show letter.txt: it must be new, or what this"),
    "another's file": (("two_springs", "--json", "letter.txt"), "--json letter.txt: it must be"),
    "another's folder": (("two_springs", "--out", "."), "it holds files that no run left"),
}  # fmt: skip


@pytest.mark.parametrize("case", OPTIONS)
def test_wrong_options_are_refused(tmp_path, capsys, monkeypatch, case):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "letter.txt").write_text("mine")
    words, sentence = OPTIONS[case]
    assert command("controls", *words) == 2
    assert sentence in capsys.readouterr().err
    assert (tmp_path / "letter.txt").read_text() == "mine"


def test_the_margin_is_the_distance_over_the_tolerance():
    outcome = {"value": 3.0, "reference": 1.0, "within": 0.5}
    assert margin(outcome) == 4.0
    assert margin({**outcome, "value": None}) is None
    assert margin({**outcome, "within": 0.0}) == float("inf")
    assert margin({**outcome, "within": 0.0, "value": 1.0}) == 0.0


def test_what_has_no_value_rejects_nothing():
    outcome = {"name": "x", "value": None, "reference": 1.0, "within": 0.5, "unit": "m"}
    run = {"status": "done", "expect": [outcome]}
    assert judge("c", "x", run, None)["verdict"] == "PASSES"
    run["expect"] = [{**outcome, "value": 2.0}]
    assert judge("c", "x", run, None)["verdict"] == "rejected"
    assert judge("c", "x", run, run)["verdict"] == "BASE REJECTED"
    assert judge("c", "x", run, {"status": "failed"})["verdict"] == "FAILED"
    assert judge("c", "x", {"status": "interrupted"}, None)["verdict"] == "interrupted"
    assert without_control("x")["verdict"] == "NO CONTROL"


def test_margins_of_a_tolerance_of_zero_are_numbers_of_json():
    outcome = {"name": "x", "value": 2.0, "reference": 1.0, "within": 0.0, "unit": "m"}
    run = {"status": "done", "expect": [outcome]}
    row = judge("c", "x", run, run)
    assert row["verdict"] == "BASE REJECTED"
    json.dumps(row, allow_nan=False)


def test_controls_are_no_part_of_what_runs(tmp_path):
    path = scene(tmp_path, SOFT)
    assert "control" not in load(str(path)).resolved
    _, variants = load_variants(str(path))
    assert [control.table.name for control in variants.control] == ["softer"]
