"""Output during a run: recording, views, ledger, snapshots."""

import contextlib
import sys
import time
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from types import MappingProxyType

from quintet.coupler.coupling.iteration.convergence_log import ConvergenceLog
from quintet.coupler.coupling.judgement.checks import Judgement
from quintet.coupler.coupling.schedule import Coupling
from quintet.coupler.coupling.windows import Windows, in_ticks
from quintet.coupler.files import vtkhdf_reader
from quintet.coupler.files.recording import NAME, Instant, Recorder
from quintet.coupler.files.run_files import view_file, walls_file
from quintet.coupler.files.vtkhdf import VtkHdf, resume
from quintet.coupler.launch.watchdog import ENDING
from quintet.coupler.measures.evaluation import lacking_items
from quintet.coupler.run.folder import discard_former
from quintet.coupler.run.progress import ProgressReport, Reading
from quintet.coupler.run.restart_points import RestartPoints
from quintet.coupler.run.signals import StopRequest
from quintet.coupler.run.snapshots import keep_state, save
from quintet.coupler.scene.scene import OutputSettings, Scene
from quintet.interfaces.component import Fields
from quintet.interfaces.errors import SceneError
from quintet.interfaces.ports import only_fields

WALLS = "walls."  # what fields of walls begin with, beside those of the view
# Wall time [s] between two snapshots where the scene gives none: of windows that are over before an
# interrupted run is ended, of longer ones, which an interruption loses, and where components may be
# started again.
SNAPSHOT_INTERVAL, OFTEN, RESTARTABLE = 600.0, 60.0, 5.0
COST = 50.0  # times as long as a snapshot takes is there none after it


def lay_stops(output: OutputSettings, windows: Windows) -> tuple[int, int, int]:
    """Have windows end where output is due; return the ticks between views, totals, snapshots."""
    tick = windows.tick
    views, totals, snapshots = (
        in_ticks(time, tick) if time else 0
        for time in (output.interval, output.totals, output.snapshots)
    )
    # Rows of the ledger come at the windows' ends: to watch a run must not change its steps.
    windows.stops = [time for time in (views, snapshots) if time]
    pictures, states = (marks_of(times, windows) for times in (output.pictures, output.states))
    windows.marks = tuple(dict.fromkeys((*pictures, *states)))
    return views, totals, snapshots


def _begins_after(path: Path, time: float) -> bool:
    """Whether a file has views of later times [s] only, or none yet."""
    return path.is_file() and not any(when <= time for when in vtkhdf_reader.times(path))


def marks_of(times: Iterable[float], windows: Windows) -> tuple[int, ...]:
    """Times [s] at which windows end [ticks]; one beyond the run's end is its end."""
    return tuple(min(in_ticks(time, windows.tick), windows.end) for time in times if time)


