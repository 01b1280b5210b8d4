"""A component with long windows is not taken for one that hangs, over any transport."""

import re

import pytest

OVER = [
    "memory",
    pytest.param("zenoh", marks=pytest.mark.zenoh),
    pytest.param("mpi", marks=pytest.mark.mpi),
]
NAMED = re.compile(r"pong keeps the others waiting for .* in window (\d+)")


def check_windows(run, windows, named):
    """The run came to its end; the screen named the component in these windows alone."""
    assert run.wait(600.0) == 0, run.err
    assert (run.results["status"], run.results["windows"]) == ("done", windows)
    assert set(map(int, NAMED.findall(run.err))) == named, run.err
    assert "stopped responding" not in run.err and "Traceback" not in run.err
    assert not run.left_processes() and not run.left_in_shared_memory()


def slow(faulty, transport, seconds, computes, windows):
    """A run with the default patience, of windows of so many seconds each."""
    pong = f"seconds = {seconds}\ncomputes = {str(computes).lower()}"
    return faulty("Slow", transport, pong, end=1e-3 * windows)


@pytest.mark.full
@pytest.mark.parametrize("computes", [False, True], ids=["sleeps", "computes"])
@pytest.mark.parametrize("transport", OVER)
def test_windows_of_nine_seconds_and_one_of_forty_are_no_fault(faulty, transport, computes):
    # The first window, without a known usual time, and the one above 3 x 9 + 5 s are named.
    run = slow(faulty, transport, [9.0, 9.0, 9.0, 40.0, 9.0], computes, 5)
    check_windows(run, 5, {0, 3})


@pytest.mark.full
@pytest.mark.parametrize("computes", [False, True], ids=["sleeps", "computes"])
@pytest.mark.parametrize("transport", OVER)
def test_windows_of_forty_seconds_are_no_fault(faulty, transport, computes):
    run = slow(faulty, transport, [40.0], computes, 3)
    check_windows(run, 3, {0})


def test_windows_of_a_second_are_not_named(faulty):
    check_windows(slow(faulty, "memory", [1.0], False, 2), 2, set())
