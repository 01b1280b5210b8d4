"""A scene is run, checked and opened from Python as it is from the command line."""

import json
import os
import signal
import subprocess
import sys
import threading
from functools import partial
from importlib.metadata import version

import matplotlib.image
import numpy as np
import pytest
from started import write_scene

import quintet
from quintet.coupler.report.diff import compare
from quintet.coupler.run import progress
from quintet.interfaces import errors
from quintet.interfaces.errors import RunError, SceneError

OVER = [pytest.param("zenoh", marks=pytest.mark.zenoh), pytest.param("mpi", marks=pytest.mark.mpi)]
EXPECT = """
[[expect]]
name = "last"
component = "pong"
field = "out.number"
axis = 0
measure = "at"
begin = 0.02
value = 0.1
within = {within}
unit = "m"
source = "none"
"""
SCRIPT = """
import numpy as np
import quintet

run = quintet.run("scene.toml", settings={"components.ping.items": 4}, out="results")
number = run.fields["ping.out.number"]
print(run.ok, run.folder.name, number.values.shape, number.unit, number.times[-1])
print(np.abs(number).max() > 0.0, run.scene["components"]["ping"]["items"])
"""


@pytest.fixture
def scene(tmp_path):
    def write(within=9.0, end=0.02, **options):
        path = write_scene(tmp_path, "memory", end, **options)
        path.write_text(path.read_text() + EXPECT.format(within=within))
        return path

    return write


def run(scene, **options):
    return quintet.run(scene, out=scene.parent / "out", **options)


def test_importing_the_package_loads_nothing_else():
    program = "import quintet, sys; print(*sys.modules)"
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    names = result.stdout.split()
    assert {name for name in names if name.startswith("quintet")} == {"quintet"}
    assert not {"numpy", "h5py", "numba", "rich", "importlib.metadata"} & set(names)


@pytest.mark.parametrize("name", ["QuintetError", "RunError", "SceneError"])
def test_the_errors_that_are_raised_are_of_the_package(name):
    assert getattr(quintet, name) is getattr(errors, name), "one class, by either name"
    assert name in quintet.__all__
    with pytest.raises(quintet.SceneError, match="scene nowhere is not known"):
        quintet.check("nowhere")
    with pytest.raises(AttributeError, match="has no attribute 'NoSuchError'"):
        quintet.NoSuchError  # noqa: B018


def test_the_version_is_that_of_the_installed_package():
    assert quintet.__version__ == version("quintet")


def test_a_script_runs_a_scene_and_reads_its_fields(scene):
    path = scene(pong="items = 4")
    script = path.with_name("script.py")
    script.write_text(SCRIPT)
    result = subprocess.run(
        [sys.executable, str(script)], cwd=path.parent, capture_output=True, text=True, timeout=60
    )
    assert result.returncode == 0, result.stderr
    assert result.stdout.splitlines()[-2:] == ["True results (21, 4, 3) m 0.02", "True 4"]


@pytest.mark.parametrize(("within", "ok"), [(9.0, True), (0.0, False)])
def test_a_run_has_results_ledger_and_fields(scene, within, ok):
    toy_run = run(scene(within))
    assert toy_run.status == "done" and toy_run.ok is ok
    assert toy_run.expectations["last"]["met"] is ok
    assert toy_run.results == json.loads((toy_run.folder / "results.json").read_text())
    assert toy_run.scene["end"] == 0.02
    push = toy_run.fields["pong.out.push"]
    assert push.unit == "N s" and push.values.shape == (21, 5, 3) and len(push.times) == 21
    assert "pong.out.push" in toy_run.fields and "pong.out.pull" not in toy_run.fields
    with pytest.raises(KeyError, match=r"Did you mean pong\.out\.push"):
        toy_run.fields["pong.out.pushh"]
    work = toy_run.ledger["ping-pong"]["work_given"]
    assert work.unit == "J" and work.values.shape == work.times.shape
    assert "toy: done, 20 windows" in str(toy_run)


