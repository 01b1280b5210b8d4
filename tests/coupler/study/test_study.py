"""A study observes the order of an integrator, and recommends the cheapest refinement."""

import json
import signal
import subprocess
import sys
import time

import pytest
from spring_scene import command, found_by, write
from started import write_scene

from quintet.coupler.measures.convergence import least_squares, richardson

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
    status, found = found_by("study", write(tmp_path, refinements(*STEPS), within=1e-3))
    assert status == 0
    # Leap-frog turns by 2 asin(ω dt / 2) a step: its phase is wrong by ω³ dt² / 24 per second.
    for row, step in zip(found["rows"], STEPS, strict=True):
        assert row["status"] == "done" and row["size"] == step
        assert row["errors"]["end"] == pytest.approx(0.544 * 1000 * step**2 / 24, rel=0.1)
        assert row["settings"] == {"components.spring.step": step}
        spring = row["components"]["spring"]
        assert spring["steps"] == round(1.0 / step) and row["items"] == 1
        assert 0.0 < spring["cpu"] == row["cpu"] < row["wall"]
        assert row["memory"] > 1e7 and 0.0 < row["overhead"] < 1.0
    assert found["orders"]["end"] == pytest.approx(2.0, abs=0.05)
    assert found["richardson"]["end"] == pytest.approx(2.0, abs=0.05)
    assert [row["met"] for row in found["rows"]] == [False, False, True]
    assert found["recommended"]["label"] == "0.00390625"
    said = capsys.readouterr().out
    assert "recommended: 0.00390625, the cheapest that meets all expectations" in said
    assert "order of end: 2.0" in said and "not met" in said


def test_a_study_leaves_its_runs_a_table_and_a_picture(tmp_path):
    assert found_by("study", write(tmp_path, refinements(0.02, 0.01)))[0] == 1
    left = tmp_path / "all"
    assert (left / "study.png").read_bytes().startswith(b"\x89PNG")
    assert (left / "study.json").read_text() == (tmp_path / "found.json").read_text()
    for name in ("0.02", "0.01"):
        results = json.loads((left / name / "results.json").read_text())
        assert results["status"] == "done"
        assert f"step = {name}" in (left / name / "scene.toml").read_text()
        assert "study" not in (left / name / "scene.toml").read_text()


def test_the_cheapest_of_several_good_refinements_is_recommended(tmp_path):
    several = refinements(1e-3, 0.005) + PLAIN
    status, found = found_by("study", write(tmp_path, several, within=0.1), "--set", "end=1.0")
    assert status == 0 and all(row["met"] for row in found["rows"])
    assert found["rows"][0]["cpu"] > found["recommended"]["cpu"]
    assert found["recommended"]["cpu"] == min(row["cpu"] for row in found["rows"])


def test_a_refinement_that_fails_is_told_and_the_others_count(tmp_path, capsys):
    path = write_scene(tmp_path, end=0.01)
    path.write_text(
        path.read_text()
        + '[[study]]\nlabel = "dies"\nsettings = { "components.pong.fails_at" = 3 }\n'
        + '[[study]]\nlabel = "lives"\nsettings = { "components.pong.items" = 5 }\n'
    )
    status, found = found_by("study", path)
    assert status == 3 and found["recommended"] is None
    assert [row["status"] for row in found["rows"]] == ["failed", "done"]
    assert "asked to raise" in (tmp_path / "all" / "dies" / "run.log").read_text()


def test_orders_are_those_of_exact_powers():
    sizes = [0.4, 0.2, 0.1, 0.05]
    values = [3.0 + 2.0 * h**1.5 for h in sizes]
    assert least_squares(sizes, [2.0 * h**1.5 for h in sizes]) == pytest.approx(1.5)
    assert richardson(sizes, values) == pytest.approx(1.5)
    assert least_squares([0.1], [1.0]) is None and least_squares([0.1, 0.2], [0.0, 1.0]) is None
    assert richardson([0.4, 0.2, 0.15], values[:3]) is None  # no constant ratio
    assert richardson([0.4, 0.2, 0.1], [1.0, 2.0, 1.0]) is None  # does not settle


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
        '[[study]]\nlabel = "b"\nsettings = {}\nsize = "components.spring.step"',
        "study: one size must serve all refinements that name one; found "
        "components.spring.step, end. Name the same, or none.",
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
    said = capsys.readouterr().err
    assert "scene.end should be greater than 0" in said
    assert "study.a.sice is not known. Did you mean size?" in said
    assert not (tmp_path / "all").exists()


def test_a_scene_without_refinements_says_so(tmp_path, capsys):
    assert command("study", write(tmp_path)) == 2
    assert "there is no [[study]]. Add one for every refinement." in capsys.readouterr().err


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
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
    said, _ = process.communicate(timeout=30.0)
    assert process.returncode == 130
    found = json.loads((tmp_path / "found.json").read_text())
    assert [row["status"] for row in found["rows"]] == ["done", "interrupted"]
    assert found["recommended"]["label"] == "0.005" and "recommended: 0.005" in said
    assert json.loads((running.parent / "results.json").read_text())["status"] == "interrupted"


def test_a_study_keeps_what_was_done_of_the_same_scene_alone(tmp_path, capsys):
    path = write(tmp_path, refinements(*STEPS[:2]))
    _, before = found_by("study", path)
    write(tmp_path, refinements(*STEPS))
    capsys.readouterr()
    status, found = found_by("study", path, "--keep")
    said = capsys.readouterr().out
    assert status == 0 and found["rows"][:2] == before["rows"]
    assert [f"{step}: kept" in said for step in STEPS] == [True, True, False]
    failed = tmp_path / "all" / str(STEPS[1]) / "results.json"
    changed = json.loads(failed.read_text()) | {"status": "failed"}
    del changed["checksums"]  # as of a run without them: else it would be refused as changed
    failed.write_text(json.dumps(changed))
    found_by("study", path, "--keep")
    said = capsys.readouterr().out
    assert [f"{step}: kept" in said for step in STEPS] == [True, False, True]
    write(tmp_path, refinements(*STEPS), within=1e-3)
    found_by("study", path, "--keep")
    assert "kept" not in capsys.readouterr().out


def test_a_window_is_never_longer_than_the_step_it_is_made_from(tmp_path):
    path = write(tmp_path)
    assert command(
        "run", path, "--set", "components.spring.step=0.03", "--out", tmp_path / "o"
    ) in (0, 1)
    results = json.loads((tmp_path / "o" / "results.json").read_text())
    assert results["windows"] == results["timing"]["components"]["spring"]["steps"]
    assert 34 <= results["windows"] <= 34 * 8 / 7  # at most an eighth of the step is lost
