"""Every fault over every transport: what a run then does, as a table.

``python tests/coupler/faults/fault_matrix.py`` tries all of them and writes the table into
coupler/README.md. The tests hold each to the same rules.
"""

import shutil
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
TOYS = ROOT / "tests/coupler/toy_scenes"
if __name__ == "__main__":
    sys.path.insert(0, str(TOYS))

from full_disk import broken_rules, fill, make_disk, start  # noqa: E402
from outcomes import ENDED, SOON, TOLD, Outcome, Reader, shortened  # noqa: E402
from rank_faults import rank_rows  # noqa: E402
from started import Started, write_scene  # noqa: E402

TABLE = ROOT / "coupler/README.md"
BEGIN, END = "<!-- faults -->", "<!-- end of faults -->"
TRANSPORTS = ("memory", "zenoh", "mpi")
AT = 60  # window in which it fails
EARLIER = 0.2  # s, of its window before the fault, in which it is waited for too


@dataclass(frozen=True)
class Fault:
    """One way to fail.

    `kind` is what becomes of the process: it says so itself, it is dead, stopped, or it hangs.
    """

    name: str
    kind: str
    cause: str
    transports: tuple[str, ...] = TRANSPORTS


PROCESSES = ("zenoh", "mpi")
HANGS = "stopped responding: kept the others waiting for"
FAULTS = [
    Fault("exception", "said", "ArithmeticError: asked to raise"),
    Fault("sys.exit", "said", "SystemExit: asked Python to exit, with status 0"),
    Fault("os._exit", "dead", "ended by itself with status 0", PROCESSES),
    Fault("SIGKILL", "dead", "was killed by signal 9 (SIGKILL)", PROCESSES),
    Fault("SIGSEGV", "dead", "was killed by signal 11 (SIGSEGV): its compiled code", PROCESSES),
    Fault("SIGSTOP", "stopped", "stopped responding: process", PROCESSES),
    Fault("deadlock", "hangs", HANGS),
    Fault("endless loop", "hangs", HANGS),
    Fault("compiled loop", "hangs", HANGS),
    Fault("polling loop", "hangs", HANGS),
    Fault("NaN", "said", "every number of out.number must be finite; item 0 is [nan nan nan]"),
    Fault("wrong shape", "said", "output out.number must keep its shape (5, 3); found (2, 3)"),
    Fault("impulse of wrong shape", "said", "output out.push must keep its shape (5, 3); found (1"),
    Fault("complex", "said", "output out.number must be an array of real numbers; found complex"),
    Fault("None", "said", "output out.push must be an array of real numbers; found NoneType"),
    Fault("huge", "said", "output out.number must keep its shape (5, 3); found (250000000, 3)"),
    Fault("out of memory", "said", "MemoryError: "),
]
CASES = [(one, transport) for one in FAULTS for transport in one.transports]
WRITTEN = {  # on a full disk: what finds no room
    "recording": "recording.h5",
    "ledger": "ledger.csv",
    "snapshot": "snapshot-",
    "view": "pong.vtkhdf",
}


def fail(fault, transport, folder, patience):
    """Run a scene of two components, one of which fails."""
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copy(TOYS / "toy_faults.py", folder)
    moment = folder / "moment"
    pong = f'fails_at = {AT}\nfails_by = "{fault.name}"\nmoment = "{moment}"'
    pong += f"\nchild = {str(transport != 'memory').lower()}"
    scene = write_scene(folder, transport, 100.0, pong=pong)
    text = scene.read_text().replace(
        "[components.ping]", f"patience = {patience}\n[components.ping]"
    )
    scene.write_text("toy_faults:Faulty".join(text.rsplit("toys:Toy", 1)))
    run = Started(scene)
    reader = Reader(run)
    status, ended, left = reader.wait(60.0 + patience)
    lines = reader.lines
    assert moment.is_file(), f"it came to no fault: {lines}"
    at = float(moment.read_text())
    told = reader.first("keeps the others waiting") or ended
    said = reader.first("failed in window") or ended
    err = "".join(line for _, line in lines)
    there = (run.folder / "results.json").is_file()
    results = run.results if there else {}
    return Outcome(status, results, err, told - at, said - at, ended - at, left)


