"""Signs of life come while a solver holds the interpreter's lock, and end where it stands still."""

import os
import signal
import subprocess
import sys
import time

import pytest

from quintet.interfaces.errors import LineError
from quintet.interfaces.lines.endpoint import free_port, on_loopback
from quintet.interfaces.lines.signs import SILENCE, SignsOfLife
from quintet.interfaces.lines.zenoh import REPLACED, Session, ZenohLine, configuration

pytestmark = pytest.mark.zenoh
GIVER = f"""
import ctypes, sys, time
from quintet.interfaces.lines.signs import Signs
endpoint, root, name = sys.argv[1:]
signs = Signs(endpoint, None, root, name)
print("given", flush=True)
if name == "computes":
    ctypes.PyDLL(None).sleep({2 * SILENCE:.0f})  # holds the lock
time.sleep(60.0)
"""


@pytest.fixture
def giver():
    """Start a process that gives signs of life."""
    started = []

    def start(*arguments):
        command = [sys.executable, "-c", GIVER, *arguments]
        started.append(subprocess.Popen(command, stdout=subprocess.PIPE, text=True))
        return started[-1]

    yield start
    for process in started:
        process.kill()
        process.communicate()


def wait_until(true, seconds):
    limit = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < limit
        time.sleep(0.02)


def test_silence_is_noticed_and_a_held_lock_is_none(giver):
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    session = Session(endpoint, True, "coupler", None, "5ecret")
    signs = {name: SignsOfLife(session, name) for name in ("computes", "stands")}
    processes = {name: giver(endpoint, session.root, name) for name in signs}
    assert [process.stdout.readline() for process in processes.values()] == ["given\n"] * 2
    # A process that is stopped before its first sign would never count as silent.
    every_sign = f"{session.root}/alive/$*~sign"
    wait_until(lambda: len(list(session.zenoh.liveliness().get(every_sign))) == 2, 5.0)
    assert all(sign.silent_for() == 0.0 for sign in signs.values())
    os.kill(processes["stands"].pid, signal.SIGSTOP)
    wait_until(lambda: signs["stands"].silent_for(), SILENCE + 3.0)
    assert SILENCE <= signs["stands"].silent_for() < SILENCE + 0.5
    assert signs["computes"].silent_for() == 0.0
    os.kill(processes["stands"].pid, signal.SIGCONT)
    wait_until(lambda: signs["stands"].silent_for() == 0.0, 5.0)
    session.close()


def test_who_was_replaced_is_told():
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    coupler = Session(endpoint, True, "coupler", None, "5ecret")
    pong = Session(endpoint, False, "pong", None, "5ecret")
    lines = ZenohLine(coupler, "run", "pong"), ZenohLine(pong, "run", "coupler")
    for line in lines:
        line.wait_for_partner(5.0)
    lines[0].leave()
    wait_until(lines[1].partner_has_left, 5.0)
    assert REPLACED in pong.alive
    with pytest.raises(LineError, match="the run has given up this process"):
        lines[1].receive(5.0)
    pong.close()
    coupler.close()


def test_over_tls_a_message_that_is_held_up_goes_on_soon(certificates):
    settings = configuration("tls/localhost:7447", True, certificates[0])
    lease, count = (
        int(settings.get_json(f"transport/link/tx/{key}")) for key in ("lease", "keep_alive")
    )
    assert lease / count <= 100.0  # ms


def test_the_loopback_is_one_host():
    assert on_loopback("tcp/127.0.0.1:7447") and on_loopback("tls/localhost:7447")
    assert not on_loopback("tls/10.0.0.1:7447")
