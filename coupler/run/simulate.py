"""One run, from a checked scene to its results, failures included."""

import contextlib
import os
import sys
import threading
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import tomli_w

from quintet.coupler.coupling.group import assemble
from quintet.coupler.coupling.iteration.convergence_log import ConvergenceLog, log_file
from quintet.coupler.coupling.judgement.checks import Judgement
from quintet.coupler.coupling.ledger import Ledger
from quintet.coupler.coupling.participant import ComponentFailed, Participant
from quintet.coupler.coupling.schedule import Costs, Coupling
from quintet.coupler.files.disk import (
    give_up_reserve,
    reporting_disk,
    reserve,
    write_whole,
)
from quintet.coupler.files.reached import NAME as REACHED
from quintet.coupler.files.reached import Reached
from quintet.coupler.files.run_files import LEDGER, RESULTS, SCENE, TRACE, failure_files
from quintet.coupler.files.states import time_of
from quintet.coupler.launch.companion import Companion, once_gone
from quintet.coupler.launch.connect import Connection, connect
from quintet.coupler.launch.disturbance import UNDISTURBED, Disturbance
from quintet.coupler.launch.processes import RUN, OwnProcesses, end_marked
from quintet.coupler.launch.watchdog import Watchdog
from quintet.coupler.run import results, snapshots
from quintet.coupler.run.beginning import Start
from quintet.coupler.run.energy import EnergyMeter
from quintet.coupler.run.leaving import leave_in_time
from quintet.coupler.run.loop import run
from quintet.coupler.run.outcome import failed, how_to_resume, of_disk, outcome_of, refused
from quintet.coupler.run.output import OutputWriter
from quintet.coupler.run.signals import StopRequest
from quintet.coupler.run.start_report import StartReport
from quintet.coupler.scene.predicted_limits import beyond_limits
from quintet.coupler.scene.scene import Scene
from quintet.interfaces.errors import DiskError, SceneError
from quintet.interfaces.serving.process import STARTER

if TYPE_CHECKING:
    from quintet.coupler.coupling.judgement.error_bar import ErrorBar


class Closable(Protocol):
    """What is open while a run goes on: a file, or several."""

    def close(self) -> None:
        """Finish it; a second call does nothing."""


def simulate(
    scene: Scene, folder: Path, snapshot: Path | None = None, own_process: bool = False
) -> int:
    """Run a scene in a prepared folder, or from a snapshot in it; return the exit status.

    Where the process is our own, it is left from a thread if its main thread does not come back.
    """
    stop = StopRequest()
    in_main_thread, alone = scene.transport == "memory", len(scene.components) == 1
    watchdog = Watchdog(stop, in_main_thread, alone=alone, grace=scene.grace)
    run = ActiveRun(scene, folder, snapshot, stop, watchdog)
    if own_process:
        stop.leave = run.leave
    try:
        with stop.listening(lambda: watchdog.verdict is not None):
            run.run()
    except KeyboardInterrupt as error:
        status = run.end(watchdog.verdict or error)
    except Exception as error:  # any failure is reported in the results
        status = run.end(error)
    else:
        status = run.end(None)
    if own_process and watchdog.in_main_thread:
        leave_in_time(status, max(map(scene.patience, scene.components)))
    return status


