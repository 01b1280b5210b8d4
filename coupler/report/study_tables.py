"""Tables of a study for the screen: errors and costs, orders and limits, shares of the error."""

from collections.abc import Sequence
from typing import Any

from rich.table import Table

from quintet.coupler.report.work_precision import three_digits

Row = dict[str, Any]
MEGA = 1e6  # bytes
NOTHING: Row = {"errors": {}, "relative": {}}  # of a refinement that measures something else


def _table(*heads: str) -> Table:
    table = Table(box=None, pad_edge=False)
    for number, head in enumerate(heads):
        table.add_column(head, justify="right" if number else "left", overflow="fold")
    return table


def costs_and_errors(rows: Sequence[Row]) -> Table:
    """One column for each refinement, one row for each expectation's error and each cost."""
    summary = _table("", *(row["label"] for row in rows))

    def add(name: str, values: Sequence[float | None]) -> None:
        if any(value is not None for value in values):
            summary.add_row(name, *map(three_digits, values))

    summary.add_row("", *map(_state, rows))
    # Refinements may measure different quantities by the same name.
    for name, unit in dict.fromkeys(pair for row in rows for pair in row["units"].items()):
        of_unit: list[Row] = [row if row["units"].get(name) == unit else NOTHING for row in rows]
        add(f"error of {name} [{unit}]", [row["errors"].get(name) for row in of_unit])
        relative = [row["relative"].get(name) for row in of_unit]
        if unit != "1":
            add("  relative [%]", [None if e is None else 100.0 * e for e in relative])
    summary.add_row("refines", *(row["kind"] for row in rows))
    sized = list(dict.fromkeys(row["kind"] for row in rows if row["size"] is not None))
    for kind in sized:
        name = "size" if len(sized) == 1 else f"size of the {kind}"
        add(name, [row["size"] if row["kind"] == kind else None for row in rows])
    add("CPU [s]", [row["cpu"] for row in rows])
    add("wall [s]", [row["wall"] for row in rows])
    for name in dict.fromkeys(name for row in rows for name in row["components"]):
        parts = [row["components"].get(name, {}) for row in rows]
        add(f"  {name}: CPU [s]", [part.get("cpu") for part in parts])
        add(f"  {name}: wall [s]", [part.get("compute") for part in parts])
        add(f"  {name}: memory [MB]", [_mega(part.get("memory")) for part in parts])
    add("exchange [s]", [row["exchange"] for row in rows])
    add("mapping [s]", [row["mapping"] for row in rows])
    shares = [None if row["overhead"] is None else 100.0 * row["overhead"] for row in rows]
    add("coupling [%]", shares)
    add("memory [MB]", [_mega(row["memory"]) for row in rows])
    add("energy [J]", [row.get("energy") for row in rows])
    summary.add_row("items", *(str(row["items"]) for row in rows))
    return summary


def _mega(value: float | None) -> float | None:
    return value / MEGA if value else None


def _state(row: Row) -> str:
    """Status; of a run that is done, whether all its expectations are met, if it has any."""
    if row["status"] != "done" or row["met"] is None:
        return str(row["status"])
    return "met" if row["met"] else "not met"


def orders(kinds: Row) -> Table:
    """One row for each kind and expectation: order, interval, limit."""
    table = _table("refined", "quantity", "order", "95 %", "order, 3 finest", "limit", "±")
    for kind, found_in_kind in kinds.items():
        for name, order in found_in_kind["orders"].items():
            limit = found_in_kind["limits"][name]
            if order is None and limit is None:
                table.add_row(kind, name, "not observed")
                continue
            three = f"{limit['order']:.2f}" if limit else "-"
            value = f"{limit['value']:.6g}" if limit else "-"
            width = three_digits(limit["uncertainty"]) if limit else "-"
            table.add_row(kind, name, *order_words(order), three, value, width)
    return table


def order_words(order: Row | None) -> tuple[str, str]:
    """Order and interval as they are printed."""
    if order is None:
        return "-", "-"
    low, high = order["low"], order["high"]
    interval = "-" if low is None else f"{low:.2f} to {high:.2f}"
    return f"{order['order']:.2f}", interval


def shares(split: Row) -> Table:
    """One row for each expectation, one column for each kind: shares of its error in per cent."""
    kinds = list(dict.fromkeys(kind for parts in split["of"].values() for kind in parts))
    table = _table(f"share of the error at {split['label']} [%]", *kinds)
    for name, parts in split["of"].items():
        cells = [parts.get(kind) for kind in kinds]
        table.add_row(name, *("-" if c is None else f"{100.0 * c:.0f}" for c in cells))
    return table
