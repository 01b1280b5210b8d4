"""A run that fails ends soon, says who, when and why, and leaves nothing behind."""

import time

import pytest
from started import Started, write_scene

from quintet.coupler.files.recording import Recording

SOON = 2.0  # s
QUIET = 5.0 + 3 * 0.01 + 1.5  # s: the rule for stopped processes, and what ending takes
AT = 60  # the window in which a component fails

FAILURES = {
    "raise": ("ArithmeticError: asked to raise",) * 2,
    "exit": ("ended by itself with status 0, before it was told to", "is gone: it ended or"),
    "kill": ("was killed by signal 9 (SIGKILL)", "is gone: it ended or was killed"),
    "nan": ("every number of out.number must be finite; item 0 is [nan nan nan]",) * 2,
    "stop": ("stopped responding: no answer and no processor time for",) * 2,
}
OVER = [pytest.param("zenoh", marks=pytest.mark.zenoh), pytest.param("mpi", marks=pytest.mark.mpi)]


def failing(folder, transport, by):
    moment = folder / "moment"
    pong = f'fails_at = {AT}\nfails_by = "{by}"\nmoment = "{moment}"'
    return Started(write_scene(folder, transport, 100.0, pong=pong)), moment


def check_end(run):
    """Nothing runs any more, and nothing lies in shared memory."""
    assert not run.processes()
    assert not run.left_in_shared_memory()


@pytest.mark.parametrize("transport", OVER)
@pytest.mark.parametrize("by", FAILURES)
def test_a_failing_component_ends_the_run_with_a_report(tmp_path, transport, by, record_property):
    run, moment = failing(tmp_path, transport, by)
    run.out, run.err = run.process.communicate(timeout=60)
    took = time.time() - float(moment.read_text())
    record_property("seconds", took)
    print(f"{transport} {by}: ended {took:.2f} s after it")
    left = run.processes()
    run.end()
    assert not left
    assert run.process.returncode == 3
    assert took < (QUIET if by == "stop" else SOON)
    cause = FAILURES[by][transport == "mpi"]
    log = run.folder / "log" / "pong.log"
    for line in (f"quintet: pong failed in window {AT}: ", cause, f"last lines of {log}"):
        assert line in run.err
    results = run.results
    fault = results["fault"]
    assert results["status"] == "failed" and results["windows"] == AT
    assert (fault["component"], fault["window"], fault["log"]) == ("pong", AT, str(log))
    assert cause in fault["cause"]
    assert fault["tail"][-1] == ("ArithmeticError: asked to raise" if by == "raise" else "step 50")
    assert ("in fail" in fault["traceback"]) == (by == "raise")
    assert not run.left_in_shared_memory()
    with Recording(run.folder) as recording:
        assert len(recording.times("ping")) == AT + 1  # all whole windows are kept


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
@pytest.mark.parametrize("by", SAID)
def test_an_end_that_python_asks_for_and_odd_texts_keep_their_cause(tmp_path, transport, by):
    run, _ = failing(tmp_path, transport, by)
    assert run.wait() == 3
    fault = run.results["fault"]
    assert fault["component"] == "pong" and fault["cause"].startswith(SAID[by])
    if by == "long":
        assert fault["cause"].endswith("and more to the end")
    check_end(run)
