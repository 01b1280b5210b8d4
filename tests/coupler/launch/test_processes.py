"""The watch of a process reports its activity, and how it ended."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest
from started import write_scene

from quintet.coupler.coupling.participant import ComponentFailed
from quintet.coupler.launch import mpi_job
from quintet.coupler.launch.companion import Companion
from quintet.coupler.launch.process_probe import ProcessProbe, signal_text
from quintet.coupler.launch.processes import end_marked, environment, marked, tail
from quintet.coupler.launch.signal_handler import ENDING
from quintet.coupler.run.watchdog_process import WatchdogProcess
from quintet.coupler.scene.read import load
from quintet.interfaces.errors import SceneError
from quintet.interfaces.lines.process_status import running

SLEEPS = "import time; time.sleep(60)"
WORKS = "while True: pass"
CHILD_WORKS = f"import subprocess, sys; subprocess.run([sys.executable, '-c', {WORKS!r}])"
CHILDREN_WORK = """
import subprocess, sys
while True:
    subprocess.run([sys.executable, '-c', 'for n in range(1_000_000): pass'])
"""
# A process that starts another waits, as for a disk, until that one has opened its files.
WAITS_FOR_DISK = """
os.mkfifo('pipe')
opens = [(os.POSIX_SPAWN_OPEN, 0, 'pipe', os.O_RDONLY, 0)]
os.posix_spawn('/bin/true', ['true'], {}, file_actions=opens)
"""
TOUCHES = """
import time
while True:
    began = time.time()
    while time.time() < began + 0.01:
        pass
    time.sleep(0.1)