class ActiveRun:
    """A run under way: its files, its components, and how it ends."""

    def __init__(
        self,
        scene: Scene,
        folder: Path,
        snapshot: Path | None,
        stop: StopRequest,
        watchdog: Watchdog,
    ) -> None:
        self.scene, self.folder, self.snapshot = scene, folder, snapshot
        self.stop, self.watchdog, self.clock = stop, watchdog, results.Clock()
        self.energy = EnergyMeter()
        self.begun_from: dict[str, Any] = {}  # what results say of the run that it begins from
        self.exchange = scene.exchange()
        self.disturbance = disturbance_of(scene)
        if snapshot:
            snapshots.check_files(snapshot)
        size, lengths = snapshots.file_sizes(snapshot) if snapshot else (0, {})
        self.ledger = Ledger(self.exchange, folder / LEDGER, size)
        self.error_bar = error_bar_of(scene)
        self.judgement = Judgement(self.ledger.accounts, self.error_bar)
        self.logs = {
            name: ConvergenceLog(folder / log_file(name), lengths.get(name, 0))
            for name in scene.coupling.iterated()
        }
        first = snapshots.window_of(snapshot) if snapshot else None
        view_checks = snapshots.view_checks(snapshot) if snapshot else {}
        self.writer = OutputWriter(
            scene, folder, stop, self.logs, self.judgement, first, view_checks
        )
        if snapshot:
            self.writer.time = time_of(snapshot)
        self.files: tuple[Closable, ...] = (self.writer, self.ledger, *self.logs.values())
        self.attach_trace: Callable[[Coupling], None] = lambda _: None
        if scene.file.output.trace:
            self._begin_trace()
        self.costs = Costs()
        reached = {"windows": self.writer.done, "time": self.writer.time}
        self.outcome: dict[str, Any] = {"status": "failed", **reached}
        self.participants: dict[str, Participant] = {}
        self.draws = True  # pictures that were due before a failure; a forked process leaves them
        self._start = StartReport(log_files(scene, folder))
        self.writer.on_begin = self._start.close
        self._connection: Connection | None = None
        self._coupling: Coupling | None = None
        self.notes_of_lines: Callable[[], list[str]] = list
        self._ending = threading.RLock()  # of the thread that ends the run
        self._companion: Closable | None = None
        self._started: OwnProcesses | None = None

    def run(self) -> None:
        """Join the components and couple them to the end, or until a signal ends it."""
        scene = self.scene
        for name in failure_files(scene.components):  # of an earlier part of this run
            (self.folder / name).unlink(missing_ok=True)
        main = threading.current_thread() is threading.main_thread()
        if self.stop.leave and self.watchdog.in_main_thread:
            self._started = OwnProcesses(self.watchdog.mark)
        if self.stop.leave and main:
            in_main_thread = self.watchdog.in_main_thread
            self._begin_watchdog_process() if in_main_thread else self._begin_companion()
        self.writer.on_window = self.disturbance.noting(self.writer.on_window)
        self._start.show()
        self._warn_of_limits()
        connection = connect(scene, self.folder, self.watchdog, self.disturbance)
        self._connection = connection
        self.participants, self.notes_of_lines = connection.participants, connection.notes
        self._coupling = coupling = assemble(
            scene.coupling, self.participants, self.exchange, self.ledger, self.logs, self.costs
        )
        self.attach_trace(coupling)
        path = self.snapshot
        restore = partial(snapshots.restore, judgement=self.judgement, path=path) if path else None
        asked = scene.asked_outputs()
        if self.error_bar:
            asked = {name: keys | self.error_bar.needs[name] for name, keys in asked.items()}
        start = Start(scene)
        self.begun_from = start.provenance
        end = run(coupling, scene.file.end, self.writer, asked, self.judgement, restore, start)
        for file in self.files:
            file.close()
        connection.close(True)
        self._connection = None
        self.outcome |= outcome_of(end)

    def _begin_trace(self) -> None:
        """Have the times of orders, mappings and windows written down."""
        # Only runs that ask for a trace load it.
        from quintet.coupler.run.trace_log import TraceLog

        log = TraceLog(self.folder / TRACE, self.scene.transport, bool(self.snapshot))
        self.attach_trace, self.writer.after_window = log.attach, log.after_window
        self.files = (*self.files, log)

    def _warn_of_limits(self) -> None:
        """Warn of predicted limits that the scene runs beyond."""
        for name, text in beyond_limits(self.scene).items():
            self.ledger.warnings.note("scene", {name: text})
        for warning in self.ledger.warnings.close_window(0.0):
            self.writer.warn(str(warning))

    def _begin_watchdog_process(self) -> None:
        """Have it ended from another process too: here a solver may stop all Python."""
        # Only runs over memory have one, and load what it needs.
        from quintet.coupler.run.watchdog_process import WatchdogProcess

        patience = {name: self.scene.patience(name) for name in self.scene.components}
        process = WatchdogProcess(patience, self.stop, self._report)
        self._companion = self.watchdog.substitute = process
        self.writer.on_window = process.note

    def _begin_companion(self) -> None:
        """Have it written down if this process is killed: the others are processes of their own."""
        path = self.folder / "log" / REACHED
        self.writer.on_window = Reached(path).note
        # Of other MPI jobs who started them sees to the ranks.
        if self.scene.transport == "zenoh" or STARTER not in os.environ:
            self._companion = Companion(once_gone(self._report_death))

    def _report_death(self) -> None:
        """Write down that this process is gone, from its companion."""
        windows, reached = Reached.read(self.folder / "log" / REACHED)
        cause = "the coupler's process is gone: it was killed, perhaps for want of memory"
        self._report(ComponentFailed("coupler", windows, cause), windows, reached)

    def _report(self, error: ComponentFailed, windows: int, reached: float) -> None:
        """Write down a failure, from the process beside this one."""
        self.writer.done, self.writer.time, self.draws = windows, reached, False
        end_marked(RUN, self.watchdog.mark)
        self.outcome |= failed(error, self.scene, self.folder, self.writer)
        self.outcome["warnings"] = self.ledger.warnings.summary()
        conclude(self)

    def end(self, error: BaseException | None) -> int:
        """End it, with what went wrong if something did; write the results; tell the status."""
        with self._ending:
            if self._companion:
                self._companion.close()
            if self._started:
                self._started.end()
            self._start.close()
            self.disturbance.close()
            writer, lost = self.writer, False
            if isinstance(error, KeyboardInterrupt) or isinstance(
                self.watchdog.verdict, KeyboardInterrupt
            ):
                ended = {"status": "interrupted", "windows": writer.done, "time": writer.time}
                self.outcome |= ended
            elif isinstance(error, Exception):
                error = of_disk(error, self.folder)
                lost = isinstance(error, DiskError)
                remark = self.disturbance.remark()
                self.outcome |= refused(error, writer) or failed(
                    error, self.scene, self.folder, writer, remark
                )
                self._suspect_coupling()
                self._leave_traces(error)
            if self._connection:
                self._connection.close(False)
            for file in self.files:
                with contextlib.suppress(DiskError):  # told already: it ended the run
                    file.close()
            if self.stop.asked and self.outcome["status"] != "done" and not lost:
                self.outcome["status"] = "interrupted"
            self.outcome["warnings"] = self.ledger.warnings.summary()
            return conclude(self)

    def _leave_traces(self, error: Exception) -> None:
        """Write what helps to find the cause of a failure; say where what is around it lies."""
        if not (fault := self.outcome.get("fault")) or isinstance(error, DiskError):
            return
        # Left out of runs that do not fail.
        from quintet.coupler.run import failed_orders
        from quintet.coupler.run.blow_up import write_neighbourhood

        with contextlib.suppress(DiskError):  # only `quintet debug` needs them
            failed_orders.write(self.folder, self.participants)
        if not isinstance(error, ComponentFailed):
            return
        time, headline = self.writer.time, self.scene.headline
        if sentence := write_neighbourhood(self.folder, error, time, headline):
            print(f"  {sentence}", file=sys.stderr, flush=True)
            fault["neighbourhood"] = sentence

    def _suspect_coupling(self) -> None:
        """Say beside a failure which couplings were doubtful before it."""
        fault = self.outcome.get("fault")
        if fault is None or self._coupling is None or not self.writer.begun:
            return
        if suspects := self.judgement.suspects(self._coupling):
            print(*(f"  {text}" for text in suspects), sep="\n", file=sys.stderr, flush=True)
            fault["coupling"] = suspects

    def leave(self) -> None:
        """End from another thread: the main one is in a solver that does not come back."""
        if self._ending.acquire(blocking=False):  # else it has come back
            status = self.end(self.watchdog.verdict)
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(status)


