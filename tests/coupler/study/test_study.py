"""A study observes the order of an integrator, and recommends the cheapest refinement."""

import json
import signal
import subprocess
import sys
import time

import pytest
import tomli_w
from spring_scene import CURVE, command, command_json, write
from started import write_scene

from quintet.coupler.run.results import machine
from quintet.coupler.scene.read import load
from quintet.coupler.scene.study_table import Refinement
from quintet.coupler.study.child_run import HASH, ChildRun
from quintet.coupler.study.conclusion import conclude, shares_at
from quintet.coupler.study.row import row_of
from quintet.coupler.study.run_hash import run_hash
from quintet.coupler.study.study import recommendation

REFINEMENT = """
[[study]]
label = "{0}"
settings = {{ "components.spring.step" = {0} }}
size = "components.spring.step"
"""
PLAIN = """
[[study]]
label = "as it is"
settings = {}
"""
STEPS = (1 / 64, 1 / 128, 1 / 256)  # lengths that windows which follow the state can have


def refinements(*steps):
    return "".join(REFINEMENT.format(step) for step in steps)


def test_a_study_observes_the_order_of_an_integrator(tmp_path, capsys):
    status, report = command_json("study", write(tmp_path, refinements(*STEPS), within=1e-3))
    assert status == 0
    # Leap-frog turns by 2 asin(ω dt / 2) a step: its phase is wrong by ω³ dt² / 24 per second.
    for row, step in zip(report["rows"], STEPS, strict=True):
        assert row["status"] == "done" and row["size"] == step
        assert row["errors"]["end"] == pytest.approx(0.544 * 1000 * step**2 / 24, rel=0.1)
        assert row["settings"] == {"components.spring.step": step}
        spring = row["components"]["spring"]
        assert spring["steps"] == round(1.0 / step) and row["items"] == 1
        assert 0.0 < spring["cpu"] == row["cpu"] < row["wall"]
        assert row["memory"] > 1e7 and 0.0 < row["overhead"] < 1.0
    steps = report["kinds"]["time step"]
    order, limit = steps["orders"]["end"], steps["limits"]["end"]
    assert order["low"] < order["order"] == pytest.approx(2.0, abs=0.05) and order["high"] < 2.2
    assert limit["order"] == pytest.approx(2.0, abs=0.05)
    assert limit["value"] == pytest.approx(-0.8390715, abs=limit["uncertainty"])
    split = report["shares"]["of"]["end"]
    assert report["shares"]["label"] == "0.00390625" and split["time step"] > 0.97
    assert [row["met"] for row in report["rows"]] == [False, False, True]
    assert report["recommended"]["label"] == "0.00390625"
    output = capsys.readouterr().out
    assert "recommended: 0.00390625, the cheapest that meets all required expectations" in output
    assert "not met" in output and "spring: CPU [s]" in output and "energy" not in output


def test_a_study_leaves_its_runs_a_table_and_a_picture(tmp_path):
    assert command_json("study", write(tmp_path, refinements(0.02, 0.01)))[0] == 1
    out = tmp_path / "all"
    assert (out / "study.png").read_bytes().startswith(b"\x89PNG")
    assert (out / "study.json").read_text() == (tmp_path / "found.json").read_text()
    for name in ("0.02", "0.01"):
        results = json.loads((out / name / "results.json").read_text())
        assert results["status"] == "done"
        assert f"step = {name}" in (out / name / "scene.toml").read_text()
        assert "study" not in (out / name / "scene.toml").read_text()


def test_the_cheapest_of_several_good_refinements_is_recommended(tmp_path):
    tables = refinements(1e-3, 0.005) + PLAIN
    status, report = command_json("study", write(tmp_path, tables, within=0.1), "--set", "end=1.0")
    assert status == 0 and all(row["met"] for row in report["rows"])
    assert report["rows"][0]["cpu"] > report["recommended"]["cpu"]
    assert report["recommended"]["cpu"] == min(row["cpu"] for row in report["rows"])


