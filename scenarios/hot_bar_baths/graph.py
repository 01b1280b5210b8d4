"""Temperatures against Laplace: ``python -m quintet.scenarios.hot_bar_baths.graph RUN ...``.

RUN is the folder of a run of this scene. The equation is solved on nearest neighbours, with the
temperatures that were measured at the points in baths. Draws `graph.png` beside the first run.
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


def laplace(temperature: Array, held: list[tuple[int, ...]]) -> Array:
    """Temperatures (nx, ny, nz) K on the graph of nearest points, with some held as they are."""
    number = np.arange(temperature.size).reshape(temperature.shape)
    matrix, right_side = np.zeros((temperature.size,) * 2), np.zeros(temperature.size)
    for axis in range(3):
        layers = np.moveaxis(number, axis, 0)
        lower, upper = layers[:-1].ravel(), layers[1:].ravel()
        for i, j in ((lower, upper), (upper, lower)):
            matrix[i, j] -= 1.0
            matrix[i, i] += 1.0
    for place in held:
        row = number[place]
        matrix[row], right_side[row] = 0.0, temperature[place]
        matrix[row, row] = 1.0
    return np.asarray(np.linalg.solve(matrix, right_side).reshape(temperature.shape))


def edges(grid: Array) -> Array:
    """Values along the top front and the bottom back edge; (2, points along x)."""
    return np.stack([grid[:, -1, -1], grid[:, 0, 0]])


def main(folders: list[str]) -> None:
    """Print the differences along both edges over 500 K, and draw."""
    figure, axes = plt.subplots(1, 2, figsize=(10, 4), sharey=True)
    for name in folders:
        scene = tomllib.loads((Path(name) / "scene.toml").read_text())
        count = [cells + 1 for cells in scene["components"]["bar"]["lattice"]["cells"]]
        with Recording(Path(name)) as recording:
            grid = recording.field("bar", "points.temperature")[-1].reshape(count)
        exact = laplace(grid, [(0, -1, -1), (-1, 0, 0), (-1, 0, -1)])
        gap = (edges(grid) - edges(exact)) / 500.0
        size = np.sqrt((gap**2).mean())
        print(f"{name}: {grid.size} points: L2 {size:.4f}, largest {np.abs(gap).max():.4f}")
        place = np.linspace(0.0, 30.0, count[0])
        for edge, axis in enumerate(axes):
            (line,) = axis.plot(place, edges(exact)[edge], label=f"graph, {grid.size} points")
            axis.plot(place, edges(grid)[edge], "o", color=line.get_color())
            axis.set(title=("top front", "bottom back")[edge], xlabel="x [mm]")
    axes[0].set_ylabel("temperature [K]; circles: particle dynamics")
    axes[0].legend()
    figure.tight_layout()
    figure.savefig(Path(folders[0]).parent / "graph.png", dpi=90)


if __name__ == "__main__":
    main(sys.argv[1:])
