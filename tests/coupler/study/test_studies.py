"""All studies: no run is repeated, whatever ends the command; the table holds the measurements."""

import json
import os
import signal
import subprocess
import sys
import time
from collections import Counter

import pytest
from spring_scene import command, write

from quintet.coupler.report.marked_place import STUDIES
from quintet.coupler.study import studies, studies_plan

REFINEMENT = """
[[study]]
label = "{0}"
settings = {{ "components.spring.step" = {0} }}
size = "components.spring.step"
"""
STEPS = (0.02, 0.01, 0.005, 0.0025)
# The command, with scenes of our own in the place of those that come with quintet.
DRIVER = """
import sys
from pathlib import Path
from quintet.coupler.cli import main
from quintet.coupler.study import studies
root = Path(sys.argv.pop(1))
studies.library = lambda: {path.parent.name: path for path in root.glob("*/scene.toml")}
main(sys.argv[1:])
"""


@pytest.fixture
def scenes(tmp_path, monkeypatch):
    """Two scenes that differ, in folders of their own, and a README."""
    root = tmp_path / "scenes"
    for name, stiffness in (("soft", 100.0), ("stiff", 225.0)):
        (root / name).mkdir(parents=True)
        path = write(root / name, "".join(map(REFINEMENT.format, STEPS)))
        text = path.read_text().replace('name = "spring"', f'name = "{name}"\nminutes = 0.05', 1)
        path.write_text(text.replace("stiffness = 100.0", f"stiffness = {stiffness}"))
    (root / "README.md").write_text("before\n<!-- study -->\nold\n<!-- studied -->\nafter\n")
    paths = {path.parent.name: path for path in root.glob("*/scene.toml")}
    monkeypatch.setattr(studies, "library", lambda: paths)
    return root


def journal(folder):
    path = folder / "sweep.log"
    lines = path.read_text().splitlines() if path.is_file() else []
    return Counter(tuple(line.split()[1:]) for line in lines)


def events(folder, event):
    return {run: count for (run, name), count in journal(folder).items() if name == event}


def begin(root, out):
    line = [sys.executable, "-c", DRIVER, str(root), "study", "--all", "--out", str(out)]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
    return subprocess.Popen(line, text=True, start_new_session=True, **pipes)


@pytest.mark.slow
@pytest.mark.parametrize("kills_after", [(3,), pytest.param((1, 3, 4), marks=pytest.mark.full)])
def test_what_was_complete_when_it_was_killed_is_not_run_again(scenes, tmp_path, kills_after):
    out = tmp_path / "all"
    for complete in kills_after:
        process, limit = begin(scenes, out), time.monotonic() + 90.0
        while len(events(out, "done")) < complete and time.monotonic() < limit:
            time.sleep(0.01)
        done_before = events(out, "done")
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        assert len(done_before) >= complete
    process = begin(scenes, out)
    output, _ = process.communicate(timeout=120)
    assert process.returncode == 0, output
    done, started = events(out, "done"), events(out, "started")
    assert len(done) == len(started) == 8 and set(done.values()) == {1}
    assert sum(started.values()) <= 8 + len(kills_after), "only the run under way is begun again"
    assert not events(out, "resumed"), "times would count from there"
    content = json.loads((out / "studies.json").read_text())
    assert [study["scene"] for study in content] == ["soft", "stiff"]
    for study in content:
        assert [row["status"] for row in study["rows"]] == 4 * ["done"]
        assert {row["run"] for row in study["rows"]} <= set(done)
        assert all(row["date"] and row["on"]["cores"] for row in study["rows"])
    order = content[0]["kinds"]["time step"]["orders"]["end"]  # the reference is that of soft
    assert order["order"] == pytest.approx(2.0, abs=0.2)


def all_studies(root, out, *options):
    arguments = ("--json", root / "studies.json", "--readme", root / "README.md")
    return command("study", "--all", "--out", out, *arguments, *options)


