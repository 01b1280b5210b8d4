"""How a run ended, as it stands in ``results.json``: done, interrupted, refused or failed."""

import os
import shlex
import sys
import traceback
from pathlib import Path
from typing import Any

from quintet.coupler.coupling.participant import ComponentFailed
from quintet.coupler.files.disk import REASONS, disk_error, give_up_reserve
from quintet.coupler.launch.processes import tail
from quintet.coupler.run import results, snapshots
from quintet.coupler.run.loop import RunEnd
from quintet.coupler.run.output import OutputWriter
from quintet.coupler.scene.scene import Scene
from quintet.interfaces.errors import LinkError, QuintetError, SceneError


def outcome_of(end: RunEnd) -> dict[str, Any]:
    """Status of a run, complete or interrupted."""
    status = "done" if end.finished else "interrupted"
    return {"status": status, "windows": end.windows, "time": end.time}


def refused(error: Exception, writer: OutputWriter) -> dict[str, Any]:
    """Report what a scene asks for and its components, once joined, do not allow."""
    if writer.begun or not isinstance(error, (SceneError, LinkError)):
        return {}
    print(f"\nquintet: {error}", file=sys.stderr, flush=True)
    return {"status": "refused", "cause": str(error)}


def of_disk(error: Exception, folder: Path) -> Exception:
    """Tell the disk of an error of the system that a full one caused."""
    if isinstance(error, OSError) and error.errno in REASONS:
        return disk_error(Path(error.filename or folder), error)
    return error


def failed(
    error: Exception, scene: Scene, folder: Path, writer: OutputWriter, remark: str = ""
) -> dict[str, Any]:
    """Report a failure: component, window, cause with a remark, and the last lines of its log."""
    give_up_reserve(folder)  # what is said here may go to the same disk
    if not isinstance(error, ComponentFailed):
        trace = "" if isinstance(error, QuintetError) else traceback.format_exc()
        error = ComponentFailed("coupler", writer.done, str(error), trace)
    if remark:
        cause = f"{error.cause.removesuffix('.')}.{remark}"
        error = ComponentFailed(error.component, error.window, cause, error.trace)
    lines = tail(folder / "log" / f"{error.component}.log")
    fault = results.fault(error, folder, lines)
    print(f"\nquintet: {error}", file=sys.stderr)
    if error.trace:
        print(error.trace, file=sys.stderr)
    if lines:
        print(f"  last lines of {fault['log']}:", file=sys.stderr)
        print("\n".join(f"    {line}" for line in lines), file=sys.stderr, flush=True)
    return {"status": "failed", "fault": fault, "windows": writer.done, "time": writer.time}


def how_to_resume(folder: Path, outcome: dict[str, Any]) -> dict[str, str]:
    """Tell how a run that was not done can go on, if it can."""
    if saved := snapshots.snapshots(folder):
        resume = shlex.join(["quintet", "run", "--resume", os.path.relpath(folder)])
        behind = outcome["windows"] - snapshots.window_of(saved[-1])
        again = f" ({behind} windows are computed again)" if behind else ""
        print(f"to go on: {resume}{again}", file=sys.stderr)
        return {"resume": resume}
    if outcome["status"] == "interrupted":
        print("it cannot go on: it was ended before its first snapshot", file=sys.stderr)
    return {}
