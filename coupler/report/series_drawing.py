"""Recorded fields of a run over time, one panel each, whether anything is expected of them or not.

Matplotlib is loaded by the functions that draw: a run without pictures does not need it.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from quintet.coupler.report.columns import columns_of
from quintet.coupler.report.panels import curve_panels, save
from quintet.coupler.report.recorded import RecordedFields
from quintet.interfaces.errors import SceneError

PANELS = 12  # at most
CURVES = 8  # in a panel; of more their range and their mean are drawn


def drawable(fields: RecordedFields, keys: Sequence[str]) -> list[str]:
    """Fields of some keys that change in the run: only those are worth a panel."""
    return [key for key in keys if len(fields[key]) > 1]


def draw_series(fields: RecordedFields, keys: Sequence[str], out: Path, title: str) -> Path:
    """Draw some recorded fields; return `out`.

    Parameters
    ----------
    fields : RecordedFields
    keys : sequence of str
        ``component.port.field``
    out : Path
        The picture; its ending chooses the format.
    title : str
        Above all panels.
    """
    keys = drawable(fields, keys)
    if not keys:
        raise SceneError(
            "a picture of series needs a recorded field of two rows or more; found none. Name one "
            "in output.fields, or an expectation."
        )
    if len(keys) > PANELS:
        title = f"{title}\nthe first {PANELS} of {len(keys)} fields; name others with --series"
    figure, panels = curve_panels(len(keys[:PANELS]), title)
    for panel, key in zip(panels, keys, strict=False):
        _draw(panel, key, fields)
    return save(figure, out)


def _draw(panel: Any, key: str, fields: RecordedFields) -> None:
    component, port, field = key.split(".")
    series = fields.rate(key)
    columns = columns_of("", series)
    names = [name.rpartition(" [")[0].strip() for name in columns.names]
    if len(names) <= CURVES:
        for name, values in zip(names, columns.values.T, strict=True):
            panel.plot(columns.times, values, linewidth=1.2, label=name)
    else:
        low, high = columns.values.min(axis=1), columns.values.max(axis=1)
        panel.fill_between(columns.times, low, high, alpha=0.25, linewidth=0, label="range")
        label = f"mean of {len(names)}"
        panel.plot(columns.times, columns.values.mean(axis=1), linewidth=1.2, label=label)
    quantity = field.replace("_", " ")
    mean = ", mean over each window" if fields.is_impulse(key) else ""
    panel.set_title(f"{component}: {port.replace('_', ' ')}{mean}", fontsize=9)
    panel.set(xlabel="t [s]", ylabel=f"{quantity} [{series.unit}]")
    panel.grid(alpha=0.3)
    if np.size(names) > 1:
        panel.legend(fontsize=7, frameon=False, ncols=2 if len(names) > 3 else 1)
