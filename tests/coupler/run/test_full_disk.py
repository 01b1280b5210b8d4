"""A disk that is full ends a run in a sentence; with room again it goes on to the same bits."""

import json
import shutil
import subprocess
import sys
import time

import pytest
from small_disk import SizeLimit, SmallDisk
from started import Started, same, write_scene

from quintet.coupler.files.disk import RESERVE
from quintet.coupler.run.snapshots import snapshots

SOON = 5.0  # s, with what reading the results of a machine under load takes
SNAPSHOTS = "output.snapshots=0.15"  # one, and for a while none
WRITERS = {  # file, and what makes it grow
    "recording.h5": [SNAPSHOTS],
    "ledger.csv": [SNAPSHOTS, "output.record=false", "output.totals=0.001"],
    "pong.vtkhdf": [SNAPSHOTS, "output.record=false", "output.interval=0.001"],
    "snapshot-": ["output.snapshots=0.02", "output.record=false"],
}


@pytest.fixture
def disk(request, tmp_path):
    """A small disk; a limit on sizes alone where this user may mount none."""
    made = SmallDisk(tmp_path) if request.param == "disk" else SizeLimit(tmp_path)
    if not made.allowed:
        made.close()
        made = SizeLimit(tmp_path)
    yield made
    made.close()


def started(folder, disk, transport, settings, end=0.4):
    """A run on the disk, slow enough to be overtaken."""
    toy = "items = 400\nseen = true\npause = 3e-3\ntalks = true"
    scene = write_scene(folder, transport, end, ping="items = 400", pong=toy)
    chosen = [word for one in settings for word in ("--set", one)]
    return Started(scene, *chosen, out=disk.place / "out", within=disk.within), scene, chosen


def growing(folder, name):
    """The file that will find no room; once it is large enough to be told from the others."""
    if name == "snapshot-":
        return folder / found[-1].name if (found := snapshots(folder)) else None
    path = folder / name
    large = path.is_file() and path.stat().st_size > 1 << 14 and snapshots(folder)
    return path if large else None


def process_of(run, folder):
    """Process of the coupler."""
    note = folder / "log" / "mpi.json"
    return json.loads(note.read_text())["coupler"] if note.is_file() else run.process.pid


def check_full(run, folder, name, disk):
    """The run ends soon, says which file and disk, and leaves its results and no process."""
    began = time.monotonic()
    assert run.wait() == 3
    assert time.monotonic() - began < SOON
    assert not run.processes() and not run.left_in_shared_memory()
    said = [line for line in run.err.splitlines() if line.startswith("quintet: ")]
    assert len(said) == 1 and "Traceback" not in run.err, run.err
    assert f"{disk.place}/out/{name}" in said[0]
    assert "it cannot be written, as the disk at /" in said[0] and "Make room there." in said[0]
    found = json.loads((folder / "results.json").read_text())
    assert found["status"] == "failed" and found["fault"]["component"] == "coupler"
    assert said[0].endswith(found["fault"]["cause"]) and "--resume" in found["resume"]
    assert not (folder / RESERVE).exists() and not list(folder.rglob("*.part"))


def check_goes_on(scene, folder, disk, chosen, tmp_path):
    """The run goes on to the same bits as one that always had room."""
    command = [sys.executable, "-m", "quintet.coupler.cli", "run"]
    resumed = [*disk.within, *command, "--resume", str(disk.place / "out")]
    again = subprocess.run(resumed, capture_output=True, text=True)
    assert again.returncode == 0, again.stdout + again.stderr
    shutil.copytree(folder, tmp_path / "resumed")
    whole = [*command, str(scene), "--transport", "memory", "--out", str(tmp_path / "whole")]
    subprocess.run([*whole, *chosen], check=True, capture_output=True)
    assert same(tmp_path / "whole", tmp_path / "resumed")


def full_and_on(tmp_path, disk, name, transport):
    run, scene, chosen = started(tmp_path, disk, transport, WRITERS[name])
    folder = disk.seen(run.folder)
    path = run.wait_until(lambda: growing(folder, name))
    disk.fill(process_of(run, folder), path)
    check_full(run, folder, name, disk)
    disk.empty()
    check_goes_on(scene, folder, disk, chosen, tmp_path)


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
    if (kind, name, transport) not in [one.values for one in BY_DEFAULT]
]


@pytest.mark.parametrize(("disk", "name", "transport"), [*BY_DEFAULT, *OTHERS], indirect=["disk"])
def test_a_run_on_a_full_disk_ends_and_goes_on_when_there_is_room(tmp_path, disk, name, transport):
    run, scene, chosen = started(tmp_path, disk, transport, WRITERS[name])
    folder = disk.seen(run.folder)
    path = run.wait_until(lambda: growing(folder, name))
    disk.fill(process_of(run, folder), path)
    check_full(run, folder, name, disk)
    disk.empty()
    check_goes_on(scene, folder, disk, chosen, tmp_path)


@pytest.mark.parametrize("disk", ["disk"], indirect=True)
def test_nothing_starts_on_a_disk_that_is_full(tmp_path, disk):
    if not disk.allowed:
        return
    disk.fill()
    run, _, _ = started(tmp_path, disk, "memory", [])
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
    found = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert found.returncode == 0, found.stderr
    lines = found.stdout.splitlines()
    assert [line.partition(":")[0] for line in lines] == ["recording.h5", "views.vtkhdf"]
    assert all("allows no file so large" in line for line in lines)
