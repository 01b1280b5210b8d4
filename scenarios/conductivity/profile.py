"""Conductivity by length: ``python -m quintet.scenarios.conductivity.profile RUN ...``.

RUN is the folder of a run of this scene. Conductivity is the mean heat flow of both baths over the
slope of the temperature between them, the layer beside each bath left out; nothing is fitted but
that line. Prints it over k ω/a with its error, and draws `profile.png` beside the first run.
"""

import sys
import tomllib
from pathlib import Path
from typing import NamedTuple

import matplotlib
import numpy as np

from quintet.coupler.files.recording import Recording
from quintet.interfaces.component import Array

matplotlib.use("Agg")
import matplotlib.pyplot as plt

BESIDE = 2  # layers at each end that are left out: that of the bath, and the next


class Profile(NamedTuple):
    """What a bar conducts."""

    temperature: Array  # (layers,) K
    slope: float  # K, from layer to layer
    conductivity: float  # over k ω/a
    error: float  # of it


def read(folder: Path) -> Profile:
    """Conductivity of a bar, from the end of its run."""
    bar = tomllib.loads((folder / "scene.toml").read_text())["components"]["bar"]
    count = [cells + 1 for cells in bar["lattice"]["cells"]]
    with Recording(folder) as recording:
        points = recording.field("bar", "points.temperature")[-1].reshape(count)
        flow = np.abs(recording.field("bar", "baths.heat_flow")[-1]).mean()
        error = recording.field("bar", "baths.heat_flow_error")[-1].mean()
    temperature = points.mean(axis=(1, 2))
    inner = np.arange(BESIDE, count[0] - BESIDE)
    slope = -float(np.polyfit(inner, temperature[inner], 1)[0])
    frequency = 2.0 * np.pi * bar["seven_roots"]["top_frequency"]
    conductivity = flow / (count[1] * count[2] * slope * bar["boltzmann"] * frequency)
    return Profile(temperature, slope, float(conductivity), float(conductivity * error / flow))


def main(folders: list[str]) -> None:
    """Print and draw."""
    figure, axis = plt.subplots(figsize=(7, 4))
    for name in folders:
        profile = read(Path(name))
        layers = len(profile.temperature)
        print(f"{layers} layers: {profile.conductivity:.3f} ± {profile.error:.3f} k omega/a")
        place = (np.arange(layers) + 0.5) / layers
        axis.plot(place, profile.temperature, "o", markersize=4, label=f"{layers} layers")
    axis.plot([0.0, 1.0], [390.0, 210.0], "k:", linewidth=0.8, label="between the baths")
    axis.set(xlabel="place over the length", ylabel="temperature [K]")
    axis.legend()
    figure.tight_layout()
    figure.savefig(Path(folders[0]).parent / "profile.png", dpi=90)


if __name__ == "__main__":
    main(sys.argv[1:])
