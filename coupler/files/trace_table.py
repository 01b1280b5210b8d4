"""The table of a trace, ``trace.csv``: its columns, its limit, and how it is read."""

import csv
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from quintet.interfaces.errors import SceneError

# Who did what; times in ns since the start: order begun, sent, answer awaited, answered; ns that a
# component was busy; number of the window; steps, or repetitions; length of the window [s].
COLUMNS = ("who", "what", "begin", "sent", "awaited", "end", "busy", "window", "count", "value")
COUPLER = "(coupler)"  # no component has such a name
RUN, FULL = "(run)", "full"
LIMIT = 20_000_000  # bytes of the file, about 300 000 rows; later ones are left out
SECOND = 1_000_000_000  # ns


@dataclass(frozen=True, slots=True)
class TraceRow:
    """One row; times in ns since the run's first start."""

    who: str
    what: str
    begin: int
    sent: int
    awaited: int
    end: int
    busy: int
    window: int
    count: int
    value: float


def whole_rows(path: Path) -> int:
    """Length of the whole rows of a file [bytes]; 0 where there is none."""
    if not path.is_file():
        return 0
    return path.read_bytes().rfind(b"\n") + 1


def read_rows(path: Path) -> Iterator[TraceRow]:
    """Read the rows of a trace; of a run that was resumed all parts, each as late as it was."""
    text = path.read_bytes()[: whole_rows(path)].decode(errors="replace")
    lines = csv.reader(text.splitlines())
    if tuple(next(lines, ())) != COLUMNS:
        raise SceneError(
            f"{path}: it must begin with the columns {','.join(COLUMNS)}; it does not. Run the "
            "scene again with --trace."
        )
    first, shift = 0.0, 0
    for number, cells in enumerate(lines, 2):
        try:
            who, what, *counts, value = cells
            begin, sent, awaited, end, busy, window, count = map(int, counts)
            seconds = float(value)
        except ValueError as error:
            raise SceneError(
                f"{path}: line {number} must have {len(COLUMNS)} cells, the last 8 numbers; found "
                f"{','.join(cells)[:80]!r}. Run the scene again with --trace."
            ) from error
        if (who, what) != (RUN, FULL) and who == RUN:
            first = first or seconds
            shift = max(0, round((seconds - first) * SECOND))
        begin, sent, awaited, end = (time + shift for time in (begin, sent, awaited, end))
        yield TraceRow(who, what, begin, sent, awaited, end, busy, window, count, seconds)
