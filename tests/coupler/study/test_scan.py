"""A scan finds wrong results without a warning, refusal or failure, and false alarms."""

import json
import shutil
from pathlib import Path

import pytest
from spring_scene import command, command_json, write

from quintet.coupler.scene.scan_table import Scan, ScanTable
from quintet.coupler.study.scan import row_of, status_of, verdict

STEP = 'parameter = "components.spring.step"\n'
COS = 'source = "cos(10)"\n'
TOYS = Path(__file__).parents[1] / "toy_scenes"


def scans(*tables):
    return "".join(f"[[scan]]\n{table}\n" for table in tables)


def rows(report, number=0):
    return report["scans"][number]["rows"]


def test_each_run_is_right_told_or_silent(tmp_path, capsys):
    path = write(tmp_path, scans(STEP + "values = [0.01, 0.1, -1.0]\n" + COS), within=1e-9)
    status, report = command_json("scan", path)
    assert status == 1, "a run is silently wrong"
    assert [row["status"] for row in rows(report)] == [0, 0, 2]
    assert [row["verdict"] for row in rows(report)] == ["right", "SILENT", "told"]
    # Leap-frog is wrong by 0.544 · 1000 dt² / 24; the error is relative to cos(10).
    assert rows(report)[0]["errors"]["end"] == pytest.approx(0.544 * 0.1 / 24 / 0.839, rel=0.2)
    assert "step should be greater than 0; found -1.0" in rows(report)[2]["why"]
    (scan,) = report["scans"]
    assert (scan["name"], scan["judged"]) == ("components.spring.step", ["end"])
    assert report["scene"] == "spring" and report["machine"]["cores"]
    assert json.loads((tmp_path / "all" / "scan.json").read_text()) == report
    output = capsys.readouterr().out
    assert "components.spring.step = 0.1: SILENT (sound, error 34.8 %)" in output


def test_a_scan_without_silent_rows_ends_with_status_0(tmp_path):
    path = write(tmp_path, scans(STEP + "values = [0.01, 0.02]\n" + COS), within=1e-9)
    status, report = command_json("scan", path)
    assert status == 0 and [row["verdict"] for row in rows(report)] == ["right", "right"]


def test_a_warning_of_a_right_result_is_a_false_alarm_and_of_a_wrong_one_told(tmp_path):
    scene_text = SCENE_WITH_WARNING
    shutil.copy(TOYS / "toy_spring.py", tmp_path)
    (tmp_path / "toy_warning.py").write_text(WARNING)
    (tmp_path / "scene.toml").write_text(scene_text)
    status, report = command_json("scan", tmp_path / "scene.toml")
    assert status == 0
    assert [row["status"] for row in rows(report)] == [0, 1, 1]
    assert [row["verdict"] for row in rows(report)] == ["right", "false alarm", "told"]
    assert rows(report)[1]["why"] == "the step is too long"


def test_exact_answers_may_depend_on_the_value(tmp_path):
    time_scan = 'parameter = "end"\nvalues = [1.0, 1.5, 2.0]\nname = "time"\n' + COS
    mass_scan = 'parameter = "components.spring.mass"\nvalues = [1.0, 4.0]\n' + COS
    mass_scan += "exact = { end = [-0.8390715, 0.2836622] }\n"
    path = write(tmp_path, scans(time_scan, mass_scan))
    status, report = command_json("scan", path)
    assert status == 0
    assert [row["verdict"] for row in rows(report, 1)] == ["right", "right"]
    assert rows(report, 1)[1]["values"]["end"] == pytest.approx(0.2836622, abs=1e-2)


def test_what_could_not_be_measured_is_silent(tmp_path):
    path = write(tmp_path, scans('parameter = "end"\nvalues = [1.0, 0.5]\n'))
    status, report = command_json("scan", path)
    assert status == 1 and rows(report)[1]["error"] is None
    assert rows(report)[1]["values"] == {"end": None}
    assert [row["verdict"] for row in rows(report)] == ["right", "SILENT"]


def test_errors_are_relative_to_the_scale_that_is_given(tmp_path):
    table = STEP + "values = [0.01, 0.1]\nscale = { end = 100.0 }\n" + COS
    status, report = command_json("scan", write(tmp_path, scans(table)))
    assert status == 0 and rows(report)[1]["error"] == pytest.approx(0.348 * 0.839 / 100, rel=0.01)


def test_a_reference_curve_whose_measure_is_zero_gives_no_relative_error():
    outcome = {"name": "end", "value": 0.1, "reference": 0.0}
    scan = Scan(ScanTable(parameter="step", values=(0.1, 1.0)), "step", ("end",), {})
    row = row_of(scan, 0, {"status": "done", "expect": [outcome]})
    assert row["error"] is None and row["verdict"] == "SILENT"


def test_energy_that_a_run_gains_is_an_error_where_a_scan_judges_it():
    balance = {"scale": 100.0, "run": {"gained": 12.0}}
    result = {"status": "done", "expect": [], "ledger": {"energy_balance": balance}}
    scan = Scan(ScanTable(parameter="step", values=(0.1, 1.0), energy=True), "step", (), {})
    row = row_of(scan, 1, result)
    assert row["errors"] == {"energy gained": 0.12} and row["verdict"] == "SILENT"
    assert row_of(scan, 1, {**result, "warnings": [{"text": "it rose"}]})["verdict"] == "told"
    assert row_of(scan, 1, {**result, "ledger": {}})["error"] is None


