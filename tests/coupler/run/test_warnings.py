"""A component that warns: the user reads it, and the run ends with status 1."""

import json
import shutil

import pytest
from spring_scene import command, write

from quintet.coupler.run import snapshots

WARY = '''
from toy_spring import Spring


class Judged(Spring):
    """Judges only its whole run."""

    def final_warnings(self):
        return {"end": f"it ended at {float(self.position[0, 0]):.3f} m. Go on."}


class Wary(Spring):
    """Warns while it is beyond a third of its first displacement, and counts nothing unsaved."""

    def warnings(self):
        x = float(self.position[0, 0])
        return {"range": f"it went to {x:.3f} m. Shorten it."} if x < -0.3 else {}
'''


def _scene(folder, end=1.0, begin=1.0, transport="memory"):
    path = write(folder, within=1e9)
    (folder / "wary.py").write_text(WARY)
    text = path.read_text().replace("toy_spring:Spring", "wary:Wary")
    text = text.replace('transport = "memory"', f'transport = "{transport}"')
    path.write_text(
        text.replace("end = 1.0", f"end = {end}").replace("begin = 1.0", f"begin = {begin}")
    )
    return path


def _results(folder):
    return json.loads((folder / "results.json").read_text())


OVER = ["memory", pytest.param("zenoh", marks=pytest.mark.zenoh)]


@pytest.mark.parametrize("transport", OVER)
def test_a_warning_is_told_once_and_ends_the_run_with_status_1(tmp_path, capfd, transport):
    path = _scene(tmp_path, transport=transport)
    assert command("run", path, "--out", tmp_path / "out") == 1
    (warning,) = _results(tmp_path / "out")["warnings"]
    assert (warning["source"], warning["subject"]) == ("component spring", "range")
    assert 0.18 < warning["time"] < 0.3, "raised as the spring passed -0.3 m, cos(10 t)"
    assert warning["text"].endswith("Shorten it.")
    screen = capfd.readouterr()
    assert screen.err.count("warning of component spring: it went to -0.") == 1
    assert "Warning of component spring: it went to" in screen.out
    assert _results(tmp_path / "out")["status"] == "done"


@pytest.mark.parametrize("transport", [*OVER, pytest.param("mpi", marks=pytest.mark.mpi)])
def test_the_whole_run_is_judged_once_at_its_end(tmp_path, capfd, transport):
    path = _scene(tmp_path, transport=transport)
    path.write_text(path.read_text().replace("wary:Wary", "wary:Judged"))
    assert command("run", path, "--out", tmp_path / "out") == 1
    (warning,) = _results(tmp_path / "out")["warnings"]
    assert (warning["source"], warning["subject"], warning["time"]) == (
        "component spring",
        "end",
        1.0,
    )
    assert warning["text"] == "it ended at -0.831 m. Go on."
    assert capfd.readouterr().err.count("warning of component spring: it ended at") == 1


def test_a_run_without_warnings_ends_with_status_0(tmp_path):
    path = _scene(tmp_path, end=0.1, begin=0.1)
    assert command("run", path, "--out", tmp_path / "out") == 0
    assert _results(tmp_path / "out")["warnings"] == []


def test_a_warning_outlives_a_resume(tmp_path, monkeypatch):
    """The spring swings back long before the end: the run that goes on does not warn again."""
    monkeypatch.setattr(snapshots, "remove", lambda paths: None)
    path = _scene(tmp_path, end=0.6, begin=0.6)
    out, resumed = tmp_path / "out", tmp_path / "again"
    assert command("run", path, "--out", out, "--set", "output.snapshots=0.59") == 1
    shutil.copytree(out, resumed)
    assert command("run", "--resume", resumed) == 1
    assert _results(resumed)["warnings"] == _results(out)["warnings"] != []