class OutputWriter:
    """Writes recording, views and ledger of a run, and shows its progress."""

    def __init__(
        self,
        scene: Scene,
        folder: Path,
        stop: StopRequest,
        logs: Mapping[str, ConvergenceLog],
        judgement: Judgement,
        first: int | None = None,
        view_checks: Mapping[str, int] = MappingProxyType({}),
    ) -> None:
        """Begin the files, or continue them after the first windows of an earlier run."""
        self.scene, self.folder, self.stop, self.first = scene, folder, stop, first
        self.logs, self.begun, self._view_checks = logs, False, view_checks
        self._judgement = judgement
        self.on_begin: Callable[[], None] = lambda: None  # called when the first window is next
        self.on_window: Callable[[int, float], None] = lambda *_: None  # windows done, time [s]
        # Called when all of a window is written, and before the first.
        self.after_window: Callable[[Coupling], None] = lambda _: None
        self.done, self.time = first or 0, 0.0  # windows, s
        self._kept = time.monotonic()  # when the last snapshot was made
        self._cost = 0.0  # s that it took
        self._restart_points = RestartPoints() if scene.file.restarts else None
        self._views = 0  # ticks between two views; 0: none
        self._totals = 0  # ticks between two rows of the ledger
        self._snapshots = 0  # ticks between two snapshots; 0: by the clock
        self._pictures: tuple[int, ...] = ()  # ticks
        self._states: tuple[int, ...] = ()  # ticks, of those that are kept for other runs
        self._now = 0  # ticks
        self._windows = Windows(1.0, 1)
        self._recorder: Recorder | None = None
        self._recorded: dict[str, list[str]] = {}  # fields of each component
        self._progress: ProgressReport | None = None
        self._files: dict[str, VtkHdf] = {}
        self._shows = bool(scene.file.output.interval or scene.file.output.pictures)
        self._asked: set[str] = set()  # components whose walls were asked for
        self._moving_walls: set[str] = set()  # components whose walls move: asked for again
        self._wall_files: dict[str, VtkHdf] = {}  # of these
        self._began = 0.0  # s, simulated

    def plan(self, windows: Windows) -> None:
        """See `Observer.plan`."""
        self._views, self._totals, self._snapshots = lay_stops(self.scene.file.output, windows)
        self._windows = windows
        output = self.scene.file.output
        self._pictures = marks_of(output.pictures, windows)
        self._states = marks_of(output.states, windows)

    def begin(self, coupling: Coupling, described: Mapping[str, Fields]) -> None:
        """See `Observer.begin`."""
        if lacking := list(lacking_items(self.scene.expect, coupling.outputs)):
            raise SceneError(lacking)
        self.done, self._now = self._windows.done, self._windows.now
        self.time = self._began = self._windows.time
        asked = self.scene.asked_outputs()
        self._recorded = {name: coupling.exchange.wanted(name, asked[name]) for name in asked}
        if self.first is not None:
            self._go_on()
        self.begun = True
        self.on_begin()
        discard_former(self.folder)  # all checks are passed
        self.on_window(self.done, self.time)
        if self.scene.file.output.record and not self._recorder:
            self._recorder = self._recording(coupling, described)
        if self.first is None:
            self._record(coupling)
            self._note(coupling)
        self._progress = ProgressReport(self.scene.file.end)
        self.after_window(coupling)

    def _recording(self, coupling: Coupling, described: Mapping[str, Fields]) -> Recorder:
        path = self.folder / NAME
        text = (self.folder / "scene.toml").read_text(encoding="utf-8")
        recorder = Recorder(path, self.folder.name, text, self._windows.tick)
        for name, component in self.scene.components.items():
            ports = only_fields(component.gives, self._recorded[name])
            samples = coupling.exchange.samples_of(name)
            recorder.component(name, ports, {**described[name], **samples})
        return recorder

    def _go_on(self) -> None:
        """Open the files of an earlier run, and refuse any that was changed since."""
        if self.scene.file.output.record:
            self._recorder = Recorder.resume(self.folder / NAME, self.done + 1)
        for name in self.scene.components:
            path = self.folder / view_file(name)
            if name not in self._view_checks and _begins_after(path, self._began):
                path.unlink()
            elif path.is_file():
                self._files[name] = resume(path, self._began, self._view_checks.get(name))

    def due(self, ticks: int) -> bool:
        """See `Observer.due`."""
        often = any(self._passes(every, ticks) for every in (self._views, self._totals))
        return often or self._meets_picture(ticks) or ticks >= self._windows.end

    def _meets_picture(self, ticks: int) -> bool:
        """Whether the time of a picture lies between the last window's end and a time [ticks]."""
        return any(self._now < mark <= ticks for mark in self._pictures)

    def _passes(self, every: int, ticks: int) -> bool:
        """Whether a multiple of `every` lies between the last window's end and a time [ticks]."""
        return bool(every) and ticks // every > self._now // every

    def end_window(self, coupling: Coupling) -> None:
        """See `Observer.end_window`."""
        windows = self._windows
        now, self.done, self.time = windows.now, windows.done, windows.time
        self.on_window(self.done, self.time)
        self._record(coupling)
        if self._passes(self._views, now) or self._meets_picture(now):
            self._note(coupling)
        elif self._passes(self._totals, now) or now >= windows.end:
            coupling.ledger.note(self.time, dict(coupling.ledger.totals))
        if self._progress:
            self._progress.show(self._reading(coupling))
        late = time.monotonic() - self._kept > self._interval(coupling)
        if self._passes(self._snapshots, now) if self._snapshots else late:
            self._keep(coupling)
        elif self._restart_points:
            self._restart_points.end_window(coupling)
        if any(self._now < mark <= now for mark in self._states):
            keep_state(coupling, self.scene, self.folder, self.logs, self._judgement)
        self._now = now
        self.after_window(coupling)

    def _reading(self, coupling: Coupling) -> Reading:
        compute = {
            name: component.timing.compute for name, component in coupling.components.items()
        }
        repeated = any(True for _ in coupling.plan.iterated())
        repetitions = coupling.costs.repetitions if repeated else None
        residual = coupling.ledger.worst if coupling.ledger.accounts else None
        return Reading(self.done, self.time, residual, compute, repetitions)

    def warn(self, text: str) -> None:
        """See `Observer.warn`."""
        print(f"\nquintet: {text}", file=sys.stderr, flush=True)

    def ends_early(self, coupling: Coupling) -> None:
        """See `Observer.ends_early`."""
        self._keep(coupling)

    def _interval(self, coupling: Coupling) -> float:
        """Wall time until the next snapshot [s]."""
        if self._restart_points:
            return max(RESTARTABLE, COST * self._cost)
        usual = sum(component.timing.usual for component in coupling.components.values())
        return SNAPSHOT_INTERVAL if usual < 0.5 * ENDING else max(OFTEN, COST * self._cost)

    def _keep(self, coupling: Coupling) -> None:
        """Make a snapshot, with all rows written that the run had until then."""
        began = time.monotonic()
        if self._recorder:
            self._recorder.sync()
        checks = {name: file.check for name, file in self._files.items()}
        save(coupling, self.scene, self.folder, self.logs, self._judgement, checks)
        self._kept = time.monotonic()
        self._cost = self._kept - began
        if self._restart_points:
            self._restart_points.note()

    def wants_end(self) -> bool:
        """See `Observer.wants_end`."""
        return self.stop()

    def _record(self, coupling: Coupling) -> None:
        if self._recorder:
            for name, component in coupling.components.items():
                instant = Instant(self._windows.time, self._windows.now, component.stable)
                outputs = coupling.outputs[name]  # error bars may look at more of them
                self._recorder.add(
                    name, instant, {key: outputs[key] for key in self._recorded[name]}
                )

    def _note(self, coupling: Coupling) -> None:
        """Ask every component for its totals, and for what there is to see of it."""
        totals = {}
        for name, component in coupling.components.items():
            # Again for pictures: planes without edges are shown where the bodies have come to.
            drawn = self._meets_picture(self._windows.now)
            again = drawn or name in self._moving_walls
            walls = self._shows and (name not in self._asked or again)
            answer = component.call("view", shown=self._shows, walls=walls)
            totals[name] = answer.header["totals"]
            if walls:
                if answer.header.get("walls_move"):
                    self._moving_walls.add(name)
                self._write_walls(name, answer.fields, drawn)
                self._asked.add(name)
            shown = {k: v for k, v in answer.fields.items() if not k.startswith(WALLS)}
            if "points" in shown:
                units = answer.header["units"]
                self._file(name, units).append(self._windows.time, shown)
        coupling.ledger.note(self._windows.time, totals)

    def _file(self, name: str, units: Mapping[str, str]) -> VtkHdf:
        file = self._files.get(name)
        if file is None:
            file = VtkHdf(self.folder / view_file(name), units, self.scene.headline)
            self._files[name] = file
        return file

    def _write_walls(self, name: str, fields: Fields, drawn: bool) -> None:
        """Write what stands still around a component into a file of its own, with one step.

        Walls that move have a step for each view. Those that stand are written once, and again
        for pictures; a run that goes on has them from before.
        """
        walls = {k.removeprefix(WALLS): v for k, v in fields.items() if k.startswith(WALLS)}
        path = self.folder / walls_file(name)
        if "points" not in walls:
            return
        if name in self._moving_walls:
            if name not in self._wall_files:
                self._wall_files[name] = self._file_of_walls(path)
            self._wall_files[name].append(self._windows.time, walls)
        elif drawn or self.first is None or not path.is_file():
            file = VtkHdf(path, scene=self.scene.headline)
            file.append(0.0, walls)
            file.close()

    def _file_of_walls(self, path: Path) -> VtkHdf:
        """Begin a file of walls that move, or go on with that of an earlier run."""
        if self.first is not None and path.is_file():
            return resume(path, self._began, None)
        return VtkHdf(path, scene=self.scene.headline)

    def close(self) -> None:
        """Close all files, however the run ended."""
        with contextlib.ExitStack() as stack:  # all, even if one cannot be written
            files = (*self._files.values(), *self._wall_files.values())
            for closed in (*files, self._recorder, self._progress):
                if closed:
                    stack.callback(closed.close)
