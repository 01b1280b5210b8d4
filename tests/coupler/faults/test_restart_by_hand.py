"""A component that was joined by hand and died is awaited again, under the same name."""

import os
import signal
import subprocess
import sys

import pytest
from started import Started, same, write_scene

from quintet.interfaces.lines.endpoint import free_port

pytestmark = pytest.mark.zenoh


class ByHand:
    """A run whose second component is joined by hand."""

    def __init__(self, folder, *arguments):
        port = free_port()
        scene = write_scene(folder, "zenoh", 0.1, ping="pause = 5e-3")
        endpoint = f"tcp/127.0.0.1:{port}"
        self.command = [sys.executable, "-m", "quintet.coupler.cli", "join", str(scene), "pong"]
        self.command += ["--at", endpoint]
        self.log = folder / "joined.log"
        self.joined = []
        settings = ("--set", f'endpoint="{endpoint}"', *arguments)
        self.run = Started(scene, "--elsewhere", "pong", *settings)
        self.scene = scene

    def join(self):
        """Join by the command on the screen."""
        with open(self.log, "ab") as file:
            self.joined.append(subprocess.Popen(self.command, stdout=file, stderr=file))
        return self.joined[-1]

    def wait_for_step(self, count):
        """Wait until the component has stepped for a while, the so-manieth time."""
        self.run.wait_until(lambda: self.log.read_text().count("step 50") == count, 60.0)

    def end(self):
        """End all processes that still run."""
        for process in self.joined:
            process.kill()
            process.wait()
        self.run.end()
        self.run.process.communicate()


@pytest.fixture
def by_hand(tmp_path):
    started = []

    def start(*arguments):
        started.append(ByHand(tmp_path, *arguments))
        return started[-1]

    yield start
    for run in started:
        run.end()


def test_who_joined_by_hand_and_died_may_join_again(by_hand):
    scene = by_hand("--set", "restarts=1")
    first = scene.join()
    scene.wait_for_step(1)
    os.kill(first.pid, signal.SIGKILL)
    replacement = scene.join()
    assert scene.run.wait() == 0, scene.run.err
    assert replacement.wait(10.0) == 0
    assert scene.run.out.count("pong is awaited: quintet join") == 2
    (note,) = scene.run.results["notes"]["pong"]
    assert "took over after" in note
    reference = Started(scene.scene, out=scene.scene.parent / "alone")
    assert reference.wait() == 0
    assert same(scene.run.folder, reference.folder)


def test_who_joined_by_hand_and_stands_still_is_replaced(by_hand):
    scene = by_hand("--set", "restarts=1")
    first = scene.join()
    scene.wait_for_step(1)
    os.kill(first.pid, signal.SIGSTOP)
    assert first.wait(20.0) == -signal.SIGKILL
    replacement = scene.join()
    assert scene.run.wait() == 0, scene.run.err
    assert replacement.wait(10.0) == 0
    assert "pong stopped responding: process" in scene.run.err
    assert "it is awaited again (restart 1 of 1)" in scene.run.err
    reference = Started(scene.scene, out=scene.scene.parent / "alone")
    assert reference.wait() == 0
    assert same(scene.run.folder, reference.folder)


def test_who_does_not_join_again_within_the_patience_ends_the_run(by_hand):
    scene = by_hand("--set", "restarts=1", "--set", "patience=2.0")
    first = scene.join()
    scene.wait_for_step(1)
    os.kill(first.pid, signal.SIGKILL)
    assert scene.run.wait() == 3
    fault = scene.run.results["fault"]
    assert fault["component"] == "pong"
    assert "no other process took over: nothing arrived within 2.0 s" in fault["cause"]