def test_a_refinement_that_fails_is_told_and_the_others_count(tmp_path, capsys):
    path = write_scene(tmp_path, end=0.01)
    path.write_text(
        path.read_text()
        + '[[study]]\nlabel = "dies"\nsettings = { "components.pong.fails_at" = 3 }\n'
        + '[[study]]\nlabel = "lives"\nsettings = { "components.pong.items" = 5 }\n'
    )
    status, report = command_json("study", path)
    assert status == 3 and report["recommended"] is None
    assert [row["status"] for row in report["rows"]] == ["failed", "done"]
    assert "asked to raise" in (tmp_path / "all" / "dies" / "run.log").read_text()


def row(label, status="done", **outcome):
    """A refinement with one expectation; a run that failed evaluates none."""
    known = {"name": "a", "value": 1.0, "reference": 1.0, "within": 0.1, "unit": "m", "met": True}
    expected = [known | {"required": True} | outcome] if status == "done" else []
    return row_of(Refinement(label, {}), {"status": status, "expect": expected})


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ([row("a")], "a, the cheapest that meets all required expectations"),
        ([row("a", met=False)], "none; no refinement meets all required expectations"),
        ([row("a", required=False, met=False)], "the cheapest of all, as no expectation is req"),
        ([row("a", "failed"), row("b", "failed")], "none, as no refinement is done"),
    ],
)
def test_a_recommendation_says_what_it_is_judged_by(rows, words):
    (sentence,) = recommendation(conclude("scene", rows))
    assert words in sentence


def test_the_finest_of_several_kinds_does_not_depend_on_units():
    sizes = {"coarse": (0.02, 3e-4), "fine": (0.01, 4e-4)}  # m, s
    for unit in (1.0, 1e3, 1e6):
        rows = []
        for label, (spacing, window) in sizes.items():
            ladder = {"spacing": spacing, "coupling": unit * window}
            refinement = Refinement(label, {}, spacing, "spacing", ladder, ("spacing",))
            rows.append(row_of(refinement, {"status": "done"}) | {"errors": {"a": 0.1}})
        assert shares_at(None, rows)["label"] == "fine"


def test_a_wanted_error_is_delivered_by_the_cheapest_or_by_an_extrapolated_setting(
    tmp_path, capsys
):
    path = write(tmp_path, refinements(*STEPS))
    status, report = command_json("study", path, "--error", 0.005)
    rows, best = report["rows"], report["wanted"]["measured"]
    assert status == 0 and best["relative"] <= 0.005
    cheaper = [row for row in rows if row["cpu"] < best["cpu"]]
    assert all(row["relative"]["end"] > 0.005 for row in cheaper)
    assert report["shares"]["label"] == best["label"]
    assert f"recommended for 0.5 %: {best['label']}, the cheapest" in capsys.readouterr().out

    status, report = command_json("study", path, "--error", 1e-5, "--keep")
    assert status == 1 and "ran" not in report["wanted"]
    assert "EXTRAPOLATED from 0.00390625 (time step), not run" in capsys.readouterr().out
    status, report = command_json("study", path, "--error", 1e-5, "--keep", "--run")
    assert status == 0 and report["wanted"]["ran"]["relative"]["end"] <= 1e-5
    step = report["wanted"]["extrapolated"]["settings"]["components.spring.step"]
    assert f"step = {step}" in (tmp_path / "all" / "extrapolated" / "scene.toml").read_text()
    assert "it delivers 0.001 %" in capsys.readouterr().out


