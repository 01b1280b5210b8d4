"""What each treatment of walls does to each gap: ``python -m quintet.scenarios.gap.table RUN ...``.

RUN is the folder of a run of this scene, as `quintet study gap` leaves one for each treatment.
Prints the README's table and draws `gap.png` beside the first run.
"""

import sys
import tomllib
from pathlib import Path

import matplotlib
import numpy as np

from quintet.coupler.files.recording import Recording
from quintet.coupler.files.vtkhdf_reader import read_step, times
from quintet.interfaces.component import Array

matplotlib.use("Agg")
import matplotlib.pyplot as plt

MIDDLE = 2.5  # spacings: half the width of the middle of a face, away from its rim
WEIGHT = 9810.0  # N/m3, rho g


class Run:
    """One run: for each gap its width, the pressure in its middle over time, what is in it."""

    def __init__(self, folder: Path) -> None:
        scene = tomllib.loads((folder / "scene.toml").read_text())
        water, bodies = scene["components"]["water"], scene["components"]["blocks"]["bodies"]
        self.name, self.spacing = folder.name, float(water["spacing"])
        lowest = np.array([body["lowest"] for body in bodies])  # m
        highest = np.array([body["highest"] for body in bodies])  # m
        self.size, self.place = highest[0] - lowest[0], 0.5 * (lowest + highest)
        left, right = self.place[0::2], self.place[1::2]
        self.width = (right - left)[:, 0] - self.size[0]  # m
        file = folder / "water.vtkhdf"
        points = read_step(file, len(times(file)) - 1)[1]["points"]
        low, high = (np.array([box[k] for box in water["fluid"]]) for k in ("lowest", "highest"))
        volume = float(np.prod(high - low, axis=1).sum())  # m3, which the particles share
        self.particle = volume / len(points)  # m3
        self.level = self._level(volume, water["boundary"]["walls"])
        self.share = np.array([self._share(points, k) for k in range(len(left))])
        with Recording(folder) as recording:
            self.times = recording.times("water")[1:]
            window = np.diff(recording.times("water"))[:, None]
            samples = recording.static("blocks")
            self.arm = samples["samples.0.motion.arm"][samples["samples.0.motion.body"] == 0.0]
            force = recording.field("water", "surface_load.force")[1:, :, 0] / window  # N
        self.pressure = self._pressure(force)  # over that outside; (gaps, m)

    def _level(self, volume: float, walls: dict[str, list[float]]) -> float:
        """Height of the surface [m] that the water has by its volume."""
        across = np.prod(np.subtract(walls["highest"], walls["lowest"])[:2])
        solid = len(self.place) * np.prod(self.size)
        return float((volume + solid) / across)

    def _share(self, points: Array, gap: int) -> float:
        """Particles in a gap over those that it has room for."""
        left, right = self.place[2 * gap], self.place[2 * gap + 1]
        half = 0.5 * self.size
        low = left - half + [self.size[0], 0.0, 0.0]
        high = right + half - [self.size[0], 0.0, 0.0]
        inside = ((points > low) & (points < high)).all(axis=1).sum()
        return float(inside * self.particle / np.prod(high - low))

    def _pressure(self, force: Array) -> Array:
        middle = (np.abs(self.arm[:, 1:]) < MIDDLE * self.spacing).all(axis=1)
        area = (2.0 * MIDDLE * self.spacing) ** 2
        push = force.reshape(len(force), len(self.place), len(self.arm))[:, :, middle].sum(axis=2)
        outside = WEIGHT * (self.level - self.place[0, 2])
        return (1.0 - 0.5 * (push[:, 0::2] - push[:, 1::2]) / (area * outside)).T

    def filled(self, gap: int) -> str:
        """Time from which on half the pressure outside is in a gap [ms]."""
        below = np.flatnonzero(self.pressure[gap] < 0.5)
        if len(below) and below[-1] == len(self.times) - 1:
            return "never"
        return f"{1e3 * self.times[below[-1] + 1]:.0f} ms" if len(below) else "at once"


def settled(run: Run) -> Array:
    """Mean over the last two fifths of a run; (gaps,)."""
    return run.pressure[:, run.times > 0.6 * run.times[-1]].mean(axis=1)


def main(folders: list[str]) -> None:
    """Print the table, and draw it."""
    runs = [Run(Path(folder)) for folder in folders]
    widths = runs[0].width / runs[0].spacing
    print("| gap, spacings | " + " | ".join(run.name for run in runs) + " |")
    print("|---" * (len(runs) + 1) + "|")
    for k, width in enumerate(widths):
        cells = [f"{settled(r)[k]:.2f}, {r.share[k]:.2f}, {r.filled(k)}" for r in runs]
        print(f"| {width:.3g} | " + " | ".join(cells) + " |")
    figure, axes = plt.subplots(figsize=(6.0, 4.0))
    for run in runs:
        axes.plot(widths, settled(run), "o-", label=run.name)
    axes.axhspan(0.8, 1.2, color="0.9")
    axes.set(xlabel="gap / spacing", ylabel="pressure in the gap / outside")
    axes.legend()
    out = Path(folders[0]).parent / "gap.png"
    if out.exists():
        print(f"{out} is there already: it stays as it is")
    else:
        figure.savefig(out, dpi=120, bbox_inches="tight")


if __name__ == "__main__":
    main(sys.argv[1:])
