"""A watched process that ended or does nothing is told from one that works."""

import os
import signal
import subprocess
import sys
import time

import pytest
from started import write_scene

from quintet.coupler.launch import mpi_job, processes
from quintet.coupler.launch.processes import Watch, environment, tail
from quintet.coupler.scene.read import load
from quintet.interfaces.errors import SceneError
from quintet.interfaces.lines.process_status import processor_time, running, state

SLEEPS = "import time; time.sleep(60)"
WORKS = "while True: pass"
TOUCHES = """
import time
while True:
    began = time.time()
    while time.time() < began + 0.01:
        pass
    time.sleep(0.1)
"""


@pytest.fixture
def watched(monkeypatch):
    monkeypatch.setattr(processes, "QUIET_EXTRA", 0.6)
    monkeypatch.setattr(processes, "INTERVAL", 0.2)
    started = []

    def start(code):
        process = subprocess.Popen([sys.executable, "-c", code])
        started.append(process)
        return Watch("water", process.pid, process)

    yield start
    for process in started:
        process.kill()
        process.wait()


def reason_within(watch, seconds):
    """What the watch says within a time."""
    limit = time.monotonic() + seconds
    while time.monotonic() < limit:
        if reason := watch():
            return reason
        time.sleep(0.02)
    return ""


def test_a_process_that_does_nothing_is_noticed(watched):
    watch = watched(SLEEPS)
    began = time.monotonic()
    reason = reason_within(watch, 3.0)
    assert 0.6 <= time.monotonic() - began < 1.5
    assert reason.startswith("stopped responding: no answer and no processor time for")
    assert f"process {watch.pid} is sleeping" in reason


def test_a_stopped_process_is_called_so(watched):
    watch = watched(WORKS)
    os.kill(watch.pid, signal.SIGSTOP)
    assert f"(process {watch.pid} is stopped)" in reason_within(watch, 3.0)


@pytest.mark.parametrize("code", [WORKS, TOUCHES], ids=["all the time", "a tenth of the time"])
def test_a_process_that_works_is_left_alone(watched, code):
    assert reason_within(watched(code), 2.0) == ""


def test_a_process_may_be_as_silent_as_it_usually_is(watched):
    watch = watched(SLEEPS)
    watch.usual = lambda: 1.0
    assert reason_within(watch, 2.0) == ""


def test_a_new_wait_begins_anew(watched):
    watch = watched(SLEEPS)
    for _ in range(4):
        watch.reset()
        assert reason_within(watch, 0.4) == ""


@pytest.mark.parametrize(
    ("code", "words"),
    [
        ("import sys; sys.exit(0)", "ended by itself with status 0, before it was told to"),
        ("import sys; sys.exit(5)", "ended by itself with status 5"),
        ("import os; os.kill(os.getpid(), 9)", "was killed by signal 9 (SIGKILL)"),
        ("import os; os.abort()", "was killed by signal 6 (SIGABRT)"),
    ],
)
def test_how_a_process_ended_is_said(watched, code, words):
    assert words in reason_within(watched(code), 5.0)


def test_a_process_that_is_not_our_child_is_gone_when_it_is():
    process = subprocess.Popen([sys.executable, "-c", SLEEPS])
    watch = Watch("water", process.pid)
    assert watch.alive() and running(process.pid) and state(process.pid) in "RS"
    process.kill()
    while running(process.pid):
        time.sleep(0.01)
    assert state(process.pid) == "Z"  # not yet awaited, and gone all the same
    assert "is gone: it ended or was killed" in watch()
    process.wait()
    assert state(process.pid) == "" and processor_time(process.pid) == 0.0


def test_ending_leaves_no_process_and_no_file(watched, tmp_path):
    watch, left = watched(SLEEPS), tmp_path / "shared"
    left.touch()
    watch.shared = [str(left), str(tmp_path / "never was")]
    watch.end(0.1)
    assert not watch.alive() and not left.exists()


def test_a_component_gets_its_threads_and_the_import_path_without_where_we_are(monkeypatch):
    monkeypatch.setenv("PYTHONPATH", f"/elsewhere{os.pathsep}")
    made = environment(3)
    assert made["NUMBA_NUM_THREADS"] == made["OMP_NUM_THREADS"] == "3"
    assert made["PYTHONPATH"] == "/elsewhere"


def test_a_log_is_quoted_from_its_end(tmp_path):
    log = tmp_path / "log"
    log.write_text("".join(f"line {n}\n" for n in range(5000)))
    assert tail(log, 3) == ["line 4997", "line 4998", "line 4999"]
    assert tail(tmp_path / "none") == []


def only(folder, monkeypatch):
    """Let mpiexec be looked for in one folder."""
    monkeypatch.setattr(sys, "executable", str(folder / "python"))
    monkeypatch.setenv("PATH", str(folder))


def test_ranks_are_the_coupler_and_every_component(tmp_path, monkeypatch):
    launcher = tmp_path / "mpiexec"
    launcher.write_text("#!/bin/sh\necho HYDRA build details:\n")
    launcher.chmod(0o755)
    only(tmp_path, monkeypatch)
    scene = load(str(write_scene(tmp_path)))
    line = mpi_job.command(["run", "x.toml"], scene, tmp_path)
    assert line[:2] == [str(launcher), "-disable-auto-cleanup"]
    ranks = " ".join(line).split(" : ")
    assert len(ranks) == 3 and all("-m mpi4py" in rank for rank in ranks)
    assert "quintet.coupler.cli run x.toml --inside-mpi" in ranks[0]
    for name, rank in zip(("ping", "pong"), ranks[1:], strict=True):
        assert f"toys:Toy --name {name} --mpi --log {tmp_path}/log/{name}.log" in rank


def test_a_missing_launcher_is_said(tmp_path, monkeypatch):
    only(tmp_path, monkeypatch)
    scene = load(str(write_scene(tmp_path)))
    with pytest.raises(SceneError, match=r"needs an mpiexec; there is none on PATH\. Install"):
        mpi_job.command([], scene, tmp_path)
