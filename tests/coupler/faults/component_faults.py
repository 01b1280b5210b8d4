"""Faults of a component of one process: every fault, at five moments, over each transport."""

import shutil
from dataclasses import dataclass

from outcomes import Expected, outcome
from started import TOYS, Started, write_scene

TRANSPORTS = ("memory", "zenoh", "mpi")
AT = 60  # window in which it fails
FINISHED = 1e-3 * AT  # s, end of a run that fails as it finishes
# Activity of the component at its failure: moment of toy_faults.Faulty, and step.
MOMENTS = {
    "build": ("build", -1),
    "first window": ("step", 0),
    "later window": ("step", AT),
    "give": ("give", AT),
    "finish": ("finish", -1),
}
LATER = "later window"


@dataclass(frozen=True)
class Fault:
    """One way to fail, and the state of the process afterwards."""

    name: str
    kind: str
    cause: str
    transports: tuple[str, ...] = TRANSPORTS
    outputs: bool = False  # whether it spoils what the component gives
    computes: bool = True
    over_memory: int | None = None  # exit status of a run whose process it ends


HANGS = "stopped responding: kept the others waiting for"
PROCESSES = ("zenoh", "mpi")
SHAPE = "output out.number must keep its shape (5, 3); found"
REAL = "must be an array of real numbers; found"
FAULTS = [
    Fault("exception", "said", "ArithmeticError: asked to raise"),
    Fault("sys.exit", "said", "SystemExit: asked Python to exit, with status 0"),
    Fault("os._exit", "dead", "ended by itself with status 0", over_memory=3),
    Fault("SIGKILL", "dead", "was killed by signal 9 (SIGKILL)", over_memory=-9),
    Fault("SIGSEGV", "dead", "was killed by signal 11 (SIGSEGV): its compiled", over_memory=-11),
    Fault("SIGSTOP", "stopped", "stopped responding: process", PROCESSES),
    Fault("deadlock", "hangs", HANGS, computes=False),
    Fault("endless loop", "hangs", HANGS),
    Fault("compiled loop", "hangs", HANGS),
    Fault("locked loop", "hangs", HANGS),
    Fault("polling loop", "hangs", HANGS),
    Fault("NaN", "said", "number of out.number must be finite; item 0 is [nan", outputs=True),
    Fault("wrong shape", "said", f"{SHAPE} (2, 3)", outputs=True),
    Fault("impulse of wrong shape", "said", "output out.push must keep its shape (5, 3); found (1",
          outputs=True),
    Fault("complex", "said", f"output out.number {REAL} complex", outputs=True),
    Fault("None", "said", f"output out.push {REAL} NoneType", outputs=True),
    Fault("huge", "said", f"{SHAPE} (250000000, 3)", outputs=True),
    Fault("out of memory", "said", "MemoryError: "),
    Fault("disk full", "said", "OSError: [Errno 28] No space left on device"),
    Fault("link cut", "dead", "pong is gone | ended by itself with status 3", ("zenoh",)),
]  # fmt: skip
BY_NAME = {fault.name: fault for fault in FAULTS}


def applies(fault, moment, transport):
    """Whether this combination is possible."""
    ends = moment == "finish" and fault.outputs and fault.name != "None"
    return transport in fault.transports and not ends


CASES = [
    (fault, moment, transport)
    for fault in FAULTS
    for moment in MOMENTS
    for transport in TRANSPORTS
    if applies(fault, moment, transport)
]


def patience_of(fault, moment, patience):
    """Patience of a run [s]; a component may compute thirty times as long during its build."""
    return 0.3 if moment == "build" and fault.kind == "hangs" and fault.computes else patience


def fail(fault, moment, transport, folder, patience):
    """Run a scene of two components, one of which fails; return the outcome."""
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copy(TOYS.with_name("toy_faults.py"), folder)
    note, (fails_in, fails_at) = folder / "moment", MOMENTS[moment]
    pong = f'fails_by = "{fault.name}"\nfails_in = "{fails_in}"\nfails_at = {fails_at}\n'
    pong += f'moment = "{note}"\nchild = {str(transport != "memory").lower()}'
    end = FINISHED if moment == "finish" else 100.0
    scene = write_scene(folder, transport, end, pong=pong)
    seconds = patience_of(fault, moment, patience)
    text = scene.read_text().replace(
        "[components.ping]", f"patience = {seconds}\n[components.ping]"
    )
    scene.write_text("toy_faults:Faulty".join(text.rsplit("toys:Toy", 1)))
    return outcome(Started(scene), note, "pong", 90.0 + patience)


def expected(fault, moment, transport, patience):
    """The outcome that such a run must have."""
    window = AT if moment in (LATER, "give", "finish") else 0
    kind, cause, status = fault.kind, fault.cause, 3
    if transport == "memory" and fault.over_memory is not None:
        kind, cause, status = "gone", "is gone: it ended or was killed", fault.over_memory
    if moment == "build" and "must keep its shape" in cause:
        cause = "must have as many rows as out."
    if moment == "finish" and fault.outputs:
        cause = "final_warnings() must return"
    return Expected(
        "pong",
        window,
        cause,
        kind,
        status,
        patience_of(fault, moment, patience),
        moment != "build",
        fault.computes,
    )
