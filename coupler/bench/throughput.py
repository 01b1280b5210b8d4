"""``quintet bench KIND``: throughput of a component in items stepped per second.

Rates are per second of processor time, summed over all threads and ranks without what these wait
for each other, so that they are those of one thread; the rate per second of wall time stands beside
them.
"""

import argparse
import contextlib
import json
import os
import signal
import tempfile
from collections.abc import Collection, Sequence
from itertools import product
from pathlib import Path
from typing import Any

from rich.table import Table

from quintet.coupler.bench.scaling import ENOUGH, network_entry, scalings_of
from quintet.coupler.bench.scaling_report import KEYS, refuse, report
from quintet.coupler.files.json_file import JsonFile
from quintet.coupler.launch.processes import start, tail
from quintet.coupler.report.show import console
from quintet.interfaces.errors import QuintetError, SceneError
from quintet.interfaces.manifest import BenchCase, find, look_in, unknown_kind
from quintet.interfaces.params import unknown

Row = dict[str, Any]


def run_kind(options: argparse.Namespace) -> int:
    """Measure the cases of a kind; print them, and write them as JSON where asked."""
    cases = select_cases(options.name, options.case)
    threads = options.threads or usual_threads()
    if wrong := [count for count in threads if count < 1]:
        raise SceneError(f"--threads must be a whole number from 1; found {wrong[0]}.")
    ranks = options.ranks or (1,)
    refuse_ranks(options.name, ranks)
    modelled = wants_model(options, ranks, [case.series or case.name for _, case in cases])
    rates, wanted = [], JsonFile(options.json, KEYS)
    network = network_here() if max(ranks) > 1 else None
    for number, case in cases:
        for several, count in product(ranks, threads):
            prefix = f"ranks: {several}, " if options.ranks else ""
            print(f"{case.name}, {prefix}threads: {count} ... ", end="", flush=True)
            rates.append(run_case(options.name, number, count, several))
            rates[-1]["network"] = network
            print(f"{rates[-1]['rate']:.3g} {rates[-1]['unit']} a thread", flush=True)
    console().print(table(rates))
    wanted.write(rates)
    if modelled:
        wanted.write([*rates, *report(scalings_of(rates, options), options)])
    return 0


def wants_model(options: argparse.Namespace, ranks: Sequence[int], series: Collection[str]) -> bool:
    """Whether a model of cost is fitted; raise where it is asked for and cannot be."""
    refuse(options)
    if options.series and options.series not in series:
        raise SceneError(unknown(f"--series {options.series}", options.series, series))
    enough = len(set(ranks)) >= ENOUGH and 1 in ranks
    if options.plot and not enough:
        raise SceneError(
            f"--plot needs a model of cost, and that {ENOUGH} numbers of ranks, 1 among them; "
            f"found {', '.join(map(str, ranks))}. Give --ranks 1 --ranks 2 --ranks 4."
        )
    return enough


def network_here() -> Row:
    """Latency, bandwidth and cores of this host."""
    # Start-up: only a component of several ranks needs it.
    from quintet.coupler.bench.ping_pong import measure_network

    return network_entry(measure_network())


def refuse_ranks(kind: str, ranks: Sequence[int]) -> None:
    """Raise where a number of ranks is none, or more than a kind can have."""
    if wrong := [count for count in ranks if count < 1]:
        raise SceneError(f"--ranks must be a whole number from 1; found {wrong[0]}.")
    if max(ranks) > 1 and not find(kind).ranks:
        raise SceneError(
            f"--ranks must be 1, for kind {kind} computes on one rank; found {max(ranks)}. Give it "
            "threads."
        )


def select_cases(kind: str, names: Collection[str]) -> list[tuple[int, BenchCase]]:
    """Find the cases of a kind, or those that are named."""
    look_in([str(Path.cwd())] if ":" in kind else [])
    try:
        cases = find(kind).cases()
    except KeyError as error:
        raise SceneError(unknown_kind(f"bench {kind}", kind, ["exchange"])) from error
    except ImportError as error:
        raise SceneError(f"bench {kind}: it cannot be imported ({error}).") from error
    if not cases:
        raise SceneError(f"bench {kind}: it declares no case. Name a function as Manifest.bench.")
    known = [case.name for case in cases]
    if wrong := [name for name in names if name not in known]:
        raise SceneError(unknown(f"bench {kind}: case {wrong[0]}", wrong[0], known))
    return [(n, case) for n, case in enumerate(cases) if not names or case.name in names]


def usual_threads() -> Sequence[int]:
    """One thread, and two where there are two cores."""
    return (1, 2) if len(os.sched_getaffinity(0)) > 1 else (1,)


def run_case(kind: str, number: int, threads: int, ranks: int = 1) -> Row:
    """Measure a case in child processes, with memory and compiled kernels of their own."""
    with tempfile.TemporaryDirectory() as folder:
        log, file = Path(folder) / "log", Path(folder) / "found.json"
        line = ["-m", "quintet.coupler.bench.worker", kind, str(number), str(threads), str(file)]
        launcher: list[str] = []
        if ranks > 1:
            # Start-up: only a component of several ranks needs it.
            from quintet.coupler.launch.mpi_job import find_launcher

            line = ["-m", "mpi4py", *line, str(ranks)]
            launcher = [*find_launcher(), "-n", str(ranks)]
        process = start(line, log, threads, launcher=launcher)
        try:
            status = process.wait()
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)  # ranks too
        if status:
            lines = "\n".join(f"    {text}" for text in tail(log))
            raise QuintetError(f"bench {kind}: it ended with status {status}:\n{lines}")
        return dict(json.loads(file.read_text()))


def table(rates: Sequence[Row]) -> Table:
    """One row for each case and number of ranks and threads; ranks if any case has several."""
    screen_table = Table(box=None, pad_edge=False)
    several = any(row["ranks"] > 1 for row in rates)
    cores = ("ranks", "threads") if several else ("threads",)
    rest = ("waits",) if several else ()
    heads = ("case", "items", *cores, "per CPU-s", "per s", "speed-up", "unit", "bytes/item", *rest)
    for head in heads:
        screen_table.add_column(head, justify="left" if head in ("case", "unit") else "right")
    alone = {row["case"]: row["wall_rate"] for row in rates if row["threads"] == row["ranks"] == 1}
    for row in rates:
        ratio = row["wall_rate"] / alone[row["case"]] if row["case"] in alone else 0.0
        screen_table.add_row(
            row["case"],
            str(row["items"]),
            *(str(row[name]) for name in cores),
            f"{row['rate']:.3g}",
            f"{row['wall_rate']:.3g}",
            f"{ratio:.2f}" if ratio else "",
            row["unit"],
            f"{row['bytes_per_item']:.0f}",
            *(f"{row['waits']:.1%}" for _ in rest),
        )
    return screen_table
