"""The orders that a component got in a run, found again: its inputs, window by window.

Where all windows are stepped once, the couplings are driven with components that answer from the
recording, and nothing computes. Where windows are repeated, or stepped within groups, the
recording has only what was agreed in the end: then all components compute once more.
"""

import secrets
import tempfile
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import cast

import numpy as np

from quintet.coupler.coupling.group import assemble, join_ports
from quintet.coupler.coupling.ledger import Ledger
from quintet.coupler.coupling.participant import ComponentFailed, Participant, describe_all
from quintet.coupler.coupling.schedule import Coupling
from quintet.coupler.coupling.schemes import advance
from quintet.coupler.coupling.windows import run_windows
from quintet.coupler.debug.lines import LoggedLine, NotRecorded, RecordedLine
from quintet.coupler.debug.no_ledger import NoLedger
from quintet.coupler.debug.request import Request
from quintet.coupler.files.recording import NAME, Recording
from quintet.coupler.launch.acceptance import settings
from quintet.coupler.launch.order_log import OrderLog
from quintet.coupler.run.beginning import Start
from quintet.coupler.run.output import lay_stops
from quintet.coupler.run.snapshots import restore_states
from quintet.coupler.scene.scene import Scene
from quintet.interfaces.errors import SceneError
from quintet.interfaces.lines.memory import MemoryLine
from quintet.interfaces.lines.transport import WatchedLine
from quintet.interfaces.manifest import find
from quintet.interfaces.serving.process import build
from quintet.interfaces.serving.serve import Server, answer


def find_orders(request: Request) -> OrderLog:
    """Drive the couplings of a run to a window of a component; return the orders it got."""
    log = OrderLog(Path(tempfile.gettempdir()))
    try:
        if not request.by_recording:
            _drive(request, _computing(request.scene, request.component, log), log)
            return log
        with Recording(request.folder / NAME) as recording:
            _drive(request, _recorded(request, recording, log), log)
    except BaseException:
        log.close()
        raise
    return log


def _recorded(request: Request, recording: Recording, log: OrderLog) -> dict[str, Participant]:
    """Components that answer from the recording; the one that is debugged, too."""
    replay, folder = find("replay"), str(request.scene.folder.resolve())
    participants = {}
    for name in request.scene.components:
        params = {"recording": str(request.folder), "component": name}
        header = {"params": params, "threads": 1, "folder": folder}
        line: WatchedLine = RecordedLine(name, recording, build(replay, header))
        line = LoggedLine(line, log) if name == request.component else line
        participants[name] = Participant(name, line)
    return participants


def _computing(scene: Scene, component: str, log: OrderLog) -> dict[str, Participant]:
    """Components that compute, all in this process."""
    run, participants = secrets.token_hex(4), {}
    for name, plan in scene.components.items():
        inner = MemoryLine(run, name)
        server = Server(build(plan.manifest, settings(scene, name)), name)
        inner.handle = partial(answer, server, inner.far)
        line: WatchedLine = LoggedLine(inner, log) if name == component else inner
        participants[name] = Participant(name, line)
    return participants


def _drive(request: Request, participants: Mapping[str, Participant], log: OrderLog) -> None:
    """Step the couplings until the component has been ordered its window."""
    scene = request.scene
    ledger = cast(Ledger, NoLedger())
    coupling = assemble(scene.coupling, participants, scene.exchange(), ledger)
    start, described = Start(scene), describe_all(coupling.components)
    join_ports(coupling, described, scene.asked_outputs(), start.begin)
    _lay_windows(coupling, scene)
    if request.snapshot:
        restore_states(coupling, request.snapshot)
    else:
        start.go_on(coupling)
    target = participants[request.component]
    while target.window <= request.window:
        order = request.failed_order
        if request.by_recording and order is not None and target.window == request.window:
            log.add(order.header, order.fields)
            return
        _require_time(coupling, request, target.window)
        try:
            advance(coupling)
        except ComponentFailed:
            if target.window_order[0].get("window") != request.window:
                raise
            return
        except NotRecorded as error:
            if target.window_order[0].get("window") != request.window:
                raise _not_known(request, target.window, str(error)) from error
            return
        if not request.by_recording:
            _compare(coupling, request)


def _lay_windows(coupling: Coupling, scene: Scene) -> None:
    """Make the windows of the run, which end where its output was due."""
    plan = coupling.plan
    follows = plan.window == "auto" or bool(coupling.equal)
    length = float("inf") if plan.window == "auto" else plan.window
    exact = plan.follows(coupling.exchange)
    coupling.windows = run_windows(scene.file.end, length, follows, exact)
    lay_stops(scene.file.output, coupling.windows)


def _require_time(coupling: Coupling, request: Request, last: int) -> None:
    if coupling.windows.finished:
        raise SceneError(
            f"--window must be at most {last - 1}, the last of {request.component}; found "
            f"{request.window}. Correct it."
        )


def _not_known(request: Request, reached: int, why: str) -> SceneError:
    if reached < request.window:
        return SceneError(
            f"--window must be at most {reached}: {why}; found {request.window}. Correct it."
        )
    return SceneError(
        f"--window {request.window}: the inputs of {request.component} must be known; {why}, on "
        "which they depend. Name an earlier window."
    )


def _compare(coupling: Coupling, request: Request) -> None:
    """Check that what the components computed again has the bits of the recording."""
    path = request.folder / NAME
    done = coupling.windows.done
    if not path.is_file():
        return
    with Recording(path) as recording:
        for name, fields in coupling.outputs.items():
            if done >= len(recording.times(name)):
                continue
            row = recording.row(name, done)
            for key, array in fields.items():
                if key in row and not np.array_equal(row[key], array):
                    raise SceneError(
                        f"debug {request.folder}: the components must compute what they did in the "
                        f"run; in window {done - 1} {name}.{key} differs. Use the same version of "
                        "quintet, and the same machine."
                    )
