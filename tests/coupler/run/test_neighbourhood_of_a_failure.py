"""The neighbourhood of the item at which a component failed is written to a file for ParaView."""

import json

import numpy as np
import pytest
from started import write_scene

from quintet.coupler.files import vtkhdf_reader
from quintet.coupler.report.view_steps import view_files
from quintet.coupler.run.run_scene import resume_scene, run_scene
from quintet.coupler.run.snapshots import latest
from quintet.coupler.scene.read import load

INVALID = """
import numpy as np
from toys import Toy
from quintet.interfaces.errors import StepError

class Invalid(Toy):
    '''400 points on a line, of which number 300 becomes invalid.'''
    def check(self):
        if self.steps == 41:
            self.value[300] = np.nan
            raise StepError("point 300 must be finite", self.value[300] if NOWHERE else (0.3, 0, 0))

    def view(self):
        points = np.zeros((400, 3))
        points[:, 0] = np.linspace(0.0, 0.399, 400)
        points[300] += self.value[300]
        return {"points": points, "heat": np.arange(400.0), "push": self.push}
"""


@pytest.fixture
def failed(tmp_path, monkeypatch, capsys):
    """Run a scene in which a point becomes invalid; return its folder, scene and errors."""

    def run(*settings, nowhere=False):
        path = write_scene(tmp_path, end=0.1, ping="items = 400", pong="items = 400")
        path.write_text(path.read_text().replace("toys:Toy", "toy_invalid:Invalid", 1))
        text = INVALID.replace("NOWHERE", str(nowhere))
        (tmp_path / "toy_invalid.py").write_text(text)
        monkeypatch.delitem(__import__("sys").modules, "toy_invalid", raising=False)
        scene = load(str(path), settings=settings)
        folder, status = run_scene(scene, tmp_path / "out")
        assert status == 3
        return folder, scene, capsys.readouterr().err

    return run


def test_it_is_written_with_the_view_before_and_named(failed):
    folder, _, message = failed("output.interval=0.02")
    assert "ping failed in window 40: StepError: point 300 must be finite" in message
    text = "the 250 points nearest to it, at the last view and when it failed, are in ping.failure"
    assert text in message
    assert text in json.loads((folder / "results.json").read_text())["fault"]["neighbourhood"]
    path = folder / "ping.failure.vtkhdf"
    assert np.allclose(vtkhdf_reader.times(path), [0.04, 0.04])
    last_view, failure_view = (vtkhdf_reader.read_step(path, k)[1] for k in (0, 1))
    assert len(failure_view["points"]) == len(last_view["points"]) == 250
    assert (
        299.0 in failure_view["heat"]
        and 301.0 in failure_view["heat"]
        and 0.0 not in failure_view["heat"]
    )
    assert view_files(folder) and path not in view_files(folder)


def test_of_an_item_at_no_place_it_is_where_it_was(failed):
    folder, *_ = failed("output.interval=0.02", nowhere=True)
    path = folder / "ping.failure.vtkhdf"
    last_view, failure_view = (vtkhdf_reader.read_step(path, k)[1] for k in (0, 1))
    assert (
        300.0 in last_view["heat"]
        and np.isnan(failure_view["points"][failure_view["heat"] == 300.0]).all()
    )
    assert 299.0 in failure_view["heat"] and 0.0 not in failure_view["heat"]


def test_a_run_without_views_has_the_present_only(failed):
    folder, _, message = failed()
    assert "the 250 points nearest to it, when it failed, are in ping.failure.vtkhdf" in message
    assert len(vtkhdf_reader.times(folder / "ping.failure.vtkhdf")) == 1


def test_it_goes_when_the_run_goes_on(failed, monkeypatch):
    folder, scene, _ = failed("output.snapshots=0.02")
    kind = scene.components["ping"].manifest.load()
    monkeypatch.setattr(kind, "check", lambda self: None)
    assert resume_scene(scene, folder, latest(folder)) == 0
    assert not (folder / "ping.failure.vtkhdf").exists()
    assert not (folder / "failed-orders.msg").exists()
