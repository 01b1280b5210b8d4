"""A component that hangs during its build or at its exit does not block the run for ever."""

import psutil
import pytest

ZENOH = pytest.param("zenoh", marks=pytest.mark.zenoh)
OVER = ["memory", ZENOH, pytest.param("mpi", marks=pytest.mark.mpi)]
LOADED = 60.0  # s, in which it ends on a loaded machine


def _hangs(faulty, cause, transport, patience):
    return faulty("Hanging", transport, f'fails_by = "{cause}"', top=f"patience = {patience}")


def check_build(run, activity, line):
    """The run failed, and named the component, the cause, the time and the place."""
    assert run.wait(LOADED) == 3, run.err
    fault = run.results["fault"]
    assert fault["component"] == "pong" and "to be built" in fault["cause"]
    assert f"is {activity}" in fault["cause"] and line in fault["cause"], fault["cause"]
    assert not run.left_processes() and not run.left_in_shared_memory()


@pytest.mark.parametrize("transport", OVER)
def test_a_build_that_does_nothing_ends_the_run_after_its_patience(faulty, transport):
    check_build(_hangs(faulty, "sleeps", transport, 2.0), "sleeping", "toy_waits.py")


@pytest.mark.parametrize("transport", ["memory", ZENOH])
def test_a_build_may_compute_for_thirty_times_its_patience(faulty, transport):
    check_build(_hangs(faulty, "computes", transport, 0.1), "computing", "toy_waits.py")


def test_over_memory_a_build_that_holds_the_lock_of_python_ends(faulty):
    check_build(_hangs(faulty, "locks", "memory", 2.0), "sleeping", "hold_the_lock")


def test_over_memory_a_thread_that_hangs_at_exit_keeps_the_status(faulty):
    run = _hangs(faulty, "thread at exit", "memory", 1.0)
    assert run.wait(LOADED) == 0 and run.results["status"] == "done"
    assert "its process did not end within 1 s" in run.err and not run.left_processes()


def test_over_memory_a_lock_that_is_held_at_exit_does_not_last(faulty):
    run = _hangs(faulty, "lock at exit", "memory", 1.0)
    assert run.wait(LOADED) in (0, 1) and run.results["status"] == "done"
    assert "hold_the_lock" in run.err and not run.left_processes()


def test_over_memory_processes_of_a_component_end_when_an_exception_ends_the_run(faulty, tmp_path):
    moment = tmp_path / "moment"
    pong = f'fails_at = 3\nfails_by = "exception"\nmoment = "{moment}"\nchild = true\norphan = true'
    run = faulty("Faulty", "memory", pong)
    assert run.wait(LOADED) == 3 and run.results["fault"]["component"] == "pong"
    assert not run.left_processes()
    processes = (
        process for process in psutil.process_iter() if process.status() != psutil.STATUS_ZOMBIE
    )
    assert not [
        process for process in processes if "time.sleep(601)" in " ".join(process.cmdline())
    ]
