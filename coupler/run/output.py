"""Output during a run: recording, views, ledger, snapshots."""

import time
from pathlib import Path

from quintet.coupler.coupling.schedule import Coupling
from quintet.coupler.files.recording import NAME, Recorder
from quintet.coupler.files.vtkhdf import VtkHdf, resume
from quintet.coupler.run.progress import ProgressReport
from quintet.coupler.run.signals import StopRequest
from quintet.coupler.run.snapshots import save
from quintet.coupler.scene.scene import Scene
from quintet.interfaces.component import Fields

SNAPSHOT_INTERVAL = 600.0  # s of wall time between two snapshots, where the scene gives none


class OutputWriter:
    """Writes recording, views and ledger of a run, and shows its progress."""

    def __init__(
        self, scene: Scene, folder: Path, stop: StopRequest, first: int | None = None
    ) -> None:
        """Begin the files, or continue them after the first windows of an earlier run."""
        self.scene, self.folder, self.stop, self.first = scene, folder, stop, first
        self.done, self.time = first or 0, 0.0  # windows, s
        self._last_snapshot = time.monotonic()  # when the last snapshot was made
        self._snapshot_every = 0  # windows between two; 0: by the clock
        self._view_every = 0  # windows between two views
        self._ledger_every = 0  # windows between two rows of the ledger
        self._recorder: Recorder | None = None
        self._progress: ProgressReport | None = None
        self._files: dict[str, VtkHdf] = {}
        self._began = 0.0  # s, simulated

    def begin(self, coupling: Coupling, described: dict[str, Fields], windows: int) -> None:
        """See `Witness.begin`."""
        interval, scene = self.scene.file.output.interval, self.scene
        self._view_every = max(1, round(interval / coupling.dt)) if interval else 0
        totals = scene.file.output.totals
        self._ledger_every = max(1, round(totals / coupling.dt)) if totals else 0
        snapshots = scene.file.output.snapshots
        self._snapshot_every = max(1, round(snapshots / coupling.dt)) if snapshots else 0
        self.time = self._began = self.done * coupling.dt
        if scene.file.output.record:
            self._recorder = self._recording(described)
        if self.first is None:
            self._record(coupling, 0.0)
            self._note(coupling, 0.0)
        self._progress = ProgressReport(windows, scene.file.end, self.done)

    def _recording(self, described: dict[str, Fields]) -> Recorder:
        path = self.folder / NAME
        if self.first is not None:
            return Recorder.resume(path, self.first + 1)
        made = Recorder(path, self.folder.name, (self.folder / "scene.toml").read_text())
        for name, one in self.scene.components.items():
            made.component(name, one.gives, described[name])
        return made

    def due(self, window: int) -> bool:
        """See `Witness.due`."""
        return any(
            every and (window + 1) % every == 0 for every in (self._view_every, self._ledger_every)
        )

    def end_window(self, coupling: Coupling, window: int) -> None:
        """See `Witness.end_window`."""
        self.done, self.time = window, window * coupling.dt
        self._record(coupling, self.time)
        if self._view_every and window % self._view_every == 0:
            self._note(coupling, self.time)
        elif self._ledger_every and window % self._ledger_every == 0:
            coupling.ledger.note(self.time, dict(coupling.ledger.totals))
        if self._progress:
            self._progress.show(window, coupling.ledger.worst)
        late = time.monotonic() - self._last_snapshot > SNAPSHOT_INTERVAL
        if window % self._snapshot_every == 0 if self._snapshot_every else late:
            self._save_snapshot(coupling, window)

    def ends_early(self, coupling: Coupling, window: int) -> None:
        """See `Witness.ends_early`."""
        self._save_snapshot(coupling, window)

    def _save_snapshot(self, coupling: Coupling, window: int) -> None:
        """Write a snapshot, after all rows of the recording up to it."""
        if self._recorder:
            self._recorder.flush()
        save(coupling, self.scene, self.folder, window)
        self._last_snapshot = time.monotonic()

    def wants_end(self) -> bool:
        """See `Witness.wants_end`."""
        return self.stop()

    def _record(self, coupling: Coupling, time: float) -> None:
        if self._recorder:
            for name, fields in coupling.outputs.items():
                self._recorder.add(name, time, fields)

    def _note(self, coupling: Coupling, time: float) -> None:
        """Write the totals and the view of every component."""
        totals = {}
        for name, part in coupling.parts.items():
            answer = part.ask("view")
            totals[name] = answer.header["totals"]
            if self._view_every and "points" in answer.fields:
                self._file(name).append(time, answer.fields)
        coupling.ledger.note(time, totals)

    def _file(self, name: str) -> VtkHdf:
        found = self._files.get(name)
        if found is None:
            path = self.folder / f"{name}.vtkhdf"
            is_there = self.first is not None and path.is_file()
            found = resume(path, self._began) if is_there else VtkHdf(path)
            self._files[name] = found
        return found

    def close(self) -> None:
        """Close all files, however the run ended."""
        if self._progress:
            self._progress.close()
        if self._recorder:
            self._recorder.close()
        for file in self._files.values():
            file.close()