def test_without_expectations_refinements_are_compared_with_the_finest(tmp_path, capsys):
    path = write(tmp_path, refinements(*STEPS))
    text = path.read_text()
    begin, end = text.index("[[expect]]"), text.index("[[study]]")
    output = '[output]\nfields = ["spring.motion.position"]\n'
    path.write_text(text[:begin] + output + text[end:])
    status, report = command_json("study", path)
    screen = capsys.readouterr().out
    assert status == 0 and "met" not in screen
    assert [row["met"] for row in report["rows"]] == 3 * [None]
    assert [row["compared_with"] for row in report["rows"]] == 3 * ["0.00390625"]
    coarse, fine, finest = (row["errors"] for row in report["rows"])
    assert finest == {} and coarse.keys() == fine.keys() == {"spring.motion.position"}
    # Second order against the finest of three: (16 - 1) / (4 - 1).
    assert coarse["spring.motion.position"] / fine["spring.motion.position"] == pytest.approx(
        5.0, rel=0.1
    )
    order = report["kinds"]["time step"]["orders"]["spring.motion.position"]
    assert order["order"] == pytest.approx(2.0, abs=0.15)
    status, report = command_json("study", path, "--keep", "--error", 0.05)
    assert status == 0 and report["wanted"]["measured"]["relative"] <= 0.05


OPTIONS = {
    "no error": (("--error", 0.0), "--error must be above 0, as 0.05 for 5 %; found 0. Correct"),
    "run alone": (("--run",), "--run belongs to --error. Give --error 0.05, or remove --run."),
    "minutes": (("--minutes", 3), "--minutes belongs to --all. Remove it, or name no scene."),
    "a file": (("--readme", "x.md"), "--readme belongs to --all. Remove it, or name no scene."),
    "all": (("--all",), "study needs either a scene or --all. Give one of them."),
}


@pytest.mark.parametrize("case", OPTIONS)
def test_options_that_do_not_go_together_are_refused(tmp_path, capsys, case):
    options, sentence = OPTIONS[case]
    path = write(tmp_path, refinements(*STEPS))
    assert command("study", path, *options, "--out", tmp_path / "all") == 2
    assert sentence in capsys.readouterr().err
    assert not (tmp_path / "all").exists()


