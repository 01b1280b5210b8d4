"""Whether a process of this host runs, and how much it has computed; from the system's tables."""

import os
from pathlib import Path

TICK = 1.0 / os.sysconf("SC_CLK_TCK")  # s of processor time that the system counts in


def running(pid: int) -> bool:
    """Whether a process of this host runs; one that ended but was not awaited does not."""
    return state(pid) not in ("", "Z", "X")


def state(pid: int) -> str:
    """One letter of the system: R runs, S sleeps, T is stopped, Z ended; "" is not there."""
    return _stat(pid)[0]


def processor_time(pid: int) -> float:
    """Processor time of a process so far, all threads [s]."""
    return _stat(pid)[1]


def _stat(pid: int) -> tuple[str, float]:
    try:
        text = Path(f"/proc/{pid}/stat").read_text()
    except OSError:
        return "", 0.0
    fields = text.rpartition(")")[2].split()
    return fields[0], (int(fields[11]) + int(fields[12])) * TICK
