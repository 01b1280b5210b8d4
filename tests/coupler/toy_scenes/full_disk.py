"""Runs whose disk becomes full while they write, and what they must do then."""

import json
import time

from small_disk import SizeLimit, SmallDisk
from started import Started, write_scene

from quintet.coupler.files.disk import RESERVE
from quintet.coupler.run.snapshots import snapshots

SNAPSHOTS = "output.snapshots=0.15"  # one, and for a while none
WRITERS = {  # file, and what makes it grow
    "recording.h5": [SNAPSHOTS],
    "ledger.csv": [SNAPSHOTS, "output.record=false", "output.totals=0.001"],
    "pong.vtkhdf": [SNAPSHOTS, "output.record=false", "output.interval=0.001"],
    "snapshot-": ["output.snapshots=0.02", "output.record=false"],
}


def make_disk(kind, folder):
    """A small disk; a limit on sizes alone where this user may mount none."""
    made = SmallDisk(folder) if kind == "disk" else SizeLimit(folder)
    if made.allowed:
        return made
    made.close()
    return SizeLimit(folder)


def start(folder, disk, transport, name, end=0.4):
    """Start a run on the disk, slow enough to be overtaken; return it, its scene and settings."""
    toy = "items = 400\nseen = true\npause = 3e-3\ntalks = true"
    scene = write_scene(folder, transport, end, ping="items = 400", pong=toy)
    chosen = [word for one in WRITERS.get(name, []) for word in ("--set", one)]
    return Started(scene, *chosen, out=disk.place / "out", within=disk.within), scene, chosen


def fill(run, disk, name):
    """Fill the disk once the file is there that will find no room; return the time."""
    folder = disk.seen(run.folder)
    path = run.wait_until(lambda: _growing(folder, name))
    at = time.time()
    disk.fill(_process_of(run, folder), path)
    return at


def _growing(folder, name):
    """The file that will find no room; once it is large enough to be told from the others."""
    if name == "snapshot-":
        return folder / found[-1].name if (found := snapshots(folder)) else None
    path = folder / name
    large = path.is_file() and path.stat().st_size > 1 << 14 and snapshots(folder)
    return path if large else None


def _process_of(run, folder):
    """Process of the coupler."""
    note = folder / "log" / "mpi.json"
    return json.loads(note.read_text())["coupler"] if note.is_file() else run.process.pid


def broken_rules(run, disk, name):
    """What a run that has ended on a full disk should have done, and has not."""
    folder = disk.seen(run.folder)
    said = [line for line in run.err.splitlines() if line.startswith("quintet: ")] or [""]
    found = json.loads((folder / "results.json").read_text())
    fault = found.get("fault", {})
    rules = {
        "status 3": run.process.returncode == 3,
        "no process left": not run.processes(),
        "no shared memory left": not run.left_in_shared_memory(),
        "one sentence": len(said) == 1 and "Traceback" not in run.err,
        "names the file": f"{disk.place}/out/{name}" in said[0],
        "names the disk": "it cannot be written, as the disk at /" in said[0],
        "says what to do": "Make room there." in said[0],
        "results say failed": found["status"] == "failed",
        "culprit coupler": fault.get("component") == "coupler",
        "its cause in the results": said[0].endswith(fault.get("cause", "?")),
        "how to go on": "--resume" in found.get("resume", ""),
        "nothing unfinished left": not (folder / RESERVE).exists()
        and not list(folder.rglob("*.part")),
    }
    return [rule for rule, holds in rules.items() if not holds]
