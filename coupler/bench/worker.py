"""Worker process of a benchmark: measures one case.

``python -m quintet.coupler.bench.worker KIND NUMBER THREADS FILE`` writes its result into FILE.
The component is made twice. The first compiles all kernels and is dropped; what the process's
resident memory grows by until the second has made its lists and come through its first steps is
the component's own.
"""

import ctypes
import gc
import json
import os
import sys
import time
from pathlib import Path
from typing import Any

from quintet.interfaces.component import Component, fields_of
from quintet.interfaces.manifest import BenchCase, Manifest, find, look_in
from quintet.interfaces.serving.process import build


def measure(manifest: Manifest, case: BenchCase, threads: int) -> dict[str, Any]:
    """Time one case; return its entry of ``quintet bench --json``."""
    order = {"params": case.params, "threads": threads}
    component = begin(manifest, order, case)
    advance(component, case.warm, case)
    del component
    before = resident()
    component = begin(manifest, order, case)
    advance(component, case.warm, case)
    growth = resident() - before
    items = component.items()
    spent, began = time.process_time(), time.perf_counter()
    advance(component, case.steps, case)
    wall, cpu = time.perf_counter() - began, time.process_time() - spent
    return {
        "name": manifest.kind,
        "case": case.name,
        "items": items,
        "threads": threads,
        "rate": items * case.steps / cpu,  # per second of processor time, that of all threads
        "wall_rate": items * case.steps / wall,
        "unit": case.unit,
        "cpu_seconds": cpu,
        "wall_seconds": wall,
        "bytes_per_item": growth / items,
        "options": {"steps": case.steps, "warm": case.warm, "params": case.params},
    }


def begin(manifest: Manifest, order: dict[str, Any], case: BenchCase) -> Component:
    """Make the component with the ports and fields of the case."""
    component = build(manifest, order)
    joined = frozenset(key.partition(".")[0] for key in (*case.static, *case.fields))
    component.bind(case.static, joined)
    component.take(case.fields)
    return component


def advance(component: Component, steps: int, case: BenchCase) -> None:
    """Advance by many stable steps, taking and giving fields at each."""
    wanted = frozenset(fields_of(component.gives))
    for _ in range(steps):
        component.take(case.fields)
        component.step(component.stable_dt())
        component.give(wanted)


def resident() -> int:
    """Resident memory of this process after freed memory was returned [bytes]."""
    gc.collect()
    ctypes.CDLL(None).malloc_trim(0)
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


if __name__ == "__main__":
    kind, number, threads, file = sys.argv[1:]
    look_in([str(Path.cwd())] if ":" in kind else [])
    known = find(kind)
    result = measure(known, known.cases()[int(number)], int(threads))
    Path(file).write_text(json.dumps(result))