def test_a_run_can_be_opened_later(scene):
    first = run(scene())
    reopened = quintet.load(first.folder)
    assert reopened.results == first.results
    for key in first.fields:
        assert np.array_equal(reopened.fields[key], first.fields[key])
    with pytest.raises(SceneError, match=r"it has no results\.json"):
        quintet.load(first.folder / "log")


@pytest.mark.parametrize("transport", OVER)
def test_every_transport_gives_the_same_bits_from_python(scene, transport):
    path = scene()
    first = run(path)
    second = quintet.run(path, transport=transport, out=path.parent / "other")
    assert second.results["transport"] == transport
    assert compare(first.folder, second.folder) is None


def test_the_command_in_the_results_gives_the_same_bits(scene, tmp_path):
    toy_run = run(scene(), settings={"components.pong.substeps": np.int64(3)})
    command = toy_run.results["command"].split()
    assert command[:2] == ["quintet", "run"] and "components.pong.substeps=3" in command
    line = [sys.executable, "-m", "quintet.coupler.cli", *command[1:], "--out", "again"]
    subprocess.run(line, cwd=tmp_path, check=True, capture_output=True, timeout=60)
    assert compare(toy_run.folder, tmp_path / "again") is None


def test_mistakes_of_a_scene_are_raised_and_nothing_is_started(scene):
    path = scene()
    for function in (partial(quintet.check, imports=True), quintet.run):
        with pytest.raises(SceneError, match=r"components\.ping\.itemss is not known"):
            function(path, settings={"components.ping.itemss": 3})
    assert not (path.parent / "runs").exists()


def test_a_plan_tells_what_a_run_will_need(scene):
    plan = quintet.check(scene(), settings={"end": 0.05}, transport="zenoh")
    assert "serial; 50 windows of 0.001 s" in str(plan) and "3 processes" in str(plan)
    assert plan.scene.components["ping"].kind == "toys:Toy"


@pytest.mark.parametrize("transport", ["memory", *OVER])
def test_a_failed_run_is_raised_with_its_folder(scene, transport):
    with pytest.raises(RunError, match=r"pong failed in window 7: .*asked to raise") as error_info:
        run(scene(pong="fails_at = 7"), transport=transport)
    failed_run = quintet.load(error_info.value.folder)
    assert failed_run.status == "failed" and not failed_run.ok


def test_an_interrupted_run_is_continued_to_the_same_bits(scene):
    path = scene(end=1.0, pong="pause = 1e-3")
    reference = quintet.run(path, out=path.parent / "whole")
    threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
    first = run(path)
    assert first.status == "interrupted" and not first.ok
    assert quintet.resume(first.folder).status == "done"
    assert compare(reference.folder, first.folder) is None


def test_a_run_in_another_thread_leaves_signals_alone(scene):
    path, runs = scene(), []
    thread = threading.Thread(target=lambda: runs.append(run(path)))
    thread.start()
    thread.join()
    assert runs[0].ok


def test_a_notebook_shows_tables_and_pictures(scene):
    toy_run = run(scene())
    assert toy_run._repr_png_() is None
    picture = toy_run.folder / "scene.png"
    matplotlib.image.imsave(picture, np.zeros((4, 4, 3)))
    html = toy_run._repr_html_()
    assert "expectation" in html and "ping-pong" in html
    assert html.count("data:image/png;base64,") == 1
    assert toy_run._repr_png_() == picture.read_bytes()
    for text in (html, str(toy_run)):
        assert all(f"{head} [s]" in text for head in ("build", "compute", "CPU", "wait"))


@pytest.mark.parametrize("widgets", [None, "installed"])
def test_a_notebook_with_widgets_shows_a_bar(monkeypatch, widgets):
    monkeypatch.setattr("rich.console._is_jupyter", lambda: True)
    monkeypatch.setattr(progress.importlib.util, "find_spec", lambda name: widgets)
    assert progress.shows_bar() is (widgets is not None)
