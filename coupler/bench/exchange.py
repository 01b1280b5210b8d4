"""``quintet bench exchange``: the time that one exchange with a component takes.

A window is that of a run: an order with a field is sent, checked, taken, given back and checked
again, with sums on both sides; the component computes nothing. It is compared with the round
trip of the same bytes over the library alone, on the same machine.
"""

import argparse
import json
import os
import statistics
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

from quintet.coupler.bench.raw_transport import round_trip
from quintet.coupler.coupling.participant import Participant
from quintet.coupler.files.json_file import JsonFile
from quintet.coupler.launch.connect import connect
from quintet.coupler.launch.mpi_job import begin_rank, end_rank, run_under_mpi
from quintet.coupler.launch.watchdog import Watchdog
from quintet.coupler.run.signals import StopRequest
from quintet.coupler.scene.read import load
from quintet.coupler.scene.scene import Scene

SIZES = {100: 5000, 10_000: 2000, 100_000: 300}  # items of three doubles: windows measured
WARM = 100  # windows before the clock starts
TRANSPORTS = ("zenoh", "mpi")
SCENE = """
name = "exchange"
end = 1.0
window = 1.0
transport = "{transport}"
[components.echo]
kind = "echo"
items = {items}
"""


def run_bench(options: argparse.Namespace) -> int:
    """Measure the exchange; print the cases, and write them as JSON where asked."""
    if options.inside_mpi:
        return inside_mpi(Path(os.environ[FOLDER]))
    rates, wanted = [], JsonFile(options.json, ("name", "case", "rate"))
    for transport in [options.transport] if options.transport else TRANSPORTS:
        for items, windows in SIZES.items():
            with tempfile.TemporaryDirectory() as folder:
                rates.append(measure(transport, items, windows, Path(folder)))
            rates[-1]["library_ms"] = 1e3 * round_trip(transport, 24 * items, windows)
            print(sentence(rates[-1]), flush=True)
            wanted.write(rates)  # after each, so that a later one that fails costs none of it
    return 0


FOLDER = "QUINTET_BENCH"  # where a coupler started by mpiexec finds its scene


def measure(transport: str, items: int, windows: int, folder: Path) -> dict[str, Any]:
    """Time windows with one component that returns what it takes."""
    path = folder / "scene.toml"
    path.write_text(SCENE.format(transport=transport, items=items))
    (folder / "windows").write_text(str(windows))
    scene = load(str(path))
    (folder / "run" / "log").mkdir(parents=True)
    if transport == "mpi":
        os.environ[FOLDER] = str(folder)
        run_under_mpi(["bench", "exchange"], scene, folder / "run")
    else:
        exchange(scene, folder, windows)
    return dict(json.loads((folder / "found.json").read_text()))


def inside_mpi(folder: Path) -> int:
    """Measure as the coupler's rank of an MPI job."""
    begin_rank(folder / "run")
    exchange(load(str(folder / "scene.toml")), folder, int((folder / "windows").read_text()))
    end_rank(folder / "run", 0)
    return 0


def exchange(scene: Scene, folder: Path, windows: int) -> None:
    """Join the component, time its windows, and write the result to a file."""
    connection = connect(scene, folder / "run", Watchdog(StopRequest()))
    part = connection.participants["echo"]
    part.call("describe")
    part.bind({}, works=[])
    value = np.random.default_rng(1).random(part.give()["returned.value"].shape)
    part.call("prime", {"passed.value": value})
    took, spent = windows_of(part, value, windows)
    connection.close(True)
    result = {
        "name": "exchange",
        "case": f"{scene.transport}, {value.nbytes / 1e3:g} kB each way",
        "items": len(value),
        "threads": 1,
        "rate": 1.0 / statistics.median(took),
        "unit": "windows/s",
        "median_ms": 1e3 * statistics.median(took),
        "p99_ms": 1e3 * float(np.quantile(took, 0.99)),
        "cpu_seconds": spent,
        "wall_seconds": sum(took),
        "options": {"transport": scene.transport, "windows": windows},
    }
    (folder / "found.json").write_text(json.dumps(result))


def windows_of(part: Participant, value: np.ndarray, windows: int) -> tuple[list[float], float]:
    """Exchange over many windows; return the time of each and the processor time of all [s]."""
    took = []
    spent = 0.0
    for window in range(WARM + windows):
        if window == WARM:
            spent = time.process_time()
        began = time.perf_counter()
        part.start(1.0, {"passed.value": value}, ["passed.value"])
        answer = part.finish()
        took.append(time.perf_counter() - began)
        if answer.fields["returned.value"][-1, -1] != value[-1, -1]:
            print("the echo is not what was sent", file=sys.stderr)
            raise SystemExit(1)
    return took[WARM:], time.process_time() - spent


def sentence(rate: dict[str, Any]) -> str:
    """Describe one case in a line."""
    return (
        f"{rate['case']}: median {rate['median_ms']:.3f} ms, p99 {rate['p99_ms']:.3f} ms, "
        f"{rate['rate']:.0f} {rate['unit']}; the library alone {rate['library_ms']:.3f} ms"
    )
