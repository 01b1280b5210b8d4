"""Hotness along edges against finite elements: ``python -m quintet.scenarios.hot_bar.edges RUN``.

RUN is the folder of a run of this scene; several of the same lattice are an ensemble. Prints the
L2 and the largest difference of each and of their mean, the level in the whole run and in its
thirds, and draws `edges.png` beside the first run.
"""

import sys
import tomllib
from pathlib import Path

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
    own = np.diff(rows[:, None] * mean[rows], axis=0) / np.diff(rows)[:, None]
    return np.asarray(own[:, bulk.ravel()].mean(axis=1) / mean[-1].max())


def reference(points: int) -> tuple[Array, Array]:
    """Places (k,) m and temperatures (2, k) of finite elements for a lattice of so many points."""
    rows = np.loadtxt(Path(__file__).with_name("edges.csv"), delimiter=",", comments="#")
    mine = [rows[(rows[:, 0] == points) & (rows[:, 1] == edge)] for edge in range(2)]
    return mine[0][:, 2], np.stack([one[:, 3] for one in mine])


def main(folders: list[str]) -> None:
    """Print and draw."""
    found = np.stack([hotness(Path(one)) for one in folders])
    along = found.shape[2]
    points = along * ((along - 1) // 3 + 1) ** 2
    place, exact = reference(points)
    gap = found - exact
    each = np.sqrt((gap**2).mean(axis=(1, 2)))
    for name, one, largest in zip(folders, each, np.abs(gap).max(axis=(1, 2)), strict=True):
        print(f"{name}: L2 {one:.3f}, largest {largest:.3f}")
    mean = np.sqrt((gap.mean(axis=0) ** 2).mean())
    thirds = np.stack([by_thirds(Path(one)) for one in folders])
    level = thirds.mean(axis=1)
    print(f"level {level.mean():.3f} ± {level.std():.3f}; thirds {thirds.mean(axis=0).round(2)}")
    print(f"{points} points: L2 {each.mean():.3f} ± {each.std():.3f}; of their mean {mean:.3f}")
    figure, axes = plt.subplots(1, 2, figsize=(10, 4), sharey=True)
    for edge, axis in enumerate(axes):
        axis.plot(1e3 * place, exact[edge], "k-", label="finite elements, 0.208 mm")
        axis.errorbar(
            1e3 * place, found[:, edge].mean(axis=0), found[:, edge].std(axis=0), fmt="o-",
            capsize=3, label=f"{points} points, {len(folders)} runs",
        )  # fmt: skip
        axis.set(title=EDGES[edge], xlabel="x [mm]")
    axes[0].set_ylabel("hotness over that of the hottest point")
    axes[0].legend()
    figure.tight_layout()
    figure.savefig(Path(folders[0]).parent / "edges.png", dpi=90)


if __name__ == "__main__":
    main(sys.argv[1:])
