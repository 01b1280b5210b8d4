"""Disks that become full while a file of a run grows, over each transport."""

from full_disk import broken_rules, fill, make_disk, start
from outcomes import Reader

TRANSPORTS = ("memory", "zenoh", "mpi")
WRITTEN = {  # on a full disk: the file that finds no room
    "recording": "recording.h5",
    "ledger": "ledger.csv",
    "snapshot": "snapshot-",
    "view": "pong.vtkhdf",
}


def full_disk(file_kind, transport, folder):
    """Run a scene whose disk becomes full; return the rules it broke, the time, and the cause."""
    disk = make_disk("disk", folder)
    try:
        run, _, _ = start(folder, disk, transport, WRITTEN[file_kind])
        reader = Reader(run)
        filled_at = fill(run, disk, WRITTEN[file_kind])
        _, end_time, _ = reader.wait(60.0)
        run.err = "".join(line for _, line in reader.lines)
        broken = broken_rules(run, disk, WRITTEN[file_kind])
        reported_at = reader.first("it cannot be written") or end_time
        cause = next((line for _, line in reader.lines if "it cannot be written" in line), "")
        cause = cause.removeprefix("quintet: coupler failed in ").strip().partition(": ")[2]
        return broken, reported_at - filled_at, cause
    finally:
        disk.close()