"""


@pytest.fixture
def watched():
    started = []

    def start(code):
        process = subprocess.Popen([sys.executable, "-c", code])
        started.append(process)
        return ProcessProbe("water", process.pid, process)

    yield start
    for process in started:
        if process.poll() is None:
            for child in psutil.Process(process.pid).children(recursive=True):
                child.kill()
        process.kill()
        process.wait()


def activity_within(watch, seconds, words):
    """Read the watch until it reports these words or the time is over; return its last report."""
    limit = time.monotonic() + seconds
    watch.begin()
    while time.monotonic() < limit and words not in watch.activity:
        watch.read()
        time.sleep(0.02)
    return watch.described()


def ending_within(watch, seconds):
    """The ending of a process that the watch reports."""
    limit = time.monotonic() + seconds
    while time.monotonic() < limit and watch.alive():
        time.sleep(0.02)
    return watch.ending()


@pytest.mark.parametrize(
    ("code", "words"),
    [
        (SLEEPS, "sleeping"),
        (WORKS, "computing"),
        (TOUCHES, "computing"),
        (CHILD_WORKS, "waiting for its children, which compute"),
        (CHILDREN_WORK, "waiting for its children, which compute"),
        (WAITS_FOR_DISK, "waiting for a disk"),
    ],
)
def test_what_a_process_does_is_told(watched, tmp_path, code, words):
    watch = watched(f"import os; os.chdir({str(tmp_path)!r})\n{code}")
    assert activity_within(watch, 10.0, words) == f"process {watch.pid} is {words}"


def test_a_process_is_stopped_when_it_is_found_so_twice(watched):
    watch = watched(WORKS)
    assert not watch.stopped()
    os.kill(watch.pid, signal.SIGSTOP)
    while psutil.Process(watch.pid).status() != psutil.STATUS_STOPPED:
        time.sleep(0.01)
    assert not watch.stopped() and watch.stopped()
    os.kill(watch.pid, signal.SIGCONT)
    while psutil.Process(watch.pid).status() == psutil.STATUS_STOPPED:
        time.sleep(0.01)
    assert not watch.stopped()


def test_of_a_process_on_another_host_nothing_is_known():
    watch = ProcessProbe("water")
    watch.read()
    watch.kill()
    assert watch.alive() and not watch.stopped()
    assert watch.described() == "its process is on another host"


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
    assert words in ending_within(watched(code), 5.0)


def test_a_process_that_is_not_our_child_is_gone_when_it_is():
    process = subprocess.Popen([sys.executable, "-c", SLEEPS])
    watch = ProcessProbe("water", process.pid)
    assert watch.alive() and running(process.pid)
    process.kill()
    while running(process.pid):
        time.sleep(0.01)
    assert not watch.alive()  # not yet awaited, and gone all the same
    assert "is gone: it ended or was killed" in watch.ending()
    process.wait()
    assert not running(process.pid)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("137\n", "was killed by signal 9 (SIGKILL)"),
        ("139\n", "was killed by signal 11 (SIGSEGV): its compiled code used memory"),
        ("134\n", "was killed by signal 6 (SIGABRT)"),
        ("0\n", "ended by itself with status 0"),
        ("5\n", "ended by itself with status 5"),
        ("", "is gone: it ended or was killed"),
    ],
)
def test_how_a_rank_ended_is_read_from_the_file_of_its_parent(tmp_path, content, words):
    (tmp_path / "pong.exit").write_text(content)
    assert words in ProcessProbe("pong", 7, exit_file=tmp_path / "pong.exit").ending()


def test_a_rank_on_another_host_lives_until_its_exit_status_is_written(tmp_path, monkeypatch):
    monkeypatch.setattr("quintet.coupler.launch.process_probe.INTERVAL", 0.0)
    probe = ProcessProbe("toy", exit_file=tmp_path / "exit")
    assert probe.alive() and "on another host" in probe.described()
    (tmp_path / "exit").write_text("137\n")
    assert not probe.alive()
    ending = "its process, not on the coupler's host, was killed by signal 9 (SIGKILL)"
    assert probe.ending() == ending


def test_a_lack_of_memory_is_said_where_the_system_has_killed_for_it(monkeypatch, tmp_path):
    (tmp_path / "pong.exit").write_text("137")
    watch = ProcessProbe("pong", 7, exit_file=tmp_path / "pong.exit")
    monkeypatch.setattr("quintet.coupler.launch.process_probe.killed_for_memory", lambda: 1 << 40)
    assert "most likely by the system, whose memory ran out" in watch.ending()


def test_who_has_not_joined_is_on_no_other_host():
    assert ProcessProbe("water", awaited=True).described() == "nobody has joined as water yet"


def test_ending_leaves_no_process_and_no_file(watched, tmp_path):
    watch, shared_file = watched(SLEEPS), tmp_path / "shared"
    shared_file.touch()
    watch.shared = [str(shared_file), str(tmp_path / "never was")]
    watch.end(0.1)
    assert not watch.alive() and not shared_file.exists()


def test_all_that_a_process_has_started_is_found_and_ended(tmp_path):
    child_code = f"import os; os.setsid(); print('apart', flush=True); {SLEEPS}"
    code = f"import subprocess, sys; subprocess.Popen([sys.executable, '-c', {child_code!r}])"
    process = subprocess.Popen(
        [sys.executable, "-c", code],
        env={**os.environ, "QUINTET_TEST_MARK": str(tmp_path)},
        stdout=subprocess.PIPE,
    )
    assert process.stdout.readline() == b"apart\n" and process.wait() == 0
    assert len(list(marked("QUINTET_TEST_MARK", str(tmp_path)))) == 1
    end_marked("QUINTET_TEST_MARK", str(tmp_path))
    assert not [pid for pid in marked("QUINTET_TEST_MARK", str(tmp_path)) if running(pid)]
    process.stdout.close()


def test_a_component_gets_its_threads_and_the_import_path_without_where_we_are(monkeypatch):
    monkeypatch.setenv("PYTHONPATH", f"/elsewhere{os.pathsep}")
    variables = environment(3)
    assert variables["NUMBA_NUM_THREADS"] == variables["OMP_NUM_THREADS"] == "3"
    assert variables["PYTHONPATH"] == "/elsewhere"


def test_a_log_is_quoted_from_its_end(tmp_path):
    log = tmp_path / "log"
    log.write_text("".join(f"line {n}\n" for n in range(5000)))
    assert tail(log, 3) == ["line 4997", "line 4998", "line 4999"]
    assert tail(tmp_path / "none") == []


def find_mpiexec_only_in(folder, monkeypatch):
    """Make the search for mpiexec look in one folder only."""
    monkeypatch.setattr(sys, "executable", str(folder / "python"))
    monkeypatch.setenv("PATH", str(folder))


def test_ranks_are_the_coupler_and_every_component(tmp_path, monkeypatch):
    launcher = tmp_path / "mpiexec"
    launcher.write_text("#!/bin/sh\necho HYDRA build details:\n")
    launcher.chmod(0o755)
    find_mpiexec_only_in(tmp_path, monkeypatch)
    scene = load(str(write_scene(tmp_path)))
    line = mpi_job.command(["run", "x.toml"], scene, tmp_path)
    assert line[:2] == [str(launcher), "-disable-auto-cleanup"]
    ranks = " ".join(line).split(" : ")
    assert len(ranks) == 3 and all("-m mpi4py" in rank for rank in ranks)
    assert "quintet.coupler.cli run x.toml --inside-mpi" in ranks[0]
    for name, rank in zip(("ping", "pong"), ranks[1:], strict=True):
        assert f"toys:Toy --name {name} --mpi --log {tmp_path}/log/{name}.log" in rank


def test_a_missing_launcher_is_said(tmp_path, monkeypatch):
    find_mpiexec_only_in(tmp_path, monkeypatch)
    scene = load(str(write_scene(tmp_path)))
    with pytest.raises(SceneError, match=r"needs an mpiexec; there is none on PATH\. Install"):
        mpi_job.command([], scene, tmp_path)


def test_a_process_whose_name_ends_within_a_letter_runs(tmp_path):
    """The system keeps 15 bytes of a name, the last of which may be half of a letter."""
    program = tmp_path / f"{14 * 'a'}ö"
    program.write_text("#!/bin/sh\nsleep 60\n")
    program.chmod(0o700)
    mark = {"QUINTET_TEST": str(tmp_path)}
    with subprocess.Popen([program], env={**os.environ, **mark}) as process:
        while process.pid not in marked("QUINTET_TEST", str(tmp_path)):
            time.sleep(0.01)
        assert b"aaa" in Path(f"/proc/{process.pid}/stat").read_bytes()
        assert running(process.pid)
        end_marked(*mark.popitem())
        assert process.wait() == -signal.SIGKILL and not running(process.pid)


def test_a_signal_without_a_name_is_told_by_its_number(watched):
    watch = watched("import os; os.kill(os.getpid(), 40)")
    assert ending_within(watch, 30.0).endswith(f"process {watch.pid} was killed by signal 40")
    assert "(SIGKILL)" in signal_text(9)


def test_an_mpi_job_ends_if_whoever_waits_for_it_fails(tmp_path, monkeypatch):
    def fail(process, *_):
        started.append(process)
        raise OSError("nobody reads its output")

    started = []
    scene = load(str(write_scene(tmp_path, "mpi")))
    monkeypatch.setattr(mpi_job, "command", lambda *_: ["sleep", "60"])
    monkeypatch.setattr(mpi_job, "_await", fail)
    with pytest.raises(OSError, match="nobody reads"):
        mpi_job.run_under_mpi([], scene, tmp_path)
    assert started[0].returncode == -signal.SIGKILL


def test_signals_arrive_where_no_companion_can_be_started(monkeypatch):
    def fail():
        raise BlockingIOError("no more processes")

    monkeypatch.setattr(os, "fork", fail)
    with pytest.raises(BlockingIOError):
        Companion(lambda _: None)
    assert not signal.pthread_sigmask(signal.SIG_BLOCK, ()) & set(ENDING)


def test_a_run_that_cannot_be_written_down_is_ended(watched, monkeypatch):
    def fail(*_):
        raise OSError("no room for results")

    run = watched("import signal, time; signal.signal(3, signal.SIG_IGN); time.sleep(60)")
    process = WatchdogProcess.__new__(WatchdogProcess)
    process._run, process.report, process._shared = run.pid, fail, [0.0] * 4
    monkeypatch.setattr(os, "_exit", sys.exit)
    with pytest.raises(SystemExit):
        process._end(ComponentFailed("water", 1, "it hangs"))
    assert "signal 9 (SIGKILL)" in ending_within(run, 10.0) or "signal 3" in run.ending()
