"""Invariants of a run: its verdict is stable, degraded or unstable."""

import csv
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from quintet.coupler.files.recording import NAME, Recording
from quintet.coupler.scene.stability_table import Bounds, Energy, LimitTable
from quintet.interfaces.errors import SceneError

ROWS = 256  # of a recording, read at once
State = Literal["stable", "degraded", "unstable"]
Breach = tuple[float, str, str]  # s, invariant, how


@dataclass(frozen=True, slots=True)
class Verdict:
    """Verdict on a run, with the first violated invariant, how and when it was violated."""

    state: State
    broke: str = ""
    how: str = ""
    time: float | None = None  # s


def judge(limit: LimitTable, run: dict[str, Any], folder: Path) -> Verdict:
    """Judge a run by its results, its ledger and its recording."""
    breaches = list(_breaches(limit, run, folder))
    if breaches:
        # A failure is known at the end of a window; a violated invariant within it came first.
        time, broke, how = min(breaches, key=lambda breach: (breach[0], breach[1] == "failed"))
        return Verdict("unstable", broke, how, time)
    for outcome in run.get("expect", []):
        if outcome["name"] in limit.expectation and not outcome["met"]:
            value = (
                "no value"
                if outcome["value"] is None
                else f"{outcome['value']:.4g} {outcome['unit']}"
            )
            how = f"{outcome['name']} is {value}, not {outcome['reference']:.4g} within "
            how += f"{outcome['within']:.4g}"
            return Verdict("degraded", "expectation", how, run["time"])
    return Verdict("stable")


def _breaches(limit: LimitTable, run: dict[str, Any], folder: Path) -> Iterator[Breach]:
    if run["status"] == "stalled":
        yield run.get("time", 0.0), "failed", "it takes too long: its steps became too small"
    elif run["status"] != "done":
        yield run.get("time", 0.0), "failed", run.get("fault", {}).get("cause", "no results")
    ledger = folder / "ledger.csv"
    if ledger.is_file():
        with open(ledger, newline="") as file:
            rows = [row for row in csv.DictReader(file) if None not in row.values()]
        if limit.energy:
            if run["status"] == "done" and not any(energies(rows).values()):
                raise SceneError(
                    "stability: energy must be given by the totals of a component; all are 0 J at "
                    "all times. Give it totals(), or use bounds instead."
                )
            yield from _energy(limit.energy, rows)
        if limit.momentum is not None:
            yield from _momentum(limit.momentum, rows)
    if limit.bounds and (folder / NAME).is_file():
        try:
            with Recording(folder) as recording:
                for bounds in limit.bounds:
                    yield from _bounds(bounds, recording)
        except SceneError as error:  # a process that died left it half written
            yield run.get("time", 0.0), "failed", str(error)


def energies(rows: list[dict[str, str]]) -> dict[float, float]:
    """Total energy of all components, less works from outside [J], at every time [s]."""
    total: dict[float, float] = {}
    for row in rows:
        if row["kinetic"]:
            parts = [float(row[kind]) for kind in ("kinetic", "potential", "internal")]
            parts.append(-float(row["work"]))
            total[float(row["time"])] = total.get(float(row["time"]), 0.0) + sum(parts)
    return total


def _energy(rule: Energy, rows: list[dict[str, str]]) -> Iterator[Breach]:
    total = energies(rows)
    if not total:
        return
    start = next(iter(total.values()))
    most = rule.amount if rule.factor is None else (rule.factor - 1.0) * abs(start)
    assert most is not None
    for time, energy in total.items():
        if not energy - start <= most:  # also of nan
            how = f"the total energy rose from {start:.4g} J to {energy:.4g} J"
            if rule.factor is not None and start == 0.0:
                how += "; energy.factor of 0 J allows no rise, give energy.amount"
            yield time, "energy", how
            return


def _momentum(most: float, rows: list[dict[str, str]]) -> Iterator[Breach]:
    for row in rows:
        residual = float(row["momentum_residual"] or 0.0)
        if not residual <= most:
            how = f"the momentum residual of {row['name']} is {residual:.1e}"
            yield float(row["time"]), "momentum", how
            return


def _bounds(rule: Bounds, recording: Recording) -> Iterator[Breach]:
    times = recording.times(rule.component)
    low = -math.inf if rule.low is None else rule.low
    high = math.inf if rule.high is None else rule.high
    for first in range(0, len(times), ROWS):
        rows = recording.field(rule.component, rule.field, slice(first, first + ROWS))
        if rule.axis is not None:
            rows = rows[:, :, rule.axis]
        rows = rows.reshape(len(rows), -1)
        outside = ~((rows >= low) & (rows <= high)).all(axis=1)
        if outside.any():
            k = int(np.argmax(outside))
            worst = float(rows[k][np.argmax(np.maximum(rows[k] - high, low - rows[k]))])
            how = f"{rule.component}.{rule.field} reached {worst:.4g}"
            yield float(times[first + k]), "bounds", how
            return
