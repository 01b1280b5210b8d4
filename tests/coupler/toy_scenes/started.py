"""Runs of toy scenes in processes of their own, and the processes and files they leave behind."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

from shared_memory import SharedFiles

from quintet.coupler.files import vtkhdf_reader
from quintet.coupler.report.diff import compare

MARK = "QUINTET_TEST_RUN"
TOYS = Path(__file__).with_name("toys.py")
SCENE = """
name = "toy"
end = {end}
window = 1e-3
transport = "{transport}"
[components.ping]
kind = "toys:Toy"
{ping}
[components.pong]
kind = "toys:Toy"
{pong}
[[links]]
kind = "direct"
pairs = [["ping.out", "pong.in"], ["pong.out", "ping.in"]]
"""


def write_scene(folder, transport="memory", end=1.0, ping="", pong=""):
    """Two toys that exchange numbers; `end` counts seconds of 1000 windows."""
    shutil.copy(TOYS, folder / "toys.py")
    path = folder / "scene.toml"
    path.write_text(SCENE.format(transport=transport, end=end, ping=ping, pong=pong))
    return path


def same(folder_a, folder_b):
    """Whether two runs wrote the same results, except for clock times."""
    assert (folder_a / "recording.h5").exists() == (folder_b / "recording.h5").exists()
    assert not (folder_a / "recording.h5").exists() or compare(folder_a, folder_b) is None
    assert (folder_a / "ledger.csv").read_bytes() == (folder_b / "ledger.csv").read_bytes()
    results = [json.loads((folder / "results.json").read_text()) for folder in (folder_a, folder_b)]
    for key in ("status", "windows", "time", "expect", "ledger"):
        assert results[0][key] == results[1][key], key
    for path in folder_a.glob("*.vtkhdf"):
        times = vtkhdf_reader.times(path)
        assert list(times) == list(vtkhdf_reader.times(folder_b / path.name))
        for k in range(len(times)):
            views = [vtkhdf_reader.read_step(run / path.name, k)[1] for run in (folder_a, folder_b)]
            assert all((views[0][key] == views[1][key]).all() for key in views[0])
    return True


class Started:
    """``quintet run`` of a scene, as a user starts it, in a session of its own."""

    def __init__(self, scene, *arguments, out=None, within=(), resumes=False):
        self.scene, self.folder = scene, out or scene.parent / "out"
        self.mark = f"{MARK}={scene.parent}"
        start = [*self.command(scene), "--out"]
        if resumes:
            start = [sys.executable, "-m", "quintet.coupler.cli", "run", "--resume"]
        command = [*within, *start, str(self.folder), *arguments]
        self.process = subprocess.Popen(
            command,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
            env={**os.environ, MARK: str(scene.parent)},
        )
        self.shared = SharedFiles(self.processes, lambda: self.process.poll() is not None)
        self.out = self.err = ""

    @staticmethod
    def command(scene):
        """The command that a user types."""
        return [sys.executable, "-m", "quintet.coupler.cli", "run", str(scene)]

    def wait(self, seconds=60.0):
        """Wait for its end; return the exit status."""
        try:
            self.out, self.err = self.process.communicate(timeout=seconds)
        finally:
            self.end()
        return self.process.returncode

    def end(self):
        """Kill the processes of the run that still run."""
        for pid in self.processes():
            os.kill(pid, signal.SIGKILL)

    def processes(self):
        """Processes of this run: they all inherit the mark."""
        pids = []
        for entry in Path("/proc").iterdir():
            if entry.name.isdigit() and self._is_mine(entry):
                pids.append(int(entry.name))
        return pids

    def left_processes(self, seconds=2.0):
        """Processes that the run has left; its companion process may end a little after the run."""
        limit = time.monotonic() + seconds
        while (pids := self.processes()) and time.monotonic() < limit:
            time.sleep(0.01)
        return pids

    def _is_mine(self, entry):
        try:
            marked = self.mark.encode() in (entry / "environ").read_bytes().split(b"\0")
            return marked and (entry / "stat").read_text().rpartition(")")[2].split()[0] != "Z"
        except OSError:
            return False

    def wait_until(self, condition, seconds=30.0):
        """Wait until a condition of the run holds; return its value."""
        limit = time.monotonic() + seconds
        while not (result := condition()):
            assert time.monotonic() < limit, "it did not come to that"
            time.sleep(0.005)
        return result

    def wait_for_windows(self):
        """Wait until a component has stepped for a while; return nothing."""
        steps = self.folder / "log" / "pong.log"
        self.wait_until(lambda: steps.is_file() and "step 50" in steps.read_text())

    def pid_of(self, name):
        """Process of a component, from its log."""
        text = (self.folder / "log" / f"{name}.log").read_text()
        return int(re.search(r"process (\d+)", text)[1])

    def left_in_shared_memory(self, seconds=3.0):
        """Files of this run that no process uses any more, nor will soon delete."""
        return self.shared.left(seconds)

    @property
    def results(self):
        """Its results.json."""
        return json.loads((self.folder / "results.json").read_text())
