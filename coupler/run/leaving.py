"""The end of a process in which solvers ran: what they left behind may not keep it for ever.

A thread that a library started, or what it does as Python ends, may hang. All results are written
by then, so the process is left after a while, with the exit status of its run.
"""

import faulthandler
import os
import sys
import threading
import time

LATER = 2.0  # s until the process is left from C, where the interpreter's lock is held


def leave_in_time(status: int, patience: float) -> None:
    """Leave this process with a status, `patience` s after Python has begun to end, if need be."""
    # Called before Python waits for threads, where `atexit` comes too late.
    threading._register_atexit(_arm, status, patience)  # type: ignore[attr-defined]


def _arm(status: int, patience: float) -> None:
    faulthandler.dump_traceback_later(patience + LATER, exit=True)
    threading.Thread(target=_leave, args=(status, patience), daemon=True).start()


def _leave(status: int, patience: float) -> None:
    time.sleep(patience)
    print(
        f"\nquintet: the run is over, but its process did not end within {patience:g} s, as a "
        "component left a thread or an exit handler that hangs; it is left now",
        file=sys.stderr,
        flush=True,
    )
    sys.stdout.flush()
    os._exit(status)
