"""Signals end every run, whatever a component does."""

import os
import signal
import time

import pytest

HANGS = ("deadlock", "endless loop", "compiled loop", "polling loop")
AT_ONCE = 2.0  # s
LOADED = 3.0  # s that a loaded machine may add
SHORT = [("deadlock", "zenoh", "SIGINT"), ("endless loop", "mpi", "SIGTERM")]
ALL = [
    (cause, transport, signal_name)
    for cause in HANGS
    for transport in ("zenoh", "mpi")
    for signal_name in ("SIGINT", "SIGTERM")
]


def hanging(start, folder, transport, cause):
    """A run with a component that hangs."""
    moment = folder / "moment"
    pong = f'fails_at = 60\nfails_by = "{cause}"\nmoment = "{moment}"'
    run = start("Faulty", transport, pong, end=100.0)
    run.wait_until(moment.is_file, 60.0)
    time.sleep(0.2)
    return run


def end(run, *signal_names):
    """Send signals to a run one after the other; return the time until it ended [s]."""
    start = time.monotonic()
    for signal_name in signal_names:
        os.kill(run.process.pid, getattr(signal, signal_name))
        time.sleep(0.2)
    run.out, run.err = run.process.communicate(timeout=20)
    seconds = time.monotonic() - start
    print(f"ended after {seconds:.2f} s")
    assert run.process.returncode == 130
    assert run.results["status"] == "interrupted" and run.results["windows"] == 60
    assert "fault" not in run.results
    assert f"{signal_names[0]}: ending after this window" in run.err
    assert not run.left_processes() and not run.left_in_shared_memory()
    return seconds


@pytest.mark.parametrize(("cause", "transport", "signal_name"), SHORT)
def test_one_signal_ends_a_run_that_hangs(faulty, tmp_path, cause, transport, signal_name):
    assert end(hanging(faulty, tmp_path, transport, cause), signal_name) < AT_ONCE + LOADED


@pytest.mark.full
@pytest.mark.parametrize(("cause", "transport", "signal_name"), ALL)
def test_it_does_so_in_time(faulty, tmp_path, cause, transport, signal_name):
    assert end(hanging(faulty, tmp_path, transport, cause), signal_name) < AT_ONCE


def test_over_memory_one_signal_interrupts_python(faulty, tmp_path):
    assert end(hanging(faulty, tmp_path, "memory", "polling loop"), "SIGTERM") < AT_ONCE + LOADED


def test_over_memory_two_signals_end_what_holds_the_lock_of_python(faulty, tmp_path):
    run = hanging(faulty, tmp_path, "memory", "deadlock")
    start = time.monotonic()
    for _ in range(2):
        os.kill(run.process.pid, signal.SIGINT)
        time.sleep(0.2)
    run.out, run.err = run.process.communicate(timeout=20)
    assert time.monotonic() - start < AT_ONCE + LOADED
    assert run.process.returncode == 3 and run.results["status"] == "failed"
    assert run.results["windows"] == run.results["fault"]["window"] == 60
    assert run.results["fault"]["component"] == "pong"
    assert "kept the interpreter's lock when asked to end" in run.err
    assert not run.processes()


@pytest.mark.parametrize("cause", ["os._exit", "SIGKILL"])
def test_over_memory_a_death_without_a_word_is_written_down(faulty, tmp_path, cause):
    moment = tmp_path / "moment"
    pong = f'fails_at = 60\nfails_by = "{cause}"\nmoment = "{moment}"'
    run = faulty("Faulty", "memory", pong, top="output.snapshots = 0.02", end=100.0)
    assert run.wait() == (3 if cause == "os._exit" else -signal.SIGKILL)
    assert run.results["status"] == "failed" and "--resume" in run.results["resume"]
    assert (run.results["fault"]["component"], run.results["fault"]["window"]) == ("pong", 60)
    assert "pong failed in window 60: process" in run.err
    assert "is gone: it ended or was killed" in run.err


def test_over_memory_two_signals_end_compiled_code(faulty, tmp_path):
    run = hanging(faulty, tmp_path, "memory", "compiled loop")
    assert end(run, "SIGINT", "SIGINT") < AT_ONCE + LOADED