def disturbance_of(scene: Scene) -> Disturbance:
    """What disturbs a run, if anything is to."""
    if scene.chaos is None:
        return UNDISTURBED
    # Only runs that are to be disturbed load it.
    from quintet.coupler.chaos.chaos import Chaos

    return Chaos(scene)


def error_bar_of(scene: Scene) -> "ErrorBar | None":
    """What estimates the error of the coupling, where a run wants it."""
    if not scene.file.error_bar.on:
        return None
    # Only runs with error bars load it.
    from quintet.coupler.run.error_bars import error_bar_of as make

    return make(scene)


def log_files(scene: Scene, folder: Path) -> dict[str, Path]:
    """Logs of the components that are processes of their own on this host."""
    if scene.transport == "memory":
        return {}
    here = [name for name in scene.components if name not in scene.elsewhere]
    return {name: folder / "log" / f"{name}.log" for name in here}


def make_folder(scene: Scene, folder: Path) -> None:
    """Prepare the folder of a run: its logs, and the scene as it runs."""
    with reporting_disk(folder):
        (folder / "log").mkdir(parents=True, exist_ok=True)
    write_whole(folder / SCENE, tomli_w.dumps(scene.resolved))
    reserve(folder, RESULTS)


def notes(run: ActiveRun) -> dict[str, list[str]]:
    """What the user should know of each component, and of the lines to them."""
    all_notes = {name: participant.notes for name, participant in run.participants.items()}
    all_notes["coupler"] = run.notes_of_lines()
    return {name: texts for name, texts in all_notes.items() if texts}


