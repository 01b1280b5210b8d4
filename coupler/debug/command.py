"""``quintet debug``: one component of a run under a debugger, at a window."""

import os
import shlex
import sys
from collections.abc import Sequence
from pathlib import Path

from quintet.coupler.debug.debugger import ComponentDebugger
from quintet.coupler.debug.orders import find_orders
from quintet.coupler.debug.repetition import Repetition
from quintet.coupler.debug.request import Request, read_request
from quintet.coupler.run.folder import go_on
from quintet.interfaces.errors import SceneError

SAME, DIFFERENT = 0, 1  # exit status


def debug(
    folder: Path,
    component: str,
    window: int | None = None,
    commands: Sequence[str] | None = None,
    method: str = "step",
    stops: bool = True,
) -> int:
    """Repeat one component of a run to a window, and stop there; return the exit status.

    Parameters
    ----------
    folder : path
        Of the run: it is read only.
    window : int or None
        Counted from 0; None: that in which the component failed, else its last.
    commands : sequence of str or None
        Of pdb, in the place of a terminal.
    method : {"take", "step", "give"}
        Of the component, at whose first line the debugger stops.
    stops : bool
        Whether there is a debugger; else the component only repeats its orders.
    """
    if stops and commands is None and not sys.stdin.isatty():
        raise SceneError(
            "debug needs a terminal, for its commands; standard input is none. Give them, as in "
            "--commands 'where; p self; continue'."
        )
    folder = folder.resolve()
    with go_on(folder, "run"):
        request = read_request(folder, component, window)
        print(headline(request), flush=True)
        log = find_orders(request)
    try:
        same = Repetition(request, log).run(ComponentDebugger(commands) if stops else None, method)
    finally:
        log.close()
    return SAME if same else DIFFERENT


def under(command: str, arguments: Sequence[str]) -> None:
    """Become another program, as a debugger of compiled code, with the repetition as its own."""
    line = [*shlex.split(command), sys.executable, "-m", "quintet.coupler.cli", "debug"]
    line += [*arguments, "--no-stop"]
    try:
        os.execvp(line[0], line)
    except OSError as error:
        raise SceneError(
            f"--debugger {command}: it cannot be started ({error.strerror}). Install it, or give "
            "its path."
        ) from error


def headline(request: Request) -> str:
    """Describe the repetition: its window, its start, and which components compute."""
    name, window, first = request.component, request.window, request.first
    where = f"from {request.snapshot.name}" if request.snapshot else "from the start"
    failed = ", in which it failed" if request.fault else ""
    text = f"{name}, window {window} of {os.path.relpath(request.folder)}{failed}: {where}, "
    text += f"{window - first} windows are repeated; "
    if request.by_recording:
        text += f"the others are as recorded, only {name} computes"
    else:
        why = "its windows are repeated, or within groups, which no recording has"
        text += f"{why}: all components compute once to find the inputs of {name}"
    ranks = request.scene.components[name].ranks
    return text + (f"; {name} ran on {ranks} ranks, and is one process here" * (ranks > 1))