def wrong(fault, transport, patience, found, slack=0.5):
    """Rules that a run broke; a loaded machine may need some seconds more."""
    broken = []

    def must(true, rule):
        if not true:
            broken.append(rule)

    must(found.status == 3, f"status 3; found {found.status}")
    must(found.results.get("status") == "failed", "results.json must say failed")
    blamed = found.results.get("fault", {})
    must(blamed.get("component") == "pong", f"culprit pong; found {blamed.get('component')}")
    must(blamed.get("window") == AT, f"window {AT}; found {blamed.get('window')}")
    cause = blamed.get("cause", "")
    must(fault.cause in cause, f"cause {fault.cause}; found {cause}")
    must(f"quintet: pong failed in window {AT}: " in found.err, "the screen must say so")
    must(not found.left, f"nothing left; found {found.left}")
    if fault.kind == "hangs":
        limit = min(TOLD, patience) + slack
        first = min(found.told, found.said)
        must(first < limit, f"told within {limit} s; found {first:.2f}")
        limit = patience + 1.0 + slack
        least = patience - EARLIER
        must(least < found.said < limit, f"ended after {patience} s; found {found.said:.2f}")
        must("in fail" in blamed.get("traceback", ""), "its stack")
        must("toy_faults.py" in found.err, "its stack on the screen")
    else:
        must(found.said < SOON + slack, f"told within {SOON} s; found {found.said:.2f}")
    late = found.took - found.said
    must(late < ENDED + slack, f"over {ENDED} s later; found {late:.2f}")
    return broken


def cell(fault, transport, patience, found):
    """What the table says of one run."""
    if broken := wrong(fault, transport, patience, found):
        return "; ".join(broken)
    if fault.kind == "hangs":
        return f"{found.told:.1f} s, {found.said:.1f} s"
    return f"{found.said:.2f} s"


def table(patience):
    """Try everything; return the rows."""
    rows = [
        f"| fault | {' | '.join(TRANSPORTS)} | the cause, as reported |",
        "|---" * (len(TRANSPORTS) + 2) + "|",
    ]
    for fault in FAULTS:
        cells, cause = [], ""
        for transport in TRANSPORTS:
            if transport not in fault.transports:
                cells.append("")
                continue
            with tempfile.TemporaryDirectory() as folder:
                found = fail(fault, transport, Path(folder) / "run", patience)
            cells.append(cell(fault, transport, patience, found))
            if transport != "mpi" or not cause:
                cause = found.results.get("fault", {}).get("cause", "")
            print(fault.name, transport, cells[-1], flush=True)
        rows.append(f"| {fault.name} | {' | '.join(cells)} | {shortened(cause)} |")
    return [*rows, *rank_rows(patience), *disk_rows()]


def full_disk(written, transport, folder):
    """Run a scene whose disk becomes full; return the rules it broke, the time, and the cause."""
    disk = make_disk("disk", folder)
    try:
        run, _, _ = start(folder, disk, transport, WRITTEN[written])
        reader = Reader(run)
        at = fill(run, disk, WRITTEN[written])
        _, ended, _ = reader.wait(60.0)
        run.err = "".join(line for _, line in reader.lines)
        broken = broken_rules(run, disk, WRITTEN[written])
        said = reader.first("it cannot be written") or ended
        cause = next((line for _, line in reader.lines if "it cannot be written" in line), "")
        return broken, said - at, cause.removeprefix("quintet: coupler failed in ").strip()
    finally:
        disk.close()


def disk_rows():
    """Rows of the table for a disk that becomes full."""
    for written in WRITTEN:
        cells, causes = [], []
        for transport in TRANSPORTS:
            with tempfile.TemporaryDirectory() as folder:
                broken, after, cause = full_disk(written, transport, Path(folder))
            cells.append("; ".join(broken) or f"{after:.2f} s")
            causes.append(cause.partition(": ")[2])
            print(f"full disk, {written}", transport, cells[-1], flush=True)
        yield f"| full disk, {written} | {' | '.join(cells)} | {shortened(causes[0])} |"


def main(patience=8.0):
    """Write the table."""
    rows = "\n".join(table(patience))
    before, _, rest = TABLE.read_text().partition(BEGIN)
    TABLE.write_text(f"{before}{BEGIN}\n{rows}\n{END}{rest.partition(END)[2]}")


if __name__ == "__main__":
    main()