def conclude_for_coupler(scene: Scene, folder: Path, status: int, cause: str) -> None:
    """Write the results of a run whose coupler is gone, from the process that started it."""
    windows, reached = Reached.read(folder / "log" / REACHED)
    outcome: dict[str, Any] = {"status": "interrupted", "windows": windows, "time": reached}
    if status != results.INTERRUPTED:
        error = ComponentFailed("coupler", windows, cause)
        outcome |= {"status": "failed", "fault": results.fault(error, folder, [])}
    content = {**results.headline(scene, outcome), "expect": [], "ledger": {"links": []}}
    give_up_reserve(folder)
    results.write(folder, content | how_to_resume(folder, outcome))


def conclude(run: ActiveRun) -> int:
    """Evaluate the expectations, write the results, draw; return the exit status."""
    scene, folder, outcome = run.scene, run.folder, run.outcome
    ended = outcome["status"] in ("done", "interrupted")
    outcomes = results.outcomes(scene, folder) if ended else []
    bars: dict[str, Any] = {}
    if run.error_bar and ended:
        outcomes, bars = results.with_error_bars(run.error_bar, scene, folder, outcomes)
    content = {
        **results.headline(scene, outcome),
        **run.begun_from,
        "expect": results.expectations(outcomes),
        "ledger": run.ledger.summary(),
        "repetitions": run.costs.repetitions,
        "unconverged": run.costs.unconverged,
        "time_errors": run.judgement.time.errors.summary(),
        **bars,
        "notes": notes(run),
        "timing": results.timing(run.participants, run.clock(), run.costs, run.energy.joules()),
        "advice": results.advise(scene, run.participants),
        **run.disturbance.summary(),
    }
    if outcome["status"] != "done":
        content |= how_to_resume(folder, outcome)
    results.write(folder, content)
    if outcome["status"] == "refused":
        return results.BAD
    if outcome["status"] == "failed":
        if run.draws:
            results.draw_until(scene, folder, outcome["time"])
        return results.FAILED
    if outcome["status"] == "interrupted":
        return results.INTERRUPTED
    try:
        results.draw(scene, folder, outcomes)
    except (DiskError, SceneError) as error:
        print(f"quintet: {error}", file=sys.stderr, flush=True)
    except KeyboardInterrupt:  # the run is over, and its results are written
        print(
            "\nquintet: interrupted after the run: pictures left out", file=sys.stderr, flush=True
        )
        return results.INTERRUPTED
    finally:  # not earlier: a run whose process is killed while it draws goes on from the last one
        snapshots.remove(snapshots.snapshots(folder))
    met = all(expected.met or not expected.required for expected in outcomes)
    return results.DONE if met and not run.ledger.warnings else results.UNMET
