"""A run that fails ends soon, names component, window and cause, and leaves nothing behind."""

import time

import pytest
from started import Started, write_scene

from quintet.coupler.files.recording import Recording

AT = 60  # the window in which a component fails
OVER = [pytest.param("zenoh", marks=pytest.mark.zenoh), pytest.param("mpi", marks=pytest.mark.mpi)]


def failing(folder, transport, cause):
    pong = f'fails_at = {AT}\nfails_by = "{cause}"'
    return Started(write_scene(folder, transport, 100.0, pong=pong))


def check_end(run):
    """No process still runs, and no file is left in shared memory."""
    assert not run.processes()
    assert not run.left_in_shared_memory()


@pytest.mark.zenoh
def test_a_failed_run_keeps_what_it_has_and_quotes_the_log(tmp_path):
    run = failing(tmp_path, "zenoh", "raise")
    assert run.wait() == 3
    log = run.folder / "log" / "pong.log"
    assert f"last lines of {log}" in run.err
    results = run.results
    fault = results["fault"]
    assert results["status"] == "failed" and results["windows"] == AT
    assert (fault["component"], fault["window"], fault["log"]) == ("pong", AT, str(log))
    assert fault["tail"][-1] == "ArithmeticError: asked to raise"
    assert "in fail" in fault["traceback"]
    check_end(run)
    with Recording(run.folder) as recording:
        assert len(recording.times("ping")) == AT + 1  # all whole windows are kept


@pytest.mark.zenoh
@pytest.mark.parametrize("cause", ["raise", "kill"])
def test_who_fails_while_another_is_awaited_is_told_at_once(tmp_path, cause):
    scene = write_scene(
        tmp_path, "zenoh", 100.0, "pause = 100.0", f'fails_at = 0\nfails_by = "{cause}"'
    )
    scene.write_text('scheme = "parallel"\n' + scene.read_text())
    run = Started(scene)
    start = time.monotonic()
    assert run.wait() == 3
    assert time.monotonic() - start < 50.0  # including the start on a loaded machine
    assert run.results["fault"]["component"] == "pong"
    assert ("asked to raise" if cause == "raise" else "SIGKILL") in run.results["fault"]["cause"]
    check_end(run)


@pytest.mark.mpi
def test_an_unmet_expectation_is_no_failure_of_the_job(tmp_path):
    scene = write_scene(tmp_path, "mpi", 0.01)
    scene.write_text(scene.read_text() + UNMET)
    run = Started(scene)
    assert run.wait() == 1
    log = (run.folder / "log" / "mpiexec.log").read_text()
    assert "Abort" not in run.out + run.err + log
    check_end(run)


UNMET = """
[[expect]]
name = "far"
component = "ping"
field = "out.number"
axis = 0
measure = "at"
begin = 0.01
value = 1e9
within = 1e-3
unit = "m"
source = "nowhere"
"""


@pytest.mark.parametrize("transport", ["memory", *OVER])
def test_a_component_that_cannot_be_built_ends_the_run_with_a_report(tmp_path, transport):
    scene = write_scene(tmp_path, transport)
    scene.write_text(scene.read_text().replace("toys:Toy", "toys:Fragile", 1))
    run = Started(scene)
    assert run.wait() == 3
    assert "ping failed in window 0" in run.err and "asked not to be built" in run.err
    assert run.results["fault"]["component"] == "ping"
    check_end(run)


def test_a_failing_component_in_memory_is_reported_alike(tmp_path):
    pong = f'fails_at = {AT}\nfails_by = "raise"'
    run = Started(write_scene(tmp_path, "memory", pong=pong))
    assert run.wait() == 3
    assert run.results["fault"]["component"] == "pong" and run.results["fault"]["window"] == AT
    assert f"pong failed in window {AT}: ArithmeticError: asked to raise" in run.err


@pytest.mark.zenoh
def test_a_component_killed_before_it_joined_is_reported(tmp_path, monkeypatch):
    scene = write_scene(tmp_path, "zenoh")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    (tmp_path / "sitecustomize.py").write_text(
        "import os, sys\nif 'pong' in sys.argv: os._exit(7)\n"
    )
    run = Started(scene)
    assert run.wait() == 3
    assert "pong failed in window 0: did not join: process" in run.err
    assert "ended by itself with status 7" in run.err
    check_end(run)


SAID = {
    "sys.exit": "SystemExit: asked Python to exit, with status 0; raise an error instead",
    "long": "ArithmeticError: asked to say much and more ",
    "odd": r"ArithmeticError: asked to say \udcff",
}


@pytest.mark.parametrize("transport", ["memory", *OVER])
@pytest.mark.parametrize("cause", SAID)
def test_an_end_that_python_asks_for_and_odd_texts_keep_their_cause(tmp_path, transport, cause):
    run = failing(tmp_path, transport, cause)
    assert run.wait() == 3
    fault = run.results["fault"]
    assert fault["component"] == "pong" and fault["cause"].startswith(SAID[cause])
    if cause == "long":
        assert fault["cause"].endswith("and more to the end")
    check_end(run)
