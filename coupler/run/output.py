"""What a run writes while it goes, and how it tells of its progress."""

import contextlib
import os
import signal
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING

from rich.progress import BarColumn, Progress, TextColumn, TimeRemainingColumn

from quintet.coupler.coupling.schedule import Coupling
from quintet.coupler.scene.scene import Scene
from quintet.interfaces.component import Fields
from quintet.interfaces.lines.process_status import running
from quintet.interfaces.serving.process import STARTER

if TYPE_CHECKING:
    from quintet.coupler.files.recording import Recorder
    from quintet.coupler.files.vtkhdf import VtkHdf

OFTEN = 600.0  # s of wall time between two snapshots, where the scene does not say how often
EVERY = 5.0  # s between two lines of progress where there is no terminal


class Stop:
    """Whether the user, or the batch system, asked for an end, or nobody is there any more."""

    asked = False

    def __init__(self) -> None:
        self._starter = int(os.environ.get(STARTER, "0"))  # who cleans up after it

    def __call__(self) -> bool:
        """Tell whether to end."""
        return self.asked or (self._starter > 0 and not running(self._starter))

    @contextlib.contextmanager
    def listening(self) -> Iterator[None]:
        """Turn Ctrl-C and SIGTERM into a wish, to be granted between windows; twice is an order."""

        def ask(number: int, _: FrameType | None) -> None:
            if self.asked:
                raise KeyboardInterrupt
            self.asked = True
            print(f"\n{signal.Signals(number).name}: ending after this window", file=sys.stderr)

        old = {one: signal.signal(one, ask) for one in (signal.SIGINT, signal.SIGTERM)}
        try:
            yield
        finally:
            for one, handler in old.items():
                signal.signal(one, handler)


class Meter:
    """Progress with speed, time left and the ledger's residual: a bar, or a line now and then."""

    def __init__(self, windows: int, end: float, first: int = 0) -> None:
        self.windows, self.end, self.first = windows, end, first
        self._began = self._told = time.monotonic()
        self._bar = self._make_bar() if sys.stdout.isatty() else None
        if self._bar:
            self._bar.start()
            self._task = self._bar.add_task("", total=windows, speed="", residual="")

    def _make_bar(self) -> Progress:
        columns = (
            TextColumn("{task.completed}/{task.total}"),
            BarColumn(),
            TextColumn("{task.fields[speed]}"),
            TimeRemainingColumn(),
            TextColumn("{task.fields[residual]}"),
        )
        return Progress(*columns, refresh_per_second=4)

    def show(self, window: int, residual: float) -> None:
        """Tell how far it is."""
        now = time.monotonic()
        speed = (window - self.first) / max(now - self._began, 1e-9)
        if self._bar:
            texts = {"speed": f"{speed:.3g} windows/s", "residual": f"momentum {residual:.0e}"}
            self._bar.update(self._task, completed=window, **texts)  # type: ignore[arg-type]
        elif now - self._told >= EVERY or window in (1, self.windows):
            self._told = now
            left = (self.windows - window) / speed
            print(
                f"window {window}/{self.windows}, t = {window * self.end / self.windows:.4g} s, "
                f"{speed:.3g} windows/s, {left:.0f} s left, momentum residual {residual:.0e}",
                flush=True,
            )

    def close(self) -> None:
        """Leave the terminal as it was."""
        if self._bar:
            self._bar.stop()