@pytest.mark.slow
def test_the_time_is_kept_and_the_same_command_goes_on(scenes, tmp_path, capsys, monkeypatch):
    # Much longer than they take, so that it is the estimate that counts on a busy machine too.
    monkeypatch.setattr(studies_plan, "QUICK", 800.0)  # one refinement of each scene is slower
    monkeypatch.setattr(studies_plan, "estimated", lambda base, scene: 4.0 / step_of(scene))
    out, readme = tmp_path / "all", scenes / "README.md"
    assert all_studies(scenes, out, "--minutes", 0) == 130
    output = capsys.readouterr().out
    assert "8 refinements of 2 scenes, 6 of them quick, 0 complete" in output
    assert "now 0 runs, one after the other: about 0 min of 0" in output
    assert "2 refinements take more than a minute" in output
    assert "6 quick runs, about 47 min more, do not fit into the time: the same command" in output
    assert "| `quintet study soft` | 0.02 | time step | - | - | - | - | not measured" in (
        STUDIES.read(readme)
    )
    assert all_studies(scenes, out, "--minutes", 15) == 130  # 200 + 200 + 400 s
    first_done = events(out, "done")
    assert len(first_done) == 3
    assert all_studies(scenes, out) == 0
    assert len(events(out, "done")) == 6 and set(events(out, "started").values()) == {1}
    lines = STUDIES.read(readme).splitlines()
    assert len(lines) == 2 + 8 and sum("not measured" in line for line in lines) == 2
    assert readme.read_text().startswith("before\n<!-- study -->\n")
    assert readme.read_text().endswith("<!-- studied -->\nafter\n")

    # In a new folder, as after a change of the source code, the measurements are kept.
    table = STUDIES.read(readme)
    assert all_studies(scenes, tmp_path / "other", "--minutes", 0) == 130
    assert STUDIES.read(readme) == table


def test_a_run_measured_beside_others_counts_at_most_its_processor_time_and_a_start(tmp_path):
    rows = [
        {"settings": {"window": wall}, "status": status, "wall": wall, "cpu": 30.0}
        for status, wall in (("done", 90.0), ("done", 20.0), ("not run", 0.0))
    ]
    path = tmp_path / "studies.json"
    path.write_text(json.dumps([{"scene": "soft", "rows": rows}, {"scene": "stiff", "rows": []}]))
    assert list(studies_plan.measured_times(path, "soft").values()) == [34.0, 20.0]
    assert studies_plan.measured_times(path, "stiff") == {}


def step_of(scene):
    return scene.resolved["components"]["spring"]["step"]


WRONG = {
    "a preset": (("--preset", "quick"), "study --all takes no --preset. Remove it, or name a"),
    "an error": (("--error", 0.1), "study --all takes no --error. Remove it, or name a scene."),
    "minutes": (("--minutes", -1), "--minutes must be 0 or more; found -1. Correct it."),
}


@pytest.mark.parametrize("case", WRONG)
def test_options_of_one_scene_are_refused(scenes, tmp_path, capsys, case):
    options, sentence = WRONG[case]
    assert command("study", "--all", *options, "--out", tmp_path / "all") == 2
    assert sentence in capsys.readouterr().err
    assert not (tmp_path / "all").exists()


def test_a_file_without_a_place_for_the_table_is_left_as_it_is(scenes, tmp_path, capsys):
    path = tmp_path / "other.md"
    path.write_text("<!-- study -->\nno end\n")
    assert command("study", "--all", "--readme", path, "--out", tmp_path / "all") == 2
    assert "it must have the lines <!-- study --> and <!-- studied -->" in capsys.readouterr().err
    assert path.read_text() == "<!-- study -->\nno end\n" and not (tmp_path / "all").exists()
    assert command("study", "--all", "--readme", tmp_path / "none.md") == 2
    assert "none.md: it cannot be read" in capsys.readouterr().err
