"""Margins of controls: a table for the screen, and one for a text in Markdown."""

from collections.abc import Iterable, Iterator
from typing import Any

from rich.table import Table

HEADS = ("expectation", "control", "value", "reference", "within", "margin", "base")
TEXTS = ("scene", "expectation", "control", "verdict")
Row = dict[str, Any]


def screen_table(scene: str, rows: Iterable[Row]) -> Table:
    """One line for each expectation and control of a scene."""
    table = Table(box=None, pad_edge=False, title=scene, title_justify="left")
    for head in (*HEADS, "verdict"):
        table.add_column(head, justify="left" if head in TEXTS else "right", overflow="fold")
    for row in rows:
        table.add_row(*_cells(row), row["verdict"])
    return table


def markdown(scenes: Iterable[Row]) -> Iterator[str]:
    """Lines of one table of all scenes, as text in Markdown."""
    heads = ("scene", *HEADS)
    yield f"| {' | '.join(heads)} |"
    yield f"|{'|'.join('---' if head in TEXTS else '---:' for head in heads)}|"
    for scene in scenes:
        for row in scene["rows"]:
            yield f"| {' | '.join((scene['scene'], *_cells(row)))} |"


def _cells(row: Row) -> list[str]:
    unit = row["unit"] if row["unit"] not in (None, "1") else ""
    is_infinite = None not in (row["value"], row["within"]) and row["margin"] is None
    return [
        row["expectation"],
        row["control"] or "-",
        f"{_number(row['value'])} {unit}".strip(),
        _number(row["reference"]),
        _number(row["within"]),
        "∞" if is_infinite else _number(row["margin"], 3),
        _number(row["base_margin"], 2),
    ]


def _number(value: float | None, digits: int = 4) -> str:
    return "-" if value is None else f"{value:.{digits}g}"