class Writer:
    """Writes recording, views and ledger of a run, and moves the meter."""

    def __init__(self, scene: Scene, folder: Path, stop: Stop, first: int | None = None) -> None:
        """Write from the start, or go on after the first windows of a run that was there."""
        self.scene, self.folder, self.stop, self.first = scene, folder, stop, first
        self.done, self.time = first or 0, 0.0  # windows, s
        self._kept = time.monotonic()  # when the last snapshot was made
        self._snapshots = 0  # windows between two; 0: by the clock
        self._every = 0  # windows between two views
        self._often = 0  # windows between two rows of the ledger
        self._recorder: Recorder | None = None
        self._meter: Meter | None = None
        self._files: dict[str, VtkHdf] = {}
        self._began = 0.0  # s, simulated

    def begin(self, coupling: Coupling, described: dict[str, Fields], windows: int) -> None:
        """See `Witness.begin`."""
        interval, scene = self.scene.file.output.interval, self.scene
        self._every = max(1, round(interval / coupling.dt)) if interval else 0
        totals = scene.file.output.totals
        self._often = max(1, round(totals / coupling.dt)) if totals else 0
        snapshots = scene.file.output.snapshots
        self._snapshots = max(1, round(snapshots / coupling.dt)) if snapshots else 0
        self.time = self._began = self.done * coupling.dt
        if scene.file.output.record:
            self._recorder = self._recording(described)
        if self.first is None:
            self._record(coupling, 0.0)
            self._note(coupling, 0.0)
        self._meter = Meter(windows, scene.file.end, self.done)

    def _recording(self, described: dict[str, Fields]) -> "Recorder":
        from quintet.coupler.files.recording import NAME, Recorder

        path = self.folder / NAME
        if self.first is not None:
            return Recorder.resume(path, self.first + 1)
        made = Recorder(path, self.folder.name, (self.folder / "scene.toml").read_text())
        for name, one in self.scene.components.items():
            made.component(name, one.gives, described[name])
        return made

    def due(self, window: int) -> bool:
        """See `Witness.due`."""
        return any(often and (window + 1) % often == 0 for often in (self._every, self._often))

    def end_window(self, coupling: Coupling, window: int) -> None:
        """See `Witness.end_window`."""
        self.done, self.time = window, window * coupling.dt
        self._record(coupling, self.time)
        if self._every and window % self._every == 0:
            self._note(coupling, self.time)
        elif self._often and window % self._often == 0:
            coupling.ledger.note(self.time, dict(coupling.ledger.totals))
        if self._meter:
            self._meter.show(window, coupling.ledger.worst)
        late = time.monotonic() - self._kept > OFTEN
        if window % self._snapshots == 0 if self._snapshots else late:
            self._keep(coupling, window)

    def ends_early(self, coupling: Coupling, window: int) -> None:
        """See `Witness.ends_early`."""
        self._keep(coupling, window)

    def _keep(self, coupling: Coupling, window: int) -> None:
        """Make a snapshot, with all rows written that the run had until then."""
        from quintet.coupler.run.snapshots import save

        if self._recorder:
            self._recorder.flush()
        save(coupling, self.scene, self.folder, window)
        self._kept = time.monotonic()

    def wants_end(self) -> bool:
        """See `Witness.wants_end`."""
        return self.stop()

    def _record(self, coupling: Coupling, time: float) -> None:
        if self._recorder:
            for name, fields in coupling.outputs.items():
                self._recorder.add(name, time, fields)

    def _note(self, coupling: Coupling, time: float) -> None:
        """Ask every component for its totals and its picture."""
        totals = {}
        for name, part in coupling.parts.items():
            answer = part.ask("view")
            totals[name] = answer.header["totals"]
            if self._every and "points" in answer.fields:
                self._file(name).append(time, answer.fields)
        coupling.ledger.note(time, totals)

    def _file(self, name: str) -> "VtkHdf":
        from quintet.coupler.files.vtkhdf import VtkHdf, go_on

        found = self._files.get(name)
        if found is None:
            path = self.folder / f"{name}.vtkhdf"
            is_there = self.first is not None and path.is_file()
            found = go_on(path, self._began) if is_there else VtkHdf(path)
            self._files[name] = found
        return found

    def close(self) -> None:
        """Finish all files: what was computed is kept, however the run ended."""
        if self._meter:
            self._meter.close()
        if self._recorder:
            self._recorder.close()
        for file in self._files.values():
            file.close()
