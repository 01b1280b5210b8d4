"""A study without expectations: each refinement is compared with the finest of its kind.

Compared is what the runs recorded: the mean over all items of each field, over time. Numbers of
items may differ between refinements; those means need not.
"""

import math
from pathlib import Path
from typing import Any

import numpy as np

from quintet.coupler.files.recording import Recording
from quintet.coupler.files.run_files import RECORDING
from quintet.coupler.measures.time_series import Curve
from quintet.interfaces.component import fields_of

ROWS = 256  # of a recording that are read at once
Row = dict[str, Any]


def compare_with_finest(rows: list[Row], folders: dict[str, Path]) -> None:
    """Give each row that is done its errors against the finest of its kind, by fields.

    They are root mean squares over time, relative to how far the finest run's field moves from its
    own mean over time; of a field that stands still, relative to its size.

    Parameters
    ----------
    rows : list of dict
        Of the study; they are changed.
    folders : dict
        Folder of each run, by label.
    """
    done = [row for row in rows if row["status"] == "done"]
    curves = {row["label"]: mean_curves(folders[row["label"]] / RECORDING) for row in done}
    for row in done:
        target = finest_of(row, done)
        row["compared_with"] = target["label"]
        if target is not row:
            errors = differences(curves[row["label"]], curves[target["label"]])
            names = dict.fromkeys(errors, 1.0)
            row |= {"errors": errors, "relative": dict(errors), "scales": names}
            row |= {"units": dict.fromkeys(errors, "1"), "required": list(errors)}
            row["within"] = dict.fromkeys(errors)


def finest_of(row: Row, rows: list[Row]) -> Row:
    """Return the finest refinement of a row's kind; of those without a size the last one."""
    kind = row["kind"]
    ladder = [other for other in rows if row["size"] is not None and kind in other["ladders"]]
    if ladder:
        return min(ladder, key=lambda other: float(other["sizes"][kind]))
    return [other for other in rows if other["kind"] == kind and other["size"] is None][-1]


def mean_curves(path: Path) -> dict[str, Curve]:
    """Mean over all items of each field that a run recorded: values (rows, numbers)."""
    if not path.is_file():
        return {}
    curves = {}
    with Recording(path) as recording:
        for name in recording.names:
            times, known = recording.times(name), fields_of(recording.ports(name))
            for field in recording.fields(name):
                if field not in known or not recording.items(name, field)[0] or len(times) < 2:
                    continue
                values = _means(recording, name, field, len(times))
                if known[field].centring == "impulse":  # as a mean rate, at the window's middle
                    rates = values[1:] / np.diff(times)[:, None]
                    curves[f"{name}.{field}"] = Curve((times[1:] + times[:-1]) / 2, rates)
                else:
                    curves[f"{name}.{field}"] = Curve(times, values)
    return curves


def _means(recording: Recording, name: str, field: str, rows: int) -> Any:
    parts = [
        recording.field(name, field, slice(first, first + ROWS)).astype(float).mean(axis=1)
        for first in range(0, rows, ROWS)
    ]
    return np.concatenate(parts).reshape(rows, -1)


def differences(curves: dict[str, Curve], finest: dict[str, Curve]) -> dict[str, float]:
    """Relative distance of curves from those of the finest run, at the times of the coarser."""
    errors = {}
    for name, (times, values) in curves.items():
        if name not in finest or values.shape[1] != finest[name].values.shape[1]:
            continue
        target = np.stack(
            [np.interp(times, finest[name].times, column) for column in finest[name].values.T],
            axis=1,
        )
        moves = _size(finest[name].values - finest[name].values.mean(axis=0))
        scale = moves if moves > 1e-9 * _size(target) else _size(target)
        if scale > 0.0 and math.isfinite(scale):
            errors[name] = _size(values - target) / scale
    return errors


def _size(values: Any) -> float:
    """Root mean square over time of the length of vectors (rows, numbers)."""
    return float(np.sqrt(np.mean(np.sum(values**2, axis=1))))
