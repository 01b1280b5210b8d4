"""Runs whose disk becomes full while they write, and the rules for their end."""

import json
import time

from small_disk import SizeLimit, SmallDisk
from started import Started, write_scene

from quintet.coupler.files.disk import RESERVE
from quintet.coupler.run.snapshots import snapshots

SNAPSHOTS = "output.snapshots=0.15"  # one snapshot, and then none for a while
WRITERS = {  # file, and the settings that make it grow
    "recording.h5": [SNAPSHOTS],
    "ledger.csv": [SNAPSHOTS, "output.record=false", "output.totals=0.001"],
    "pong.vtkhdf": [SNAPSHOTS, "output.record=false", "output.interval=0.001"],
    "snapshot-": ["output.snapshots=0.02", "output.record=false"],
}


def make_disk(kind, folder):
    """A small disk; a limit on sizes alone where this user may mount none."""
    disk = SmallDisk(folder) if kind == "disk" else SizeLimit(folder)
    if disk.allowed:
        return disk
    disk.close()
    return SizeLimit(folder)


def start(folder, disk, transport, name, end=0.4):
    """Start a run on the disk, slow enough to be overtaken; return it, its scene and settings."""
    toy = "items = 400\nseen = true\npause = 3e-3\ntalks = true"
    scene = write_scene(folder, transport, end, ping="items = 400", pong=toy)
    settings = [argument for setting in WRITERS.get(name, []) for argument in ("--set", setting)]
    return Started(scene, *settings, out=disk.place / "out", within=disk.within), scene, settings


def fill(run, disk, name):
    """Fill the disk once the file is there that will find no room; return the time."""
    folder = disk.seen(run.folder)
    path = run.wait_until(lambda: _growing(folder, name))
    filled_at = time.time()
    disk.fill(_process_of(run, folder), path)
    return filled_at


def _growing(folder, name):
    """The file that will find no room, as soon as it is clearly larger than the others."""
    if name == "snapshot-":
        return folder / snapshot_files[-1].name if (snapshot_files := snapshots(folder)) else None
    path = folder / name
    large = path.is_file() and path.stat().st_size > 1 << 14 and snapshots(folder)
    return path if large else None


def _process_of(run, folder):
    """Process of the coupler."""
    note = folder / "log" / "mpi.json"
    return json.loads(note.read_text())["coupler"] if note.is_file() else run.process.pid


def broken_rules(run, disk, name):
    """Rules that a run broke when it ended on a full disk."""
    folder = disk.seen(run.folder)
    messages = [line for line in run.err.splitlines() if line.startswith("quintet: ")] or [""]
    results = json.loads((folder / "results.json").read_text())
    fault = results.get("fault", {})
    rules = {
        "status 3": run.process.returncode == 3,
        "no process left": not run.processes(),
        "no shared memory left": not run.left_in_shared_memory(),
        "one sentence": len(messages) == 1 and "Traceback" not in run.err,
        "names the file": f"{disk.place}/out/{name}" in messages[0],
        "names the disk": "it cannot be written, as the disk at /" in messages[0],
        "says what to do": "Make room there." in messages[0],
        "results say failed": results["status"] == "failed",
        "culprit coupler": fault.get("component") == "coupler",
        "its cause in the results": messages[0].endswith(fault.get("cause", "?")),
        "how to go on": "--resume" in results.get("resume", ""),
        "nothing unfinished left": not (folder / RESERVE).exists()
        and not list(folder.rglob("*.part")),
    }
    return [rule for rule, holds in rules.items() if not holds]
