"""A disk that is full ends a run in a sentence; with room again it goes on to the same bits."""

import errno
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest
from full_disk import WRITERS, broken_rules, fill, make_disk, start
from started import same

from quintet.coupler.launch.mpi_job import JOB_FILE, _read, _write

SOON = 5.0  # s, including reading the results on a loaded machine


@pytest.fixture
def disk(request, tmp_path):
    """A small disk, or a limit on sizes."""
    small_disk = make_disk(request.param, tmp_path)
    yield small_disk
    small_disk.close()


def check_goes_on(scene, folder, disk, settings, tmp_path):
    """The run goes on to the same bits as one that always had room."""
    command = [sys.executable, "-m", "quintet.coupler.cli", "run"]
    resume_command = [*disk.within, *command, "--resume", str(disk.place / "out")]
    result = subprocess.run(resume_command, capture_output=True, text=True)
    assert result.returncode == 0, result.stdout + result.stderr
    shutil.copytree(folder, tmp_path / "resumed")
    whole_command = [
        *command,
        str(scene),
        "--transport",
        "memory",
        "--out",
        str(tmp_path / "whole"),
    ]
    subprocess.run([*whole_command, *settings], check=True, capture_output=True)
    assert same(tmp_path / "whole", tmp_path / "resumed")


FULL = pytest.mark.full
ZENOH, MPI = pytest.mark.zenoh, pytest.mark.mpi
BY_DEFAULT = [  # each writer and each transport once
    pytest.param("disk", "recording.h5", "zenoh", marks=ZENOH),
    pytest.param("disk", "ledger.csv", "memory"),
    pytest.param("disk", "pong.vtkhdf", "memory"),
    pytest.param("disk", "snapshot-", "mpi", marks=MPI),
    pytest.param("limit", "recording.h5", "memory"),
]
OTHERS = [
    pytest.param(kind, name, transport, marks=[FULL, *marks])
    for kind in ("disk", "limit")
    for name in WRITERS
    for transport, *marks in (("memory",), ("zenoh", ZENOH), ("mpi", MPI))
    if (kind, name, transport) not in [parameters.values for parameters in BY_DEFAULT]
]


@pytest.mark.parametrize(("disk", "name", "transport"), [*BY_DEFAULT, *OTHERS], indirect=["disk"])
def test_a_run_on_a_full_disk_ends_and_goes_on_when_there_is_room(tmp_path, disk, name, transport):
    run, scene, settings = start(tmp_path, disk, transport, name)
    fill(run, disk, name)
    start_time = time.monotonic()
    run.wait()
    assert time.monotonic() - start_time < SOON
    assert broken_rules(run, disk, name) == [], run.err
    disk.empty()
    check_goes_on(scene, disk.seen(run.folder), disk, settings, tmp_path)


@pytest.mark.parametrize("disk", ["disk"], indirect=True)
def test_nothing_starts_on_a_disk_that_is_full(tmp_path, disk):
    if not disk.allowed:
        return
    disk.fill()
    run, _, _ = start(tmp_path, disk, "memory", "")
    assert run.wait() == 2
    assert run.err.count("quintet: ") == 1 and "Traceback" not in run.err
    assert f"as the disk at {disk.place} is full (0.0 of " in run.err
    assert not disk.seen(run.folder).exists()


WITHOUT_ROOM_MADE_SURE_OF = """
import os, pathlib, resource, sys
import numpy as np
from quintet.coupler.files.recording import Instant, Recorder
from quintet.coupler.files.vtkhdf import VtkHdf
from quintet.interfaces.errors import DiskError
from quintet.interfaces.ports import SURFACE_LOAD
os.posix_fallocate = lambda *_: None
recorder, views = Recorder("recording.h5", "", ""), VtkHdf("views.vtkhdf")
recorder.component("water", (SURFACE_LOAD,), {})
resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 19, resource.RLIM_INFINITY))
random, failed = np.random.default_rng(1), 0
for k in range(100):
    field = random.random((5000, 3))
    try:
        recorder.add("water", Instant(0.1 * k, k), {"surface_load.force": field})
    except DiskError as error:
        print(error)
        break
for k in range(100):
    try:
        views.append(0.1 * k, {"points": random.random((5000, 3))})
    except DiskError as error:
        print(error)
        break
recorder.close()
views.close()
"""


def test_files_of_hdf5_whose_writing_fails_end_no_process(tmp_path):
    command = [sys.executable, "-c", WITHOUT_ROOM_MADE_SURE_OF]
    result = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    lines = result.stdout.splitlines()
    assert [line.partition(":")[0] for line in lines] == ["recording.h5", "views.vtkhdf"]
    assert all("allows no file so large" in line for line in lines)


def test_the_end_of_an_mpi_job_is_noted_on_a_full_disk(tmp_path, monkeypatch):
    (tmp_path / "log").mkdir()
    _write(tmp_path, {"coupler": 7, "status": 0, "launcher": ["a long name"]})

    def no_room(path, text):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "write_text", no_room)
    _write(tmp_path, {"coupler": 7, "status": 3})
    assert _read(tmp_path / "log" / JOB_FILE) == {"coupler": 7, "status": 3}
    assert [path.name for path in (tmp_path / "log").iterdir()] == [JOB_FILE]
