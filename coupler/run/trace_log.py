"""The trace of a run: when each order went out, was answered, and what the coupler did meanwhile.

Loaded by runs with ``output.trace`` only. ``coupler/report/chrome_trace.py`` reads the table.
Times are of the coupler's clock, in ns since the start; of a component only durations are known, as
it may run on another host.
"""

import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from quintet.coupler.coupling.participant import Participant
from quintet.coupler.coupling.schedule import Coupling
from quintet.coupler.files.table_file import TableFile
from quintet.coupler.files.trace_table import COLUMNS, COUPLER, FULL, LIMIT, RUN, whole_rows
from quintet.interfaces.component import Fields
from quintet.interfaces.lines.message import Frame, Message, Shapes
from quintet.interfaces.lines.transport import WatchedLine

JOINED = 2e-5  # s between two mappings that are written as one
NANO = 1e9  # ns in 1 s


class TraceLog:
    """Writes a row for each order, mapping and window, as far as the file's limit."""

    def __init__(self, path: Path, transport: str, resumes: bool) -> None:
        """Begin the file; go on after the last whole row of it where the run resumes."""
        self._zero = time.perf_counter()
        size = whole_rows(path) if resumes else 0
        self._table = TableFile(path, size)
        if not size:
            self._table.write(COLUMNS)
        self._full = False
        self._mapping = (0.0, 0.0)  # s, begin and end of the last, not yet written
        self._window_began = self._zero  # s
        self._windows, self._repetitions, self._time = -1, 0, 0.0
        self._write(RUN, transport, self._zero, value=time.time())

    def attach(self, coupling: Coupling) -> None:
        """Watch the lines to all components, and the mappings of a coupling and of its groups."""
        for name, participant in coupling.components.items():
            participant.line = TracedLine(participant.line, self._recorder(name, participant))
        couplings = [coupling]
        for each in couplings:
            each.on_mapping = self._note_mapping
            couplings += [m.inner for m in each.members.values() if m.inner is not None]

    def _recorder(self, name: str, participant: Participant) -> "Recorder":
        built_from = participant.asked  # it was built since then

        def record(times: tuple[float, float, float, float], header: Mapping[str, Any],
                   answer: Mapping[str, Any]) -> None:  # fmt: skip
            order, begin = header["order"], times[0]
            if order == "describe":
                seconds = float(answer.get("seconds", 0.0))
                self._write(name, "build", built_from, end=built_from + seconds)
                begin = max(begin, built_from + seconds)
                times = (begin, begin, max(begin, times[2]), max(begin, times[3]))
            busy = answer.get("busy" if order == "advance" else "seconds", 0.0)
            what = f"trial {order}" if header.get("trial") else order
            counts = header.get("window", 0), answer.get("steps", 0)
            self._write(name, what, *times, busy=float(busy), counts=counts)

        return record

    def _note_mapping(self, begin: float, end: float) -> None:
        first, last = self._mapping
        if begin - last > JOINED or not last:
            self._end_mapping()
            first = begin
        self._mapping = first, end

    def _end_mapping(self) -> None:
        (begin, end), self._mapping = self._mapping, (0.0, 0.0)
        if end:
            self._write(COUPLER, "mapping", begin, end=end)

    def after_window(self, coupling: Coupling) -> None:
        """Note that all of a window is written, or that the first begins."""
        now, windows = time.perf_counter(), coupling.windows
        self._end_mapping()
        if windows.done > self._windows >= 0:
            repetitions = coupling.costs.repetitions - self._repetitions
            length = windows.time - self._time
            counts = windows.done - 1, repetitions
            self._write(COUPLER, "window", self._window_began, end=now, counts=counts, value=length)
        self._window_began, self._repetitions = now, coupling.costs.repetitions
        self._windows, self._time = windows.done, windows.time

    def _write(
        self,
        who: str,
        what: str,
        begin: float,
        sent: float = 0.0,
        awaited: float = 0.0,
        end: float = 0.0,
        busy: float = 0.0,
        counts: tuple[int, int] = (0, 0),
        value: float = 0.0,
    ) -> None:
        """Add a row, of times of the clock [s]; of what did not happen the begin is written."""
        if self._full:
            return
        if self._table.size > LIMIT:
            who, what, self._full = RUN, FULL, True
        times = [round((max(t, begin) - self._zero) * NANO) for t in (begin, sent, awaited, end)]
        self._table.write([who, what, *times, round(busy * NANO), *counts, value])

    def close(self) -> None:
        """Write out all rows and close the file; a second call does nothing."""
        self._end_mapping()
        self._table.close()


# Called with the times at which an order began, was sent, awaited, answered; order; answer.
Recorder = Callable[[tuple[float, float, float, float], Mapping[str, Any], Mapping[str, Any]], None]


class TracedLine:
    """The line of a component; each answer is recorded with its times."""

    def __init__(self, line: WatchedLine, record: Recorder) -> None:
        self._line, self._record = line, record
        self._order: Mapping[str, Any] = {"order": ""}
        self._begin = self._sent = 0.0  # s

    @property
    def watch(self) -> Callable[[], str]:
        """See `WatchedLine.watch`."""
        return self._line.watch

    @watch.setter
    def watch(self, watch: Callable[[], str]) -> None:
        self._line.watch = watch

    def send(self, header: Mapping[str, Any], fields: Fields) -> None:
        """See `Line.send`."""
        self._order, self._begin = header, time.perf_counter()
        self._line.send(header, fields)
        self._sent = time.perf_counter()

    def receive(self, seconds: float, expected: Shapes | None = None) -> Message:
        """See `Line.receive`."""
        awaited = time.perf_counter()
        message = self._line.receive(seconds, expected)
        times = self._begin, self._sent, awaited, time.perf_counter()
        answer = message.header if message.order == "done" else {}
        self._record(times, self._order, answer)
        return message

    def peek(self) -> Frame | None:
        """See `WatchedLine.peek`."""
        return self._line.peek()

    def close(self) -> None:
        """See `Line.close`."""
        self._line.close()
