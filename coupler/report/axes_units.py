"""Axes in units that fit: mm and µs where metres and seconds would have many zeros.

Matplotlib is loaded by the functions that draw: a run without pictures does not need it.
"""

from typing import Any

PREFIXES = ((1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"))
BASE = ("m", "s")  # units that take a prefix
SMALLEST = 0.1  # the largest number of an axis is at least this, in its unit


def prefix_for(largest: float) -> tuple[float, str]:
    """Size and letter of the prefix with which a number needs few zeros: 0.004 -> (1e-3, "m")."""
    for size, letter in PREFIXES:
        if largest >= SMALLEST * size:
            return size, letter
    return PREFIXES[0] if largest <= 0.0 else PREFIXES[-1]


def with_unit(value: float, unit: str) -> str:
    """A number and its unit with the prefix that fits."""
    size, letter = prefix_for(abs(value)) if unit in BASE else PREFIXES[0]
    return f"{value / size:.4g} {letter}{unit}"


def fit(axis: Any, name: str, unit: str, largest: float) -> None:
    """Label an axis (`panel.xaxis`, `panel.yaxis`) and write its numbers with a prefix.

    Parameters
    ----------
    axis : matplotlib axis
    name, unit : str
        Of what it shows; units that take no prefix stay as they are.
    largest : float
        Largest magnitude on it, in that unit.
    """
    size, letter = prefix_for(largest) if unit in BASE else PREFIXES[0]
    axis.set_label_text(f"{name} [{letter}{unit}]")
    if size != 1.0:
        # A run without pictures does not load matplotlib.
        from matplotlib.ticker import FuncFormatter

        axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value / size:.6g}"))