WRONG = {
    "unknown key": ('labl = "x"', 'study.0.labl is not known. Did you mean label?'),
    "unknown path": (
        'label = "a"\nsettings = { "components.sprig.step" = 1.0 }',
        "study.a: components.sprig is not known. Did you mean spring?",
    ),
    "unknown setting": (
        'label = "a"\nsettings = { "components.spring.stp" = 1.0 }',
        "study.a: components.spring.stp is not known. Did you mean step?",
    ),
    "range": (
        'label = "a"\nsettings = { "components.spring.step" = -1.0 }',
        "study.a: components.spring.step should be greater than 0; found -1.0. Correct it.",
    ),
    "size": (
        'label = "a"\nsettings = {}\nsize = "components.spring.stp"',
        "study.a.size components.spring.stp has no value in the scene. Did you mean step?",
    ),
    "size that is no number": (
        'label = "a"\nsettings = {}\nsize = "name"',
        "study.a.size name must be a positive number; found 'spring'. Name what is "
        "refined.",
    ),
    "two of a label": (
        'label = "a"\nsettings = {}\n[[study]]\nlabel = "a"\nsettings = {}',
        "study: 2 refinements have the label a. Give each its own, in letters and digits.",
    ),
    "two sizes": (
        'label = "a"\nsettings = {}\nsize = "end"\n'
        '[[study]]\nlabel = "b"\nsettings = {}\nsize = "components.spring.mass"',
        "study: one size must serve all refinements of the model; found "
        "components.spring.mass, end. Name the same, or say what each refines with refines.",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_refinement_is_refused_with_the_scene(tmp_path, capsys, case):
    text, sentence = WRONG[case]
    path = write(tmp_path, f"[[study]]\n{text}\n")
    assert command("check", "--import", path) == 2
    assert f"quintet: scene.toml: {sentence}\n" in capsys.readouterr().err


def test_all_mistakes_of_scene_and_refinements_are_told_at_once(tmp_path, capsys):
    path = write(tmp_path, '[[study]]\nlabel = "a"\nsettings = { "wndow" = 1.0 }\nsice = "x"\n')
    path.write_text(path.read_text().replace("end = 1.0", "end = -1.0"))
    assert command("study", path, "--out", tmp_path / "all") == 2
    message = capsys.readouterr().err
    assert "scene.end should be greater than 0" in message
    assert "study.a.sice is not known. Did you mean size?" in message
    assert not (tmp_path / "all").exists()


def test_a_scene_without_refinements_says_so(tmp_path, capsys):
    assert command("study", write(tmp_path)) == 2
    assert "there is no [[study]]. Add one for every refinement." in capsys.readouterr().err


@pytest.mark.parametrize(
    "number", [pytest.param(signal.SIGINT, marks=pytest.mark.full), signal.SIGTERM]
)
def test_an_interrupted_study_keeps_and_tells_the_refinements_that_ran(tmp_path, number):
    path = write(tmp_path, refinements(0.005) + REFINEMENT.format(1e-6) + refinements(0.02))
    line = [sys.executable, "-m", "quintet.coupler.cli", "study", str(path)]
    line += ["--out", str(tmp_path / "all"), "--json", str(tmp_path / "found.json")]
    process = subprocess.Popen(line, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    running = tmp_path / "all" / "1e-06" / "recording.h5"
    limit = time.monotonic() + 30.0
    while not running.is_file() and time.monotonic() < limit:
        time.sleep(0.02)
    process.send_signal(number)
    output, _ = process.communicate(timeout=30.0)
    assert process.returncode == 130
    report = json.loads((tmp_path / "found.json").read_text())
    assert [row["status"] for row in report["rows"]] == ["done", "interrupted"]
    assert report["recommended"]["label"] == "0.005" and "recommended: 0.005" in output
    assert json.loads((running.parent / "results.json").read_text())["status"] == "interrupted"


def test_a_study_keeps_what_was_done_of_the_same_scene_alone(tmp_path, capsys):
    path = write(tmp_path, refinements(*STEPS[:2]))
    _, first_report = command_json("study", path)
    write(tmp_path, refinements(*STEPS))
    capsys.readouterr()
    status, report = command_json("study", path, "--keep")
    output = capsys.readouterr().out
    assert status == 0 and report["rows"][:2] == first_report["rows"]
    assert [f"{step}: kept" in output for step in STEPS] == [True, True, False]
    results_path = tmp_path / "all" / str(STEPS[1]) / "results.json"
    results = json.loads(results_path.read_text()) | {"status": "failed"}
    del results["checksums"]  # as of a run without them: else it would be refused as changed
    results_path.write_text(json.dumps(results))
    command_json("study", path, "--keep")
    output = capsys.readouterr().out
    assert [f"{step}: kept" in output for step in STEPS] == [True, False, True]
    write(tmp_path, refinements(*STEPS), within=1e-3)
    command_json("study", path, "--keep")
    assert "kept" not in capsys.readouterr().out


def test_a_run_is_kept_only_with_the_files_that_its_scene_names(tmp_path):
    path = write(tmp_path, CURVE)
    reference, folder = tmp_path / "cosine.csv", tmp_path / "run"
    reference.write_text("t_s,x_m\n0,1\n1,-0.84\n")
    folder.mkdir()
    child, scene = ChildRun(str(path), "", [], [], "", lambda: False), load(str(path))
    (folder / "scene.toml").write_text(tomli_w.dumps(scene.resolved))
    (folder / "results.json").write_text(json.dumps({"status": "done", "machine": machine()}))
    assert child.earlier({}, folder) is None, "of a run without a hash nothing is known"
    (folder / "run.log").write_text(f"{HASH}{run_hash(scene)}\nwhat it printed\n")
    assert child.earlier({}, folder)["status"] == "done"
    reference.write_text("t_s,x_m\n0,1\n1,-0.83\n")
    assert child.earlier({}, folder) is None


def test_a_window_is_never_longer_than_the_step_it_is_made_from(tmp_path):
    path = write(tmp_path)
    assert command(
        "run", path, "--set", "components.spring.step=0.03", "--out", tmp_path / "o"
    ) in (0, 1)
    results = json.loads((tmp_path / "o" / "results.json").read_text())
    assert results["windows"] == results["timing"]["components"]["spring"]["steps"]
    assert 34 <= results["windows"] <= 34 * 8 / 7  # at most an eighth of the step is lost
