"""The table of all studies for a README."""

from collections.abc import Iterator, Sequence
from typing import Any

from quintet.coupler.report.work_precision import three_digits

HEADS = (
    "study", "refinement", "refines", "largest relative error", "order", "processor time",
    "memory", "measured",
)  # fmt: skip
Row = dict[str, Any]


def table_of(studies: Sequence[Row]) -> str:
    """One row of Markdown for each refinement of each scene."""
    lines = ["| " + " | ".join(HEADS) + " |", "|" + len(HEADS) * "---|"]
    for study in studies:
        for number, row in enumerate(study["rows"]):
            name = f"`quintet study {study['scene']}`" if number == 0 else ""
            cells = [name, row["label"], row["kind"], *_measured(row, study)]
            lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def _measured(row: Row, study: Row) -> Iterator[str]:
    """Error, order, costs, and when and on what they were measured."""
    if row["status"] != "done":
        yield from ("-", "-", "-", "-")
        about = f"about {_time(row['seconds'])}" if "seconds" in row else str(row["status"])
        yield f"not measured: {about}"
        return
    known = {n: e for n, e in row["relative"].items() if e is not None and n in row["required"]}
    name = max(known, key=lambda name: known[name]) if known else ""
    yield f"{three_digits(100.0 * known[name])} % ({name})" if name else "-"
    yield _order(study["kinds"].get(row["kind"]), name)
    yield _time(row["cpu"])
    yield f"{row['memory'] / 1e6:.0f} MB" if row["memory"] else "-"
    yield f"{row['date']}, {row['on']['cpu']}, {row['on']['cores']} cores"


def _order(kind: Row | None, name: str) -> str:
    """Order of an expectation, with its interval where there is one."""
    order = kind["orders"].get(name) if kind else None
    if order is None:
        return "-"
    if order["low"] is None:
        return f"{order['order']:.1f}"
    return f"{order['order']:.1f} ({order['low']:.1f} to {order['high']:.1f})"


def _time(seconds: float) -> str:
    return f"{three_digits(seconds)} s" if seconds < 100.0 else f"{seconds / 60.0:.1f} min"
