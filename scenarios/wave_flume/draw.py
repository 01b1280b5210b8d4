"""Draw a state of a run: the water, the paddle where it is, and the surface of theory.

`python scenarios/wave_flume/draw.py runs/wave_flume scenarios/wave_flume/scene.png 13.5`
"""

import math
import sys
from pathlib import Path

import h5py
import matplotlib
import numpy as np

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from quintet.scenarios.wave_flume.theory import DEPTH, HEIGHT, PERIOD, elevation, wave_number

FLUME, ZONE, PADDLE, TOP = 5.6, 3.6, 0.15, 0.65  # m


def state(run: Path, time: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Places (n, 3) m and speeds (n,) m/s of the picture nearest to a time [s], and its time."""
    with h5py.File(run / "water.vtkhdf") as file:
        root = file["VTKHDF"]
        times = root["Steps/Values"][:]
        nearest = int(np.argmin(np.abs(times - time)))
        count = len(root["Points"]) // len(times)
        rows = slice(nearest * count, (nearest + 1) * count)
        speed = np.linalg.norm(root["PointData/velocity"][rows], axis=1)
        return root["Points"][rows], speed, float(times[nearest])


def paddle_place(time: float) -> float:
    """Displacement [m] of the paddle, of first order (Biésel 1951); the second adds 1.4 mm."""
    omega = 2.0 * math.pi / PERIOD
    kh = wave_number(omega) * DEPTH
    factor = 2.0 * math.sinh(kh) ** 2 / (math.sinh(kh) * math.cosh(kh) + kh)
    return 0.5 * HEIGHT / factor * math.sin(omega * time)


def main(run: Path, picture: Path, time: float) -> None:
    """Write the picture."""
    places, speed, time = state(run, time)
    figure, panel = plt.subplots(figsize=(12.0, 2.6), layout="constrained")
    dots = panel.scatter(places[:, 0], places[:, 2], c=speed, s=1.0, cmap="viridis", vmin=0.0)
    figure.colorbar(dots, label="speed [m/s]")
    front = paddle_place(time)
    panel.fill_between([front - PADDLE, front], 0.0, TOP, color="0.35", label="paddle")
    panel.axvspan(ZONE, FLUME, color="0.5", alpha=0.12, label="damping zone")
    x = np.linspace(front, ZONE, 400)
    level = [DEPTH + elevation(time, float(place)) for place in x]
    panel.plot(x, level, color="tab:red", linewidth=1.2, label="Stokes, second order")
    panel.plot([-0.4, FLUME, FLUME], [0.0, 0.0, 0.7], color="0.2")
    panel.set(xlabel="x [m]", ylabel="z [m]", title=f"t = {time:g} s", ylim=(-0.02, 0.7))
    panel.legend(loc="upper right", ncols=3, fontsize=8)
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]), float(sys.argv[3]))
