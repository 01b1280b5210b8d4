"""Runs of other programs: how they end, and when a study takes over earlier runs."""

import os
import subprocess
import sys
import time

import pytest
from toy_peer import write_peer

from quintet.coupler.launch.processes import marked
from quintet.coupler.scene.read import load
from quintet.coupler.study.peers.beside import Beside
from quintet.coupler.study.peers.peer import read_peers
from quintet.coupler.study.peers.process import run_command
from quintet.coupler.study.study import status_of
from quintet.interfaces.lines.process_status import running


def test_a_study_whose_program_has_runs_left_was_interrupted(tmp_path):
    path = write_peer(tmp_path)
    beside = Beside(read_peers(["toy"], load(str(path))), tmp_path / "all", lambda: True, False)
    beside.turn(0, 1)
    summary = {"rows": [{"status": "done"}], "has_expectations": False} | beside.summary()
    assert summary["peers"][0]["runs"] == 3 and summary["peers"][0]["rows"] == []
    assert status_of({**summary, "recommended": None}, 1) == 130


@pytest.mark.parametrize(
    ("refinements", "turns"),
    [(3, [["late"], ["later"], ["latest"]]), (2, [["late", "later"], ["latest"]]),
     (5, [["late"], ["later"], [], ["latest"], []])],
)  # fmt: skip
def test_runs_of_a_program_are_spread_over_the_refinements(tmp_path, refinements, turns):
    beside = Beside(read_peers(["toy"], load(str(write_peer(tmp_path)))), tmp_path, bool, False)
    labels = []
    for number in range(refinements):
        row_count = len(beside.rows.get("toy", ()))
        beside.turn(number, refinements)
        labels.append([row["label"] for row in beside.rows["toy"][row_count:]])
    assert labels == turns


APART = "import os, time; os.setsid(); open('apart', 'w').close(); time.sleep(60)"
STARTER = f"""
import os, subprocess, sys, time
subprocess.Popen([sys.executable, "-c", {APART!r}])
while not os.path.exists("apart"):
    time.sleep(0.01)
time.sleep(60)
"""


def started(folder):
    """Processes of the command of this folder that run."""
    return [pid for pid in marked("PWD", str(folder)) if running(pid)]


def test_nothing_that_a_program_starts_survives_its_limit(tmp_path):
    def apart():
        return (tmp_path / "apart").exists() and len(started(tmp_path)) == 2

    arguments = [sys.executable, "-c", STARTER], tmp_path, tmp_path / "log", 30.0, apart, {}
    assert run_command(*arguments).status == "interrupted"
    assert not started(tmp_path)


def test_a_program_ends_with_the_killed_process_that_runs_it(tmp_path):
    place = str(tmp_path)
    code = (
        "import sys; from pathlib import Path\n"
        "from quintet.coupler.study.peers.process import run_command\n"
        f"folder, command = Path({place!r}), [sys.executable, '-c', {STARTER!r}]\n"
        "run_command(command, folder, folder / 'log', 60.0, lambda: False, {})"
    )
    process = subprocess.Popen([sys.executable, "-c", code])
    try:
        assert soon(lambda: (tmp_path / "apart").exists() and len(started(place)) == 2)
    finally:
        process.kill()
        process.wait()
    assert soon(lambda: not started(place))


def soon(condition):
    """Whether a condition holds within a time that is ample on a busy machine."""
    limit = time.monotonic() + 30.0
    while not condition() and time.monotonic() < limit:
        time.sleep(0.02)
    return condition()


@pytest.mark.parametrize(
    ("change", "is_kept"),
    [
        (("minutes = 1", "minutes = 2"), True),
        (("seconds (", "(?:time|seconds) ("), False),
        (('repeats = "clock"', 'repeats = "total"'), False),
        (("minutes = 1", 'minutes = 1\nenvironment = { LEVEL = "2" }'), False),
        (('file = "curve.txt"', 'file = "curve.txt"\nvalue = 0'), False),
    ],
)
def test_with_keep_a_run_that_would_be_read_differently_runs_again(tmp_path, change, is_kept):
    path = str(write_peer(tmp_path / "a"))
    (peer,) = read_peers(["toy"], load(path))
    row = peer.row(peer.runs[0], tmp_path, lambda: False, False)
    assert row["status"] == "done", row["cause"]
    place = peer.place(tmp_path, peer.runs[0]) / "peer.json"
    saved_time = place.stat().st_mtime_ns
    (changed_peer,) = read_peers(["toy"], load(str(write_peer(tmp_path / "b", change))))
    changed_peer.row(changed_peer.runs[0], tmp_path, lambda: False, True)
    assert (place.stat().st_mtime_ns == saved_time) == is_kept


def test_with_keep_a_program_that_was_installed_anew_runs_again(tmp_path, monkeypatch):
    program = tmp_path / "python-of-toy"
    program.write_text(f"#!/bin/sh\nexec {sys.executable} $*\n")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path), prepend=os.pathsep)
    path = write_peer(tmp_path / "a", ("@python@", program.name))
    (peer,) = read_peers(["toy"], load(str(path)))
    times = []
    for moment in (1.0, 1.0, 2.0):
        os.utime(program, (moment, moment))
        row = peer.row(peer.runs[0], tmp_path, lambda: False, True)
        assert row["status"] == "done", row["cause"]
        times.append((peer.place(tmp_path, peer.runs[0]) / "peer.json").stat().st_mtime_ns)
    assert times[0] == times[1] < times[2]
