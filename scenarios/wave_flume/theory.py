"""Elevation over time at x = 1.45 m by theory of second order; writes theory.csv beside this file.

The paddle moves as sin ωt, so that η = H/2 cos θ + a cos 2θ with θ = ωt - kx,
a = H² k/16 (3 - tanh² kh)/tanh³ kh (Dean & Dalrymple (1991), section 11.2).
"""

import math
from pathlib import Path

DEPTH, HEIGHT, PERIOD, PLACE = 0.4, 0.1, 1.1, 1.45  # m, m, s, m
BEGIN, END, STEP = 5.5, 9.9, 0.05  # s
GRAVITY = 9.81  # m/s2


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


def main() -> None:
    """Write the file."""
    length = 2.0 * math.pi / wave_number(2.0 * math.pi / PERIOD)
    lines = [f"# scenarios/wave_flume/theory.py; L = {length:.6f} m", "t_s,elevation_m"]
    for n in range(round((END - BEGIN) / STEP) + 1):
        time = BEGIN + n * STEP
        lines.append(f"{time:.2f},{elevation(time, PLACE):.7f}")
    (Path(__file__).parent / "theory.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
