"""Elevation of the waves by theory of second order, and a picture of it beside a run.

`python scenarios/wave_flume/theory.py` writes theory.csv, the elevation at x = 1.45 m, and
`python scenarios/wave_flume/theory.py runs/wave_flume scenarios/wave_flume/scene.png 13.5` draws a
run at 13.5 s.

The paddle moves as sin ωt, so that η = H/2 cos θ + a cos 2θ with θ = ωt - kx,
a = H² k/16 (3 - tanh² kh)/tanh³ kh (Dean & Dalrymple (1991), section 11.2).
"""

import math
import sys
from pathlib import Path

import h5py
import numpy as np

DEPTH, HEIGHT, PERIOD, PLACE = 0.4, 0.1, 1.1, 1.45  # m, m, s, m
BEGIN, END, STEP = 5.5, 9.9, 0.05  # s
GRAVITY = 9.81  # m/s2
FLUME, ZONE, PADDLE, TOP = 5.6, 3.6, 0.15, 0.65  # m


def wave_number(omega: float) -> float:
    """Wave number [1/m]: ω² = g k tanh(k h), by bisection."""
    low, high = 0.0, 1000.0
    for _ in range(100):
        k = 0.5 * (low + high)
        low, high = (k, high) if GRAVITY * k * math.tanh(k * DEPTH) < omega * omega else (low, k)
    return low


def elevation(time: float, place: float) -> float:
    """Elevation [m] at a time [s] and a place [m] in front of the paddle at rest."""
    omega = 2.0 * math.pi / PERIOD
    k = wave_number(omega)
    t = math.tanh(k * DEPTH)
    second = HEIGHT * HEIGHT * k / 16.0 * (3.0 - t * t) / t**3
    phase = omega * time - k * place
    return 0.5 * HEIGHT * math.cos(phase) + second * math.cos(2.0 * phase)


def write_profile() -> None:
    """Write the file."""
    length = 2.0 * math.pi / wave_number(2.0 * math.pi / PERIOD)
    lines = [f"# scenarios/wave_flume/theory.py; L = {length:.6f} m", "t_s,elevation_m"]
    for n in range(round((END - BEGIN) / STEP) + 1):
        time = BEGIN + n * STEP
        lines.append(f"{time:.2f},{elevation(time, PLACE):.7f}")
    (Path(__file__).parent / "theory.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


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


def draw(run: Path, picture: Path, time: float) -> None:
    """Draw the water, the paddle where it is, and the surface of theory."""
    import matplotlib.pyplot as plt  # by the picture alone

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
    if len(sys.argv) > 1:
        draw(Path(sys.argv[1]), Path(sys.argv[2]), float(sys.argv[3]))
    else:
        write_profile()