def test_settings_of_a_scan_and_one_of_its_name(tmp_path):
    first = STEP + 'name = "a"\nvalues = [0.01, 0.1]\n'
    second = STEP + 'name = "b"\nvalues = [0.01, 0.02]\n'
    second += 'settings = { "components.spring.mass" = 4.0 }\nscale = { end = 0.1 }\n'
    path = write(tmp_path, scans(first, second))
    status, report = command_json("scan", path, "--name", "b")
    assert [scan["name"] for scan in report["scans"]] == ["b"]
    assert status == 1 and rows(report)[0]["values"]["end"] == pytest.approx(0.2836622, abs=1e-2)
    assert command("scan", path, "--name", "c", "--out", tmp_path / "other") == 2


def test_runs_that_are_done_are_kept(tmp_path, capsys):
    path = write(tmp_path, scans(STEP + "values = [0.01, 0.02]\n"))
    command_json("scan", path)
    result = tmp_path / "all" / "components.spring.step" / "1-0.01" / "results.json"
    saved_time = result.stat().st_mtime_ns
    status, _ = command_json("scan", path, "--keep")
    assert status == 0 and result.stat().st_mtime_ns == saved_time
    assert command("scan", path, "--out", tmp_path / "all") == 2
    assert "replace it with --force" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("result", "status", "why"),
    [
        ({"status": "done"}, 0, ""),
        ({"status": "done", "warnings": [{"text": "a"}, {"text": "b"}]}, 1, "a; b"),
        ({"status": "refused", "cause": "c"}, 2, "c"),
        ({"status": "failed", "fault": {"cause": "d"}}, 3, "d"),
        ({"status": "stalled"}, 3, "it takes too long: its steps became too small"),
    ],
)
def test_runs_are_judged_without_expectations(result, status, why):
    assert status_of({**result, "expect": [{"met": False}]}) == (status, why)


@pytest.mark.parametrize(
    ("status", "error", "result"),
    [
        (0, 0.1, "right"),
        (0, 0.11, "SILENT"),
        (0, None, "SILENT"),
        (1, 0.02, "false alarm"),
        (1, 0.05, "told"),
        (3, None, "told"),
    ],
)
def test_verdicts(status, error, result):
    assert verdict(status, error) == result


VALUES = "values = [0.01, 0.02]\n"
WRONG = {
    "unknown key": (STEP + VALUES + "valus = 1.0", "0.valus is not known. Did you mean values?"),
    "unknown path": (
        'parameter = "components.spring.stp"\n' + VALUES,
        "0: components.spring.stp is not known. Did you mean step?",
    ),
    "one value": (STEP + "values = [0.01]", "0: values must be two or more; found 1. Add some."),
    "values of two types": (
        STEP + 'values = [0.01, "0.02"]',
        "0: values must be of one type; found [0.01, '0.02']. Correct them.",
    ),
    "first value": (
        STEP + "values = [-0.01, 0.01]",
        "0: components.spring.step should be greater than 0; found -0.01. Correct it.",
    ),
    "setting": (
        STEP + VALUES + 'settings = { "components.sprin.mass" = 1.0 }',
        "0: components.sprin is not known. Did you mean spring?",
    ),
    "parameter in settings": (
        STEP + VALUES + 'settings = { "components.spring.step" = 1.0 }',
        "0: settings must not have the parameter components.spring.step. Remove it from them.",
    ),
    "expectation": (
        STEP + VALUES + 'expectation = ["ende"]',
        "0: expectation ende is not known. Did you mean end?",
    ),
    "exact and scale": (
        STEP + VALUES + COS + "exact = { ende = [1.0, 1.0] }\nscale = { und = 1.0 }",
        "0: exact.ende is not known. Did you mean end?",
        "0: scale.und is not known. Did you mean end?",
    ),
    "number of exact answers": (
        STEP + VALUES + "exact = { end = [1.0] }",
        "0: exact needs a source. Add source to it. exact.end must have one number for each of "
        "values; found 1 for 2. Correct it.",
    ),
    "exact answer of 0": (
        STEP + VALUES + COS + "exact = { end = [1.0, 0.0] }\n" + 'expectation = ["end"]',
        "0: scale.end is needed, as an exact answer is 0. Give the size that the error is relative "
        "to.",
    ),
    "two of one name": (
        STEP + VALUES + "[[scan]]\n" + STEP + VALUES,
        "1: two scans have the name components.spring.step. Give each its own.",
    ),
}


@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_scan_is_refused_with_the_scene(tmp_path, capsys, case):
    text, *sentences = WRONG[case]
    assert command("check", "--import", write(tmp_path, scans(text))) == 2
    message = capsys.readouterr().err
    for sentence in sentences:
        assert f"quintet: scene.toml: scan.{sentence}\n" in message


def test_a_scene_without_scans_says_so(tmp_path, capsys):
    assert command("scan", write(tmp_path)) == 2
    assert "Add a [[scan]] for each setting." in capsys.readouterr().err


@pytest.mark.parametrize(
    "words", [[], ["two_springs", "--all"], ["two_springs", "--quick"], ["--all", "--set", "end=1"]]
)
def test_one_scene_or_all_of_them_are_scanned(words, capsys):
    assert command("scan", *words) == 2
    assert capsys.readouterr().err.startswith("quintet: ")


WARNING = """
from toy_spring import Spring


class Warning(Spring):
    def warnings(self):
        return {"step": "the step is too long"} if self.params.step > 0.015 else {}
"""
SCENE_WITH_WARNING = """
name = "spring"
end = 1.0
transport = "memory"
[components.spring]
kind = "toy_warning:Warning"
step = 0.01
[[expect]]
name = "end"
component = "spring"
field = "motion.position"
axis = 0
measure = "at"
begin = 1.0
value = -0.8390715290764524
within = 0.005
unit = "m"
source = "cos(10)"
[[scan]]
parameter = "components.spring.step"
values = [0.01, 0.02, 0.1]
"""
