"""What the runs of a study say: orders and limits by kind, shares of the error, the cheapest."""

import math
from typing import Any

from quintet.coupler.measures.convergence import Limit, Order, as_table, observed_order, richardson
from quintet.coupler.measures.error_split import Trend, shares
from quintet.coupler.run import results
from quintet.coupler.scene.study_table import KINDS

Row = dict[str, Any]
RECOMMENDED = ("label", "settings", "cpu", "wall", "errors", "relative")


def conclude(scene: str, rows: list[Row]) -> Row:
    """Compare the refinements; see `quintet study` in scenarios/README.md for its parts."""
    done = [row for row in rows if row["status"] == "done"]
    good = [row for row in done if row["met"]]
    cheapest = min(good, key=lambda row: float(row["cpu"]), default=None)
    return {
        "scene": scene,
        "rows": rows,
        "has_expectations": any(row["values"] for row in rows),
        "kinds": {kind: _kind(kind, done) for kind in KINDS if _ladder(kind, done)},
        "recommended": {key: cheapest[key] for key in RECOMMENDED} if cheapest else None,
        "machine": results.machine(),
    }


def _ladder(kind: str, rows: list[Row]) -> list[Row]:
    """Refinements of a kind that have a size, from coarse to fine."""
    ladder = [row for row in rows if kind in row["ladders"]]
    return sorted(ladder, key=lambda row: -float(row["sizes"][kind]))


def names_of(rows: list[Row]) -> list[str]:
    """Names of what is compared."""
    return list(dict.fromkeys(name for row in rows for name in row["errors"]))


def _kind(kind: str, rows: list[Row]) -> Row:
    ladder = _ladder(kind, rows)
    trends = {name: trend_of(name, kind, rows) for name in names_of(rows)}
    return {
        "refinements": [row["label"] for row in ladder],
        "orders": {name: as_table(trend.order) for name, trend in trends.items()},
        "limits": {name: as_table(trend.limit) for name, trend in trends.items()},
    }


def trend_of(name: str, kind: str, rows: list[Row]) -> Trend:
    """How one expectation falls with the size of one kind."""
    ladder = [row for row in _ladder(kind, rows) if row["errors"].get(name) is not None]
    # Errors against the finest of one kind are not comparable with those against another run.
    ladder = [row for row in ladder if "compared_with" not in row or row["kind"] == kind]
    sizes = [row["sizes"][kind] for row in ladder]
    errors = [row["errors"][name] for row in ladder]
    values = [row["values"].get(name) for row in ladder]
    limit = richardson(sizes, values) if None not in values else None
    return Trend(limit, observed_order(sizes, errors, _finest(kind, ladder, rows)))


def _finest(kind: str, ladder: list[Row], rows: list[Row]) -> float:
    """Size of the run that errors are taken against; 0 where they are against a reference."""
    targets = {row.get("compared_with") for row in ladder}
    return min((row["sizes"][kind] for row in rows if row["label"] in targets), default=0.0)


def shares_at(label: str | None, all_rows: list[Row]) -> Row | None:
    """Shares of the error of the recommended refinement; without one, of the finest.

    With several kinds that is the one with the least product of all sizes, whatever their units.
    """
    rows = [row for row in all_rows if row["status"] == "done"]
    chosen = [row for row in rows if row["label"] == label]
    sized = chosen or [row for row in rows if row["ladders"] and row["errors"]]
    row = min(sized, key=lambda row: math.prod(row["sizes"].values()), default=None)
    kinds: list[str] = [kind for kind in KINDS if _ladder(kind, rows)]
    if row is None or not kinds:
        return None
    split = {}
    for name in row["errors"]:
        trends = {kind: trend_of(name, kind, rows) for kind in kinds}
        value = row["values"].get(name)
        error = None if value is None else value - row["references"][name]
        if row["errors"][name] is not None:
            split[name] = shares(trends, row["sizes"], error)
    return {"label": row["label"], "of": split}


def stored(kind: Row, name: str) -> Trend:
    """Read a trend back from what was concluded of a kind."""
    limit, order = kind["limits"].get(name), kind["orders"].get(name)
    return Trend(Limit(**limit) if limit else None, Order(**order) if order else None)
