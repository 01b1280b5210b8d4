"""Hotness along edges against finite elements: ``python -m quintet.scenarios.hot_bar.edges RUN``.

RUN is the folder of a run of this scene or a preset; those of one lattice are an ensemble. Prints
the L2 and the largest difference of each and of their mean, the level in the whole run and in its
thirds. Draws `edges_160.png`, by the number of points, beside the first run, and `sizes.png` of
several lattices.
"""

import json
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

EDGES = ("top front", "bottom back")


def hotness(folder: Path) -> Array:
    """Relative hotness at the end of a run, along both edges; (2, points along x)."""
    lattice = tomllib.loads((folder / "scene.toml").read_text())["components"]["bar"]["lattice"]
    count = [cells + 1 for cells in lattice["cells"]]
    with Recording(folder) as recording:
        grid = recording.field("bar", "points.relative_hotness")[-1].reshape(count)
    return np.stack([grid[:, -1, -1], grid[:, 0, 0]])


def by_thirds(folder: Path) -> Array:
    """Mean hotness (3,) of what is neither driven nor frozen in each third of a run.

    Over the hotness of the hottest point in the whole run: the mean of the three is the level.
    """
    lattice = tomllib.loads((folder / "scene.toml").read_text())["components"]["bar"]["lattice"]
    bulk = np.ones([cells + 1 for cells in lattice["cells"]], bool)
    bulk[0, -2:, -1] = bulk[-1, 0, 0] = bulk[-1, 0, -1] = False
    with Recording(folder) as recording:
        mean = recording.field("bar", "points.hotness")  # (windows + 1, n) J, since the start
    rows = np.arange(4) * (len(mean) - 1) // 3
    each = np.diff(rows[:, None] * mean[rows], axis=0) / np.diff(rows)[:, None]
    return np.asarray(each[:, bulk.ravel()].mean(axis=1) / mean[-1].max())


def reference(points: int) -> tuple[Array, Array]:
    """Places (k,) m and temperatures (2, k) of finite elements for a lattice of so many points."""
    rows = np.loadtxt(Path(__file__).with_name("edges.csv"), delimiter=",", comments="#")
    lines = [rows[(rows[:, 0] == points) & (rows[:, 1] == edge)] for edge in range(2)]
    return lines[0][:, 2], np.stack([line[:, 3] for line in lines])


class Ensemble(NamedTuple):
    """L2 of the runs of one lattice, and the processor time [s] of each."""

    points: int
    errors: Array
    seconds: Array


def compare(points: int, folders: list[Path], out: Path) -> Ensemble:
    """Print how the runs of one lattice differ from finite elements, and draw their edges."""
    place, exact = reference(points)
    grids = np.stack([hotness(folder) for folder in folders])
    gap = grids - exact
    each = np.sqrt((gap**2).mean(axis=(1, 2)))
    for name, error, largest in zip(folders, each, np.abs(gap).max(axis=(1, 2)), strict=True):
        print(f"{name}: L2 {error:.3f}, largest {largest:.3f}")
    mean = np.sqrt((gap.mean(axis=0) ** 2).mean())
    thirds = np.stack([by_thirds(folder) for folder in folders])
    level = thirds.mean(axis=1)
    print(f"level {level.mean():.3f} ± {level.std():.3f}; thirds {thirds.mean(axis=0).round(2)}")
    print(f"{points} points: L2 {each.mean():.3f} ± {each.std():.3f}; of their mean {mean:.3f}")
    figure, axes = plt.subplots(1, 2, figsize=(10, 4), sharey=True)
    for edge, axis in enumerate(axes):
        axis.plot(1e3 * place, exact[edge], "k-", label="finite elements, 0.208 mm")
        axis.errorbar(
            1e3 * place, grids[:, edge].mean(axis=0), grids[:, edge].std(axis=0), fmt="o-",
            capsize=3, label=f"{points} points, {len(folders)} runs",
        )  # fmt: skip
        axis.set(title=EDGES[edge], xlabel="x [mm]")
    axes[0].set_ylabel("hotness over that of the hottest point")
    axes[0].legend()
    figure.tight_layout()
    figure.savefig(out / f"edges_{points}.png", dpi=90)
    return Ensemble(points, each, np.array([timing(folder)["cpu"] for folder in folders]))


def timing(folder: Path) -> dict[str, float]:
    """What the bar of a run took, and its number of points."""
    results = json.loads((folder / "results.json").read_text())
    times: dict[str, float] = results["timing"]["components"]["bar"]
    return times


def draw_sizes(ensembles: list[Ensemble], out: Path) -> None:
    """Draw error over the number of points and over processor time."""
    means = [float(ensemble.errors.mean()) for ensemble in ensembles]
    scatter = [float(ensemble.errors.std()) for ensemble in ensembles]
    spent = [float(ensemble.seconds.mean()) for ensemble in ensembles]
    figure, axes = plt.subplots(1, 2, figsize=(10, 4), sharey=True)
    sizes = [ensemble.points for ensemble in ensembles]
    labelled = ((sizes, "points"), (spent, "processor time [s]"))
    for axis, (places, label) in zip(axes, labelled, strict=True):
        axis.errorbar(places, means, scatter, fmt="o-", capsize=3)
        axis.set(xscale="log", xlabel=label, ylim=(0.0, None))
    axes[0].set_ylabel("L2 of hotness against finite elements")
    figure.tight_layout()
    figure.savefig(out / "sizes.png", dpi=90)


def main(folders: list[str]) -> None:
    """Print and draw."""
    runs = [Path(folder) for folder in folders]
    sizes = sorted({int(timing(run)["items"]) for run in runs})
    out = runs[0].parent
    ensembles = [
        compare(points, [run for run in runs if timing(run)["items"] == points], out)
        for points in sizes
    ]
    if len(sizes) > 1:
        draw_sizes(ensembles, out)


if __name__ == "__main__":
    main(sys.argv[1:])
