"""Time series: reading them from a file, cutting and measuring them."""

import math
from pathlib import Path
from typing import NamedTuple

import numpy as np

from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError


class Curve(NamedTuple):
    """A time series."""

    times: Array  # (m,) s
    values: Array  # (m,); (m, k) of k items, for measures of waves


def read(path: Path, where: str, second: float = 1.0) -> Curve:
    """Read a time series from CSV: two columns, one header line, comments begin with #.

    Parameters
    ----------
    path : Path
    where : str
        Beginning of the error messages.
    second : float, s
        One unit of the file's times.
    """
    if path.exists() and not path.is_file():
        raise SceneError(f"{where} must be a text file beside the scene; {path} is none. Name it.")
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, ValueError) as error:  # a name with a zero, bytes that are no text
        raise SceneError(
            f"{where} must be a text file beside the scene; {error}. Put it there."
        ) from error
    texts = [(n, line.partition("#")[0].strip()) for n, line in enumerate(lines, 1)]
    rows = [(n, text.split(",")) for n, text in texts if text]
    if rows and _numbers(rows[0][1]) is not None:
        raise SceneError(f"{where}: line {rows[0][0]} must be a header, as t_s,x_m. Add one.")
    times, values = _columns(where, rows[1:])
    return Curve(second * times, values)


def _columns(where: str, rows: list[tuple[int, list[str]]]) -> Curve:
    if len(rows) < 2:
        raise SceneError(f"{where} must have two lines of numbers or more; found {len(rows)}.")
    numbers: list[tuple[float, float]] = []
    for line, texts in rows:
        row = _numbers(texts)
        if row is None:
            raise SceneError(
                f"{where}: line {line} must be two finite numbers; found {','.join(texts)!r}. "
                "Correct it."
            )
        if numbers and row[0] <= numbers[-1][0]:
            raise SceneError(f"{where}: times must increase; line {line} has {row[0]:g}.")
        numbers.append(row)
    times, values = np.array(numbers).T
    return Curve(times, values)


def _numbers(texts: list[str]) -> tuple[float, float] | None:
    try:
        time, value = (float(text) for text in texts)
    except ValueError:
        return None
    return (time, value) if math.isfinite(time) and math.isfinite(value) else None


def between(curve: Curve, begin: float, end: float) -> Curve:
    """Cut a curve to a time interval, its ends interpolated, as far as the curve reaches.

    Values are (m,), or (m, k) of k curves.
    """
    times, values = curve
    begin, end = max(begin, times[0]), min(end, times[-1])
    inside = (times > begin) & (times < end)
    cut = np.concatenate([[begin], times[inside], [end]]) if end > begin else np.array([end])
    if values.ndim > 1:
        return Curve(cut, np.stack([np.interp(cut, times, row) for row in values.T], axis=1))
    return Curve(cut, np.interp(cut, times, values))


def points_between(curve: Curve, begin: float, end: float) -> Curve:
    """Points of a curve in a time interval, its ends included; there may be none."""
    inside = (curve.times >= begin) & (curve.times <= end)
    return Curve(curve.times[inside], curve.values[inside])


def mean(curve: Curve) -> float:
    """Mean over time."""
    span = curve.times[-1] - curve.times[0]
    return float(np.trapezoid(curve.values, curve.times) / span if span else curve.values[0])


def moving_mean(curve: Curve, span: float) -> Curve:
    """Mean over a span [s] about every time; at the ends over what there is of it."""
    times, values = curve
    steps = np.diff(times) * 0.5 * (values[1:] + values[:-1])
    total = np.concatenate([[0.0], np.cumsum(steps)])  # integral so far
    first = np.maximum(times - 0.5 * span, times[0])
    last = np.minimum(times + 0.5 * span, times[-1])
    whole = np.interp(last, times, total) - np.interp(first, times, total)
    return Curve(times, whole / (last - first))


def integral(curve: Curve) -> float:
    """Integral over time, by trapezia."""
    return float(np.trapezoid(curve.values, curve.times))


def crossing(curve: Curve, level: float) -> float:
    """First time at which a level is crossed; nan if never."""
    times, above = curve.times, curve.values - level
    passed = np.flatnonzero(above[:-1] * above[1:] <= 0.0)
    if not len(passed):
        return math.nan
    k = int(passed[0])
    if above[k] == above[k + 1]:  # both on the level
        return float(times[k])
    part = above[k] / (above[k] - above[k + 1])
    return float(times[k] + part * (times[k + 1] - times[k]))


def distance(curve: Curve, target: Curve, relative: bool) -> float:
    """Root mean square of curve - target over the target's times; nan where it has none.

    Relative: over the root mean square of the target.
    """
    if not len(target.times):
        return math.nan
    error = np.interp(target.times, *curve) - target.values
    size = float(np.sqrt(np.mean(error**2)))
    return size / float(np.sqrt(np.mean(target.values**2))) if relative else size
