"""Error by size of the lattice: ``python -m quintet.scenarios.hot_bar.sizes RUN ...``.

RUN are folders of runs of this scene and its presets; those of one lattice are an ensemble. Prints
L2 against finite elements with its scatter, and processor time, by the number of points; draws
`sizes.png` beside the first run.
"""

import json
import sys
from collections import defaultdict
from pathlib import Path

import matplotlib
import numpy as np

from quintet.scenarios.hot_bar.edges import hotness, reference

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def main(folders: list[str]) -> None:
    """Print and draw."""
    errors, seconds = defaultdict(list), defaultdict(list)
    for folder in map(Path, folders):
        results = json.loads((folder / "results.json").read_text())
        timing = results["timing"]["components"]["bar"]
        gap = hotness(folder) - reference(timing["items"])[1]
        errors[timing["items"]].append(float(np.sqrt((gap**2).mean())))
        seconds[timing["items"]].append(timing["cpu"])
    sizes = sorted(errors)
    means = [float(np.mean(errors[n])) for n in sizes]
    scatter = [float(np.std(errors[n])) for n in sizes]
    spent = [float(np.mean(seconds[n])) for n in sizes]
    for row in zip(sizes, means, scatter, spent, strict=True):
        print("{} points: L2 {:.3f} ± {:.3f}, {:.1f} s of processor time".format(*row))
    figure, axes = plt.subplots(1, 2, figsize=(10, 4), sharey=True)
    for axis, places, label in zip(
        axes, (sizes, spent), ("points", "processor time [s]"), strict=True
    ):
        axis.errorbar(places, means, scatter, fmt="o-", capsize=3)
        axis.set(xscale="log", xlabel=label, ylim=(0.0, None))
    axes[0].set_ylabel("L2 of hotness against finite elements")
    figure.tight_layout()
    figure.savefig(Path(folders[0]).parent / "sizes.png", dpi=90)


if __name__ == "__main__":
    main(sys.argv[1:])
