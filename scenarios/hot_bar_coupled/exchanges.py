"""Exchanges one by one: ``python -m quintet.scenarios.hot_bar_coupled.exchanges RUN ...``.

RUN is the folder of a run of this scene. Prints temperature and heat flow, their means over the
exchanges from the ninth on with standard errors, and the first exchange that differs from the mean
by no more than the lattice's noise allows. Draws `exchanges.png` beside the first run.
"""

import math
import sys
from pathlib import Path

import matplotlib
import numpy as np

from quintet.coupler.files.recording import Recording
from quintet.interfaces.component import Array

matplotlib.use("Agg")
import matplotlib.pyplot as plt

SETTLED = 8  # exchanges that are left out of the means
BLOCK = 4  # exchanges; longer than what relaxation remembers
LIKELY = 3.0  # standard deviations that noise alone may differ by


def standard_error(values: Array) -> float:
    """Standard error of the mean, by means of blocks."""
    blocks = values[: len(values) // BLOCK * BLOCK].reshape(-1, BLOCK).mean(axis=1)
    return float(blocks.std(ddof=1) / math.sqrt(len(blocks)))


def reached(values: Array) -> int:
    """First exchange (from 1) after which all differ from the mean by noise alone."""
    settled = values[SETTLED:]
    far = np.abs(values - settled.mean()) > LIKELY * settled.std(ddof=1)
    return int(np.flatnonzero(far).max(initial=-1)) + 2


def main(folders: list[str]) -> None:
    """Print and draw."""
    figure, axes = plt.subplots(1, 2, figsize=(10, 4))
    for name in folders:
        with Recording(Path(name)) as recording:
            between = recording.field("elements", "node_temperature.temperature")[1:].mean(axis=1)
            times = np.diff(recording.times("elements"))
            flow = 1e9 * recording.field("elements", "held.heat_flow")[1:, 0] / times
        print(f"{name}:")
        for values, label, unit in ((between, "temperature", "K"), (flow, "heat flow", "nW")):
            mean, error = values[SETTLED:].mean(), standard_error(values[SETTLED:])
            print(f"  {label} {mean:.1f} ± {error:.1f} {unit}, from exchange {reached(values)} on")
        for axis, values in zip(axes, (between, flow), strict=True):
            axis.plot(np.arange(1, len(values) + 1), values, "o-", label=Path(name).name)
            axis.axhline(values[SETTLED:].mean(), color="k", linewidth=0.6)
            axis.set_xlabel("exchange")
    axes[0].set_ylabel("temperature between [K]")
    axes[1].set_ylabel("heat flow [nW]")
    axes[0].legend()
    figure.tight_layout()
    figure.savefig(Path(folders[0]).parent / "exchanges.png", dpi=90)


if __name__ == "__main__":
    main(sys.argv[1:])
