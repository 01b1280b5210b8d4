"""``quintet trace``: the trace of a run as Chrome trace JSON, for ui.perfetto.dev.

The format is "Trace Event Format" (Google, 2016, docs.google.com/document/d/1CvAClvFfyA5R-PhYUmn5O
OQtYMH4h6I0nSsKchNAySU): complete events (ph X) with times in µs, counters (C), names (M). A track
holds the slices of one component, or of the coupler.
"""

import json
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from quintet.coupler.files.disk import reporting_disk
from quintet.coupler.files.run_files import TRACE, read_marker
from quintet.coupler.files.trace_table import COUPLER, FULL, LIMIT, RUN, TraceRow, read_rows
from quintet.interfaces.errors import SceneError

Event = dict[str, Any]
PROCESS = 1  # all tracks belong to it
MICRO = 1e3  # ns in 1 µs
NAMES = {"advance": "step", "trial advance": "trial step", "prepare": "compile"}


def write_chrome_trace(folder: Path, out: Path) -> tuple[Path, bool]:
    """Write the trace of a run; return where, and whether it is of the whole run."""
    marker, table = read_marker(folder), folder / TRACE
    if marker is None or marker.kind != "run":
        raise SceneError(f"{folder}: it must be the folder of a run; it is not. Name another.")
    if not table.is_file():
        raise SceneError(
            f"{folder}: it must have a trace ({TRACE}); this run was made without. Run the scene "
            "again with quintet run --trace, or with trace = true in its [output]."
        )
    rows = list(read_rows(table))
    content = {
        "traceEvents": events(rows, marker.scene),
        "displayTimeUnit": "ms",
        "otherData": {"scene": marker.scene},
    }
    with reporting_disk(out):
        out.parent.mkdir(parents=True, exist_ok=True)
        out.write_text(json.dumps(content, separators=(",", ":")), encoding="utf-8")
    return out, not any(row.what == FULL for row in rows)


def cut_short(folder: Path) -> str:
    """Say that a trace ends before its run."""
    return (
        f"{folder}: the trace ends before the run: {TRACE} is limited to {LIMIT / 1e6:g} MB. Run "
        "fewer windows to see the end."
    )


def events(rows: Iterable[TraceRow], scene: str) -> list[Event]:
    """All events of a trace, in order of time; names of the tracks first."""
    rows = sorted(rows, key=lambda row: row.begin)
    names = dict.fromkeys([COUPLER, *(row.who for row in rows if row.who != RUN)])
    tracks = {name: number for number, name in enumerate(names, 1)}
    in_process = False
    slices: list[Event] = []
    ended: dict[str, int] = {}  # ns, the last slice of each component
    for row in rows:
        if row.who == RUN:
            in_process = row.what == "memory" if row.what != FULL else in_process
            ended = {}  # a resumed run: nobody waited in between
        elif row.who == COUPLER:
            slices += _of_coupler(row, tracks[COUPLER])
        else:
            slices += _waits(row, tracks[COUPLER], in_process)
            slices += _of_component(row, tracks[row.who], ended.get(row.who), in_process)
            ended[row.who] = row.end
    # Of slices that begin together the longer one is the outer one.
    slices.sort(key=lambda event: (event["ts"], -event.get("dur", 0.0)))
    return [*_names(tracks, scene), *slices]


def _names(tracks: dict[str, int], scene: str) -> Iterator[Event]:
    yield _event("M", "process_name", 0, 0, args={"name": f"quintet {scene}"})
    for name, track in tracks.items():
        label = "coupler" if name == COUPLER else name
        yield _event("M", "thread_name", 0, track, args={"name": label})
        yield _event("M", "thread_sort_index", 0, track, args={"sort_index": track})


def _of_coupler(row: TraceRow, track: int) -> Iterator[Event]:
    if row.what != "window":
        yield _slice(row.what, row.begin, row.end, track, row.what)
        return
    counts = {"window": row.window, "repetitions": row.count, "length [s]": row.value}
    yield _slice(f"window {row.window}", row.begin, row.end, track, "window", counts)
    yield _event("C", "window [s]", row.begin, track, args={"length": row.value})
    yield _event("C", "repetitions", row.begin, track, args={"repetitions": row.count})


def _waits(row: TraceRow, track: int, in_process: bool) -> Iterator[Event]:
    """What the coupler does with an order: sends it, and waits for the answer."""
    if row.what == "build":
        return
    args = {"order": row.what}
    send, wait = (f"send to {row.who}", "exchange"), (f"wait for {row.who}", "wait")
    if in_process:  # there the order is carried out as it is sent
        send, wait = wait, (f"read answer of {row.who}", "exchange")
    yield _slice(send[0], row.begin, row.sent, track, send[1], args)
    yield _slice(wait[0], row.awaited, row.end, track, wait[1], args)


def _of_component(
    row: TraceRow, track: int, ended: int | None, in_process: bool
) -> Iterator[Event]:
    """What a component does: waits for its order, computes, answers.

    Where the coupler listened to others first, the component waited until its answer was read.
    """
    if ended is not None and row.begin > ended:
        yield _slice("wait", ended, row.begin, track, "wait")
    name = NAMES.get(row.what, row.what)
    if row.what not in NAMES:
        yield _slice(name, row.begin, row.end, track, "build" if name == "build" else "order")
        return
    done = min(row.begin + row.busy, row.end)
    answered = max(done, row.sent) if in_process else done
    read = min(max(answered, row.awaited), row.end)
    yield _slice(name, row.begin, done, track, name, {"window": row.window, "steps": row.count})
    if answered > done:
        yield _slice("exchange", done, answered, track, "exchange", {"window": row.window})
    if read > answered:
        yield _slice("wait", answered, read, track, "wait")
    yield _slice("exchange", read, row.end, track, "exchange", {"window": row.window})


def _slice(
    name: str, begin: int, end: int, track: int, category: str, args: Event | None = None
) -> Event:
    dur = max(0, end - begin) / MICRO
    return _event("X", name, begin, track, dur=dur, cat=category, args=args or {})


def _event(kind: str, name: str, time: int, track: int, **more: Any) -> Event:
    return {"ph": kind, "name": name, "ts": time / MICRO, "pid": PROCESS, "tid": track, **more}
