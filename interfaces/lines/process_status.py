"""Status of a process of this host and its processor time, from /proc."""

import os
from pathlib import Path

TICK = 1.0 / os.sysconf("SC_CLK_TCK")  # s, unit of processor time in /proc


def running(pid: int) -> bool:
    """Whether a process of this host runs; a zombie does not."""
    return state(pid) not in ("", "Z", "X")


def state(pid: int) -> str:
    """State of a process: R runs, S sleeps, T is stopped, Z is a zombie; "" if there is none."""
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
