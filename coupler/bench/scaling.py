"""A cost model for each series of cases that ``quintet bench`` has measured on several ranks."""

import argparse
import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from quintet.coupler.bench.cost_model import (
    CostModel,
    Measurement,
    Network,
    Terms,
    fit,
    of_measurement,
    of_model,
)
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import unknown

ENOUGH = 3  # numbers of ranks from which `bench` fits a model
NEEDED = ("series", "items", "ranks", "imbalance", "messages", "halo_bytes", "cpu_seconds")
Row = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Scaling:
    """A series of cases, its model, and what is predicted of it.

    Parameters
    ----------
    kind, series : str
    measurements : tuple of Measurement
        By items, then by ranks.
    model : CostModel
    here : Network
        As measured.
    network : Network
        That is assumed.
    assumed : tuple of str
        Which of its numbers were given: latency, bandwidth.
    items : float
        Of all ranks, for strong scaling.
    each : float
        Of each rank, for weak scaling.
    cores : int
        Of the host on which it was measured.
    unit : str
        Of the rate of a measurement.
    """

    kind: str
    series: str
    measurements: tuple[Measurement, ...]
    model: CostModel
    here: Network
    network: Network
    assumed: tuple[str, ...]
    items: float
    each: float
    cores: int
    unit: str

    def terms(self, items: float, ranks: int) -> Terms:
        """Time of a step by the model."""
        return of_model(self.model, self.network, items, ranks)

    def measured(self, measurement: Measurement) -> Terms:
        """Time of a step of measured compute and counted messages."""
        return of_measurement(measurement, self.network)

    def fitted(self, m: Measurement) -> Terms:
        """The same by the model, with the imbalance that was measured there."""
        return of_model(self.model, self.network, m.items, m.ranks, m.imbalance)


def measurement_of(row: Row) -> Measurement:
    """Measurement, from an entry of ``quintet bench --json``."""
    steps, ranks = row["options"]["steps"], row["ranks"]
    return Measurement(
        row["items"],
        ranks,
        row["cpu_seconds"] / steps / ranks,
        row["imbalance"],
        row["messages"],
        row["halo_bytes"],
        row["collectives"],
        row["gathered_bytes"],
        row["wall_seconds"] / steps,
    )


def scalings_of(rows: Sequence[Row], options: argparse.Namespace) -> list[Scaling]:
    """Fit a model to each series of cases that was measured on enough numbers of ranks.

    Of several numbers of threads the lowest counts.
    """
    series = list(dict.fromkeys(row["series"] for row in rows))
    if options.series and options.series not in series:
        raise SceneError(unknown(f"--series {options.series}", options.series, series))
    result = []
    for name in [options.series] if options.series else series:
        of_it = [row for row in rows if row["series"] == name]
        threads = min(row["threads"] for row in of_it)
        of_it = [row for row in of_it if row["threads"] == threads]
        if len({row["ranks"] for row in of_it}) >= ENOUGH:
            result.append(_scaling(of_it, options))
    if not result:
        raise SceneError(
            f"a model of cost needs a series of cases on {ENOUGH} numbers of ranks; there is none. "
            "Measure it: quintet bench KIND --ranks 1 --ranks 2 --ranks 4."
        )
    return result


def _scaling(rows: Sequence[Row], options: argparse.Namespace) -> Scaling:
    if rows[0]["ranks"] != 1 and all(row["ranks"] > 1 for row in rows):
        raise SceneError(f"{rows[0]['series']}: one rank must be among --ranks. Add --ranks 1.")
    ordered = sorted(map(measurement_of, rows), key=lambda m: (m.items, m.ranks))
    largest = max(m.items for m in ordered)
    network = next(row["network"] for row in rows if row.get("network"))
    here = Network(network["latency"], network["bandwidth"])
    wanted = {key: getattr(options, key) for key in ("latency", "bandwidth")}
    assumed = {key: value for key, value in wanted.items() if value is not None}
    return Scaling(
        rows[0]["name"],
        rows[0]["series"],
        tuple(ordered),
        fit(ordered, options.dimensions),
        here,
        here._replace(**assumed),
        tuple(assumed),
        options.items or largest,
        options.items_per_rank or largest,
        network["cores"],
        rows[0]["unit"],
    )


def read_rows(path: Path) -> list[Row]:
    """Read what ``quintet bench KIND --json`` wrote, without models in it."""
    try:
        entries = json.loads(path.read_text(encoding="utf-8"))
        rows = [row for row in entries if "model" not in row]
        whole = all(key in row for row in rows for key in NEEDED)
    except (OSError, ValueError, TypeError, AttributeError) as error:
        raise SceneError(f"{path}: it must be what {WRITER} wrote; {error}.") from error
    if not rows or not whole:
        raise SceneError(f"{path}: it must be what {WRITER} wrote; it is not. Measure again.")
    return rows


WRITER = "quintet bench KIND --ranks 1 --ranks 2 --ranks 4 --json FILE"


def network_entry(network: Network) -> dict[str, float]:
    """What a measurement holds of the network and the host."""
    return {**network._asdict(), "cores": len(os.sched_getaffinity(0))}
