"""Von Mises stress side by side: ``python -m quintet.scenarios.al_ball_7400_glued.side_by_side``.

PURE and GLUED are folders of runs of `al_ball_7400`, a quarter or rings, and of this scene. Left of
the axis the cut through particles alone, mirrored, right of it particles glued to finite elements;
drawn into `von_mises.png` beside the second run. Printed is which layers of the plate have failed.
"""

import sys
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection

from quintet.coupler.files.vtkhdf_reader import read_step, times
from quintet.interfaces.component import Array

matplotlib.use("Agg")
import matplotlib.pyplot as plt

WIDTH, LOW, HIGH = 0.0402, -0.0185, 0.006  # m, of what is drawn
NEAR = 1.2e-3  # m, about the axis
GREATEST = 6e8  # Pa, at the colour bar's end


def particles(axis: Axes, view: dict[str, Array], side: float, spacing: float) -> None:
    """Particles of the layer beside the plane of symmetry y = 0, as squares of their cells."""
    points, stress = view["points"], view["von_mises"]
    shown = (points[:, 1] < 0.75 * spacing) & (points[:, 0] < WIDTH)
    x, z = side * points[shown, 0], points[shown, 2]
    half = 0.5 * spacing
    corner = half * np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
    squares = np.stack([x, z], axis=1)[:, None, :] + corner
    _add(axis, squares, stress[shown])


def elements(axis: Axes, view: dict[str, Array]) -> None:
    """Faces of elements on the plane of symmetry y = 0."""
    cells, points = view["cells"], view["points"]
    cut = cells[(np.abs(points[cells, 1]) < 1e-6).all(axis=1)]
    _add(axis, points[cut][:, :, [0, 2]], view["von_mises"][cut].mean(axis=1))


def _add(axis: Axes, polygons: Array, stress: Array) -> None:
    drawn = PolyCollection(list(1e3 * polygons), cmap="viridis", edgecolors="face", linewidths=0.3)
    drawn.set_array(1e-6 * stress)
    drawn.set_clim(0.0, 1e-6 * GREATEST)
    axis.add_collection(drawn)


def spacing_of(folder: Path) -> float:
    """Distance [m] of neighbouring particles at the start, from the first picture's plate."""
    view = read_step(folder / "impact.vtkhdf", 0)[1]
    far = view["points"][np.argsort(view["points"][:, 0])][-2000:]
    gaps = np.diff(np.unique(np.round(far[:, 2], 5)))
    return float(np.median(gaps[gaps > 1e-4]))


def failed_layers(folder: Path) -> str:
    """Depths [mm] at the start of the plate's layers that have failed about the axis."""
    file = folder / "impact.vtkhdf"
    start, end = read_step(file, 0)[1], read_step(file, len(times(file)) - 1)[1]
    place = start["points"]
    axis = (end["body"] == 1) & (np.hypot(place[:, 0], place[:, 1]) < NEAR)
    depth = np.round(-1e3 * place[axis, 2], 2)
    damage = end["damage"][axis]
    failed = [z for z in np.unique(depth) if damage[depth == z].mean() > 0.5]
    whole = np.setdiff1d(depth, failed)
    return (
        f"failed {', '.join(f'{z:g}' for z in failed)}; whole {', '.join(f'{z:g}' for z in whole)}"
    )


def main(pure: str, glued: str) -> None:
    """Draw the times that both have."""
    unglued, other = Path(pure), Path(glued)
    spacing = spacing_of(unglued)
    shown = [t for t in times(other / "impact.vtkhdf") if t > 0.0][-2:]
    figure, axes = plt.subplots(len(shown), 1, figsize=(11, 4 * len(shown)), squeeze=False)
    for axis, time in zip(axes[:, 0], shown, strict=True):
        for folder, side in ((unglued, -1.0), (other, 1.0)):
            file = folder / "impact.vtkhdf"
            row = int(np.argmin(np.abs(times(file) - time)))
            particles(axis, read_step(file, row)[1], side, spacing)
        rim = other / "rim.vtkhdf"
        elements(axis, read_step(rim, int(np.argmin(np.abs(times(rim) - time))))[1])
        axis.axvline(0.0, color="w", linewidth=0.8)
        axis.axvline(20.0, color="r", linewidth=0.8)
        axis.set(
            xlim=(-1e3 * WIDTH, 1e3 * WIDTH), ylim=(1e3 * LOW, 1e3 * HIGH), aspect="equal",
            ylabel="z [mm]", title=f"{1e6 * time:.0f} µs: particles | glued to elements",
        )  # fmt: skip
    axes[-1, 0].set_xlabel("x [mm]")
    figure.colorbar(
        axes[0, 0].collections[0],
        ax=axes[:, 0].tolist(),
        label="von Mises stress [MPa]",
        extend="max",
    )
    figure.savefig(other / "von_mises.png", dpi=90, bbox_inches="tight")
    print(other / "von_mises.png")
    for folder in (unglued, other):
        print(f"{folder}, layers about the axis by depth [mm]: {failed_layers(folder)}")


if __name__ == "__main__":
    main(*sys.argv[1:])
