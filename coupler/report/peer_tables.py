"""Tables of other programs beside a study: errors and CPU times, run by run."""

from collections.abc import Sequence
from typing import Any

from rich.table import Table

from quintet.coupler.report.work_precision import COSTS, three_digits

Row = dict[str, Any]


def title_of(peer: Row) -> str:
    """Name of a program with its version."""
    return f"{peer['program']} {peer['version']}".strip()


def beside_table(peer: Row, rows: Sequence[Row]) -> Table:
    """One column for each run of quintet and of a program: error of each measure, CPU time.

    Parameters
    ----------
    peer : dict
        An entry of `peers` of ``study.json``.
    rows : sequence of dict
        Those of the study.
    """
    runs = [*rows, *peer["rows"]]
    units = {name: unit for row in peer["rows"] for name, unit in row["units"].items()}
    table = Table(box=None, pad_edge=False)
    for number, head in enumerate(["", *(row["label"] for row in runs)]):
        table.add_column(head, justify="right" if number else "left", overflow="fold")
    table.add_row("", *len(rows) * ["quintet"], *len(peer["rows"]) * [peer["program"]])
    table.add_row("", *map(_state, runs))
    for name, unit in units.items():
        errors = [row["errors"].get(name) for row in runs]
        table.add_row(f"error of {name} [{unit}]", *map(three_digits, errors))
    for words, costs in _costs(peer, rows).items():
        table.add_row(f"{words} [s]", *map(three_digits, costs))
    return table


def _costs(peer: Row, rows: Sequence[Row]) -> dict[str, list[float | None]]:
    """Costs [s] of all runs by their kind; None where a kind was not measured."""
    nothing: list[float | None] = [None for _ in rows]
    costs = {COSTS["cpu"]: [row["cpu"] for row in rows] + len(peer["rows"]) * [None]}
    if peer["cost"] != "process":
        measured = costs.setdefault(COSTS[peer["cost"]], nothing)
        measured[len(rows) :] = [row["cpu"] for row in peer["rows"]]
    whole = [row.get("cpu_process") or None for row in [*rows, *peer["rows"]]]
    return costs | {COSTS["process"]: whole}


def _state(row: Row) -> str:
    if row["status"] != "done" or row["met"] is None:
        return str(row["status"])
    return "met" if row["met"] else "not met"


def beside_words(peer: Row, rows: Sequence[Row]) -> list[str]:
    """What was compared, and on how quiet a machine."""
    runs = [row for row in [*rows, *peer["rows"]] if "load" in row]
    loads, cores = [row["load"] for row in runs], sorted({row["cores"] for row in runs})
    sentences = [
        f"{title_of(peer)}: {peer['settings']}. Inputs: {peer['source']}.",
    ]
    if peer["cost"] != "cpu":
        sentences.append(
            f"the time of {peer['program']} is its {COSTS[peer['cost']]}; that of quintet "
            f"{COSTS['cpu']}: compare orders of magnitude only"
        )
    if loads:
        sentences.append(
            f"load of the machine as runs began: {min(loads):.1f} to {max(loads):.1f} on "
            f"{' or '.join(map(str, cores))} cores"
        )
    return sentences
