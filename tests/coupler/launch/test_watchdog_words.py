"""The messages on the screen about a component that takes long."""

import os
import sys
import time

import pytest

from quintet.coupler.coupling.participant import Participant
from quintet.coupler.launch.process_probe import ProcessProbe
from quintet.coupler.launch.stack import compiles
from quintet.coupler.launch.watchdog import Watchdog, Watched
from quintet.coupler.run.signals import StopRequest
from quintet.interfaces.lines.memory import MemoryLine

SOLVER = '  File "/x/water/component.py", line 12 in step'
COMPILING = "\n".join(
    [
        '  File "/usr/lib/python3/copy.py", line 9 in deepcopy',
        '  File "/x/numba/core/ir.py", line 1 in copy',
        SOLVER,
    ]
)


@pytest.fixture
def screen_of(capsys):
    def wait(names, calls):
        """The text printed while the first component keeps the coupler waiting."""
        watchdog = Watchdog(StopRequest(), in_main_thread=True, alone=len(names) == 1)
        for name in names:
            probe = ProcessProbe(name, os.getpid(), where=lambda: calls)
            participant = Participant(name, MemoryLine("", name))
            watchdog.add(participant, probe, 60.0)
            participant.built = True
            if name == names[0]:
                participant.keeping_others_waiting.since = time.monotonic()
        (component,) = (c for c in watchdog._all.values() if c.participant.name == names[0])
        limit = time.monotonic() + 5.0
        while not component.since and time.monotonic() < limit:
            time.sleep(0.01)
        component.tell_at = 0.0
        while not component.reported and time.monotonic() < limit:
            time.sleep(0.01)
        watchdog.close()
        return capsys.readouterr().err

    return wait


def test_of_kernels_that_compile_no_call_of_the_compiler_is_shown(screen_of):
    message = screen_of(["water"], COMPILING)
    assert "quintet: water has taken " in message
    assert "File" not in message and "waiting" not in message, "nobody else waits"


def test_who_computes_is_shown_with_its_place_and_the_others_that_wait(screen_of):
    message = screen_of(["water", "cubes"], SOLVER)
    assert "quintet: water keeps the others waiting for " in message and SOLVER in message


def test_over_memory_it_looks_without_long_waits_for_the_lock_of_python():
    interval, intervals = sys.getswitchinterval(), []
    watchdog = Watchdog(StopRequest(), in_main_thread=True)
    participant = Participant("water", MemoryLine("", "water"))
    participant.keeping_others_waiting.since = time.monotonic()

    class Probe(ProcessProbe):
        def read(self):
            intervals.append(sys.getswitchinterval())

    watchdog.check_wait(Watched(participant, Probe("water", os.getpid()), 60.0), 0.1)
    assert intervals and max(intervals) < 0.2 * interval
    assert sys.getswitchinterval() == interval


def test_building_a_program_of_a_device_is_compiling_and_copying_is_not():
    calls = '  File "/x/pyopencl/__init__.py", line {} in {}\n' + SOLVER
    assert compiles(COMPILING)
    assert compiles(calls.format(9, "build"))
    assert compiles(calls.format(9, "_build_and_catch_errors"))
    assert not compiles(calls.format(9, "enqueue_copy"))
    assert not compiles(SOLVER)
