"""Where in its code a component is: the stack of its process, or of a thread of this one."""

import os
import re
import sys
import threading
import time
import traceback
from pathlib import Path

ANSWERING = 0.5  # s for a process to write its stack
CALL = re.compile(r'^  File ".*", line (?:\d+|\?\?\?) in .*$', re.MULTILINE)
OURS = "/serving/serve.py"  # the call that every component is called from
COMPILER = re.compile(r'/numba/core/|/pyopencl/.*", line \d+ in _?build')
BELOW = ("<frozen ", "/numba/", "/llvmlite/")  # calls that no author of a solver has written
SHOWN = 8  # calls in a message


def of_process(pid: int, number: int, log: Path) -> str:
    """Ask a process for its stack by a signal upon which it writes it into its log."""
    try:
        before = log.stat().st_size
        os.kill(pid, number)
    except OSError:
        return ""
    size, limit = before, time.monotonic() + ANSWERING
    while time.monotonic() < limit:
        time.sleep(0.02)
        last, size = size, log.stat().st_size
        if size == last > before:
            break
    with open(log, "rb") as file:
        file.seek(before)
        return "\n".join(CALL.findall(file.read().decode(errors="replace")))


def of_main_thread() -> str:
    """Return the stack of this process's main thread, in the same form."""
    frame = sys._current_frames().get(threading.main_thread().ident or 0)
    calls = reversed(traceback.extract_stack(frame))
    return "\n".join(
        f'  File "{call.filename}", line {call.lineno} in {call.name}' for call in calls
    )


def compiles(stack: str) -> bool:
    """Whether a kernel is being compiled."""
    return COMPILER.search(stack) is not None


def innermost(stack: str) -> list[str]:
    """The innermost calls that an author has written, up to that of the component."""
    calls = stack.splitlines()
    calls = [call for call in calls if not any(place in call for place in BELOW)] or calls
    first_of_ours = next((n for n, call in enumerate(calls) if OURS in call), len(calls))
    return calls[: min(max(first_of_ours, 1), SHOWN)] if calls else []
