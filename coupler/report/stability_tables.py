"""Limits of stability: a table for the screen, and one of all scenes for a README."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from rich.console import Console
from rich.table import Table

from quintet.coupler.report.work_precision import three_digits

NUMBERS = ("predicted", "found", "ratio", "degraded")  # of a limit, in the table
HEADS = ("scene", "limit of", "at", "predicted", "by", "found", "ratio", "what breaks first")
Row = dict[str, Any]


def with_unit(path: str, units: Mapping[str, str]) -> str:
    """A key with its unit, if it has one."""
    return f"{path} [{units[path]}]" if path in units else path


def print_limits(limits: Sequence[Row], units: Mapping[str, str], screen: Console) -> None:
    """Print a line of numbers for each limit, then how each was found."""
    screen.print(table(limits, units))
    for sentence in sentences(limits):
        screen.print(sentence)


def table(limits: Sequence[Row], units: Mapping[str, str]) -> Table:
    """One row of numbers for each limit."""
    columns = ["limit", "against", "predicted", "found", "ratio", "degraded", "then"]
    if all(limit["degraded"] is None for limit in limits):
        columns.remove("degraded")
    screen_table = Table(box=None, pad_edge=False)
    for head in columns:
        right = head in NUMBERS
        screen_table.add_column(head, justify="right" if right else "left", overflow="fold")
    for limit in limits:
        cells = {key: three_digits(limit[key]) for key in columns if key in NUMBERS}
        name = _name(limit, units)
        cells |= {"limit": name, "against": _against(limit), "then": limit["state"] or "-"}
        screen_table.add_row(*(cells[head] for head in columns))
    return screen_table


def sentences(limits: Sequence[Row]) -> Iterator[str]:
    """Say how each limit was found."""
    for limit in limits:
        place = f" at {against}" if (against := _against(limit)) else ""
        yield f"{limit['name']}{place}: {_how(limit)}"


def _name(limit: Row, units: Mapping[str, str]) -> str:
    """Name of a limit, with the unit of its parameter; a factor of several has none."""
    parameter = limit["parameter"]
    unit = units.get(parameter) if isinstance(parameter, str) else None
    return f"{limit['name']} [{unit}]" if unit else str(limit["name"])


def _against(limit: Row) -> str:
    return ", ".join(f"{k} = {three_digits(v)}" for k, v in (limit["against"] or {}).items())


def _how(limit: Row) -> str:
    if not limit.get("complete", True):
        return f"search interrupted after {len(limit['runs'])} runs; repeat the command to continue"
    if limit["found"] is not None:
        return f"{limit['broke']}: {limit['how']}"
    first, last = limit["range"]
    if limit["broke"]:
        return f"at {first:g} already: {limit['broke']}: {limit['how']}"
    return f"holds from {first:g} to {last:g}"


def markdown(scenes: Sequence[Row]) -> Iterator[str]:
    """Lines of one table of all scenes; numbers in SI units."""
    yield f"| {' | '.join(HEADS)} |"
    yield "|---|---|---|---:|---|---:|---:|---|"
    for scene in scenes:
        for number, limit in enumerate(scene["limits"]):
            cells = [
                f"`{scene['scene']}`" if number == 0 else "",
                limit["name"],
                _against(limit),
                three_digits(limit["predicted"]),
                limit["source"],
                three_digits(limit["found"]),
                three_digits(limit["ratio"]),
                limit["broke"] or "-",
            ]
            yield f"| {' | '.join(cell.replace('|', ' ') for cell in cells)} |"
