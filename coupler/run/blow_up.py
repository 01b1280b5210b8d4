"""The neighbourhood of an item whose state became invalid, written for ParaView."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from quintet.coupler.coupling.participant import ComponentFailed
from quintet.coupler.files import vtkhdf_reader
from quintet.coupler.files.run_files import failure_file, view_file
from quintet.coupler.files.vtkhdf import VtkHdf
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import QuintetError

NEAREST = 250  # points: a ball of some four spacings in space, nine in a plane
BROKEN = (ValueError, TypeError, IndexError, KeyError, QuintetError)  # by what a view is none


def write_neighbourhood(folder: Path, error: ComponentFailed, time: float, scene: str) -> str:
    """Write the points around the item at fault, now and in the last view; say where.

    Parameters
    ----------
    time : float, s
        At the end of the last window that was done.
    scene : str
        What ran.

    Returns
    -------
    str
        A sentence; "" where the component showed nothing.
    """
    if not error.shown:
        return ""
    path = folder / failure_file(error.component)
    try:
        now = _points_only(error.shown)
        earlier = _last_view(folder / view_file(error.component), len(now["points"]))
        rows = _nearest(now["points"], error.place, earlier[1] if earlier else None)
        steps = [*([earlier] if earlier else []), (time, now)]
        _write(path, steps, rows, error.units, scene)
    except BROKEN as broken:
        return f"its neighbourhood was not written: {broken}"
    ends = "at the last view and when it failed" if earlier else "when it failed"
    return f"the {len(rows)} points nearest to it, {ends}, are in {path.name}, for ParaView"


def _points_only(view: Fields) -> dict[str, Array]:
    """Points of a view and the fields that have a row for each."""
    count = len(view["points"])
    return {key: array for key, array in view.items() if len(array) == count and key != "cells"}


def _last_view(path: Path, count: int) -> tuple[float, dict[str, Array]] | None:
    """Time [s] and points of the last view of a file, if it has the same points."""
    if not path.is_file() or not (steps := len(vtkhdf_reader.times(path))):
        return None
    time, view = vtkhdf_reader.read_step(path, steps - 1)
    return (time, _points_only(view)) if len(view["points"]) == count else None


def _nearest(points: Array, place: Array, earlier: dict[str, Array] | None) -> Array:
    """Rows of the points nearest to a place; where it is none, to where it was before."""
    placed = np.isfinite(points).all(axis=1)
    if not np.isfinite(place).all():
        lost = np.flatnonzero(~placed)
        if not len(lost):
            raise ValueError("the item at fault is at no place, and all that are shown are")
        if earlier is None:
            return lost[:NEAREST]
        points, place = earlier["points"], earlier["points"][lost[0]]
        placed = np.isfinite(points).all(axis=1)
    distance = np.where(placed, np.linalg.norm(points - place, axis=1), np.inf)
    return np.sort(np.argsort(distance, kind="stable")[:NEAREST])


def _write(
    path: Path,
    steps: list[tuple[float, dict[str, Array]]],
    rows: Array,
    units: Mapping[str, str],
    scene: str,
) -> None:
    names = set.intersection(*(set(view) for _, view in steps))
    file = VtkHdf(path, {key: unit for key, unit in units.items() if key in names}, scene)
    try:
        for time, view in steps:
            file.append(time, {key: view[key][rows] for key in view if key in names})
    finally:
        file.close()
