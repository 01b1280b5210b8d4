"""One run, from a checked scene to its results, failures included."""

import os
import shlex
import sys
import traceback
from functools import partial
from pathlib import Path
from typing import Any

import tomli_w

from quintet.coupler.coupling.convergence_log import ConvergenceLog, log_file
from quintet.coupler.coupling.group import assemble
from quintet.coupler.coupling.ledger import Ledger
from quintet.coupler.coupling.participant import ComponentFailed, Participant
from quintet.coupler.coupling.schedule import Costs
from quintet.coupler.files.run_files import LEDGER, SCENE
from quintet.coupler.launch.connect import Connection, connect
from quintet.coupler.launch.processes import tail
from quintet.coupler.run import results, snapshots
from quintet.coupler.run.loop import RunEnd, run
from quintet.coupler.run.output import OutputWriter
from quintet.coupler.run.signals import StopRequest
from quintet.coupler.scene.overrides import run_arguments
from quintet.coupler.scene.scene import Scene
from quintet.interfaces.errors import LinkError, SceneError


def simulate(scene: Scene, folder: Path, snapshot: Path | None = None) -> int:
    """Run a scene in a prepared folder, or from a snapshot in it; return the exit status."""
    clock, stop = results.Clock(), StopRequest()
    exchange = scene.exchange()
    size, lengths = snapshots.file_sizes(snapshot) if snapshot else (0, {})
    ledger = Ledger(exchange, folder / LEDGER, size)
    logs = {
        name: ConvergenceLog(folder / log_file(name), lengths.get(name, 0))
        for name in scene.coupling.iterated()
    }
    first = snapshots.window_of(snapshot) if snapshot else None
    writer = OutputWriter(scene, folder, stop, logs, first)
    outcome: dict[str, Any] = {"status": "failed", "windows": 0, "time": 0.0}
    connection: Connection | None = None
    participants: dict[str, Participant] = {}
    costs = Costs()
    try:
        with stop.listening():
            connection = connect(scene, folder, stop)
            participants = connection.participants
            coupling = assemble(scene.coupling, participants, exchange, ledger, logs, costs)
            resume = partial(snapshots.restore, path=snapshot) if snapshot else lambda _: None
            end = run(coupling, scene.file.end, writer, scene.asked_outputs(), resume)
            writer.close()
            outcome |= outcome_of(end)
            connection.close(True)
            connection = None
    except KeyboardInterrupt:
        outcome |= {"status": "interrupted", "windows": writer.done, "time": writer.time}
    except Exception as error:  # any failure is reported in the results
        outcome |= refused(error, writer) or failed(error, scene, folder, writer)
    finally:
        if connection:
            connection.close(False)
        writer.close()
        ledger.close()
        for log in logs.values():
            log.close()
    if stop.asked and outcome["status"] != "done":
        outcome["status"] = "interrupted"
    summary = ledger.summary()
    return conclude(scene, folder, outcome, participants, summary, costs, clock())


def make_folder(scene: Scene, folder: Path) -> None:
    """Prepare the folder of a run: its logs, and the scene as it runs."""
    (folder / "log").mkdir(parents=True, exist_ok=True)
    (folder / SCENE).write_text(tomli_w.dumps(scene.resolved), encoding="utf-8")


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


def failed(error: Exception, scene: Scene, folder: Path, writer: OutputWriter) -> dict[str, Any]:
    """Report a failure: component, window, cause, and the last lines of its log."""
    if not isinstance(error, ComponentFailed):
        error = ComponentFailed("coupler", writer.done, str(error), traceback.format_exc())
    lines = tail(folder / "log" / f"{error.component}.log")
    found = results.fault(error, folder, lines)
    print(f"\nquintet: {error}", file=sys.stderr)
    if error.trace:
        print(error.trace, file=sys.stderr)
    if lines:
        print(f"  last lines of {found['log']}:", file=sys.stderr)
        print("\n".join(f"    {line}" for line in lines), file=sys.stderr, flush=True)
    return {"status": "failed", "fault": found, "windows": writer.done, "time": writer.time}


def conclude(
    scene: Scene,
    folder: Path,
    outcome: dict[str, Any],
    participants: dict[str, Participant],
    ledger: dict[str, Any],
    costs: Costs,
    wall: float,
) -> int:
    """Evaluate the expectations, write the results, draw; return the exit status."""
    ended = outcome["status"] in ("done", "interrupted")
    found = results.outcomes(scene, folder) if ended else []
    content = {
        "scene": scene.file.name,
        "preset": scene.preset,
        "transport": scene.transport,
        **outcome,
        "expect": results.expectations(found),
        "ledger": ledger,
        "repetitions": costs.repetitions,
        "unconverged": costs.unconverged,
        "timing": results.timing(participants, wall, costs.mapping),
        "machine": results.machine(),
        "command": shlex.join(["quintet", "run", *run_arguments(**scene.asked)]),
    }
    if outcome["status"] == "done":
        snapshots.remove(snapshots.snapshots(folder))
    elif snapshots.snapshots(folder):
        content["resume"] = shlex.join(["quintet", "run", "--resume", os.path.relpath(folder)])
        print(f"to go on: {content['resume']}", file=sys.stderr)
    results.write(folder, content)
    if outcome["status"] == "refused":
        return results.BAD
    if outcome["status"] == "failed":
        return results.FAILED
    results.draw(scene, folder, found)
    if outcome["status"] == "interrupted":
        return results.INTERRUPTED
    return results.DONE if all(one.met or not one.required for one in found) else results.UNMET
