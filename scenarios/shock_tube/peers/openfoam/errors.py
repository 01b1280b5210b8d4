"""Errors of Sod's tube in the folder of a case of OpenFOAM: writes ``errors.csv``.

Mean error of density and pressure over all cells against the exact solution of the Riemann problem
(Toro, Riemann Solvers and Numerical Methods for Fluid Dynamics, 2009, chapter 4), and the drift of
mass and energy, as the component of the scene gives them.
"""

import re
import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

GAMMA, END, DIAPHRAGM = 1.4, 0.2, 0.5
LEFT, RIGHT = (1.0, 0.0, 1.0), (0.125, 0.0, 0.1)  # density, velocity, pressure
HEAT_CAPACITY = 3.5  # at constant pressure, J/(kg K)
Array = NDArray[np.float64]


def _flow(p: float, state: tuple[float, float, float]) -> tuple[float, float]:
    """Function f of Toro's (4.6) and (4.7), and its derivative."""
    density, _, pressure = state
    sound = np.sqrt(GAMMA * pressure / density)
    if p > pressure:
        a, b = 2.0 / ((GAMMA + 1.0) * density), (GAMMA - 1.0) / (GAMMA + 1.0) * pressure
        root = np.sqrt(a / (p + b))
        return (p - pressure) * root, root * (1.0 - 0.5 * (p - pressure) / (p + b))
    power = (GAMMA - 1.0) / (2.0 * GAMMA)
    value = 2.0 * sound / (GAMMA - 1.0) * ((p / pressure) ** power - 1.0)
    return value, (p / pressure) ** (-(GAMMA + 1.0) / (2.0 * GAMMA)) / (density * sound)


def star() -> tuple[float, float]:
    """Pressure and velocity between the waves, by Newton's iteration."""
    p = 0.5 * (LEFT[2] + RIGHT[2])
    for _ in range(50):
        (f_left, d_left), (f_right, d_right) = _flow(p, LEFT), _flow(p, RIGHT)
        p -= (f_left + f_right + RIGHT[1] - LEFT[1]) / (d_left + d_right)
    return p, 0.5 * (LEFT[1] + RIGHT[1] + _flow(p, RIGHT)[0] - _flow(p, LEFT)[0])


def exact(x: Array, time: float) -> tuple[Array, Array]:
    """Density and pressure (n,) at places x (n,) m: a fan to the left, a shock to the right."""
    p, u = star()
    speed = (x - DIAPHRAGM) / time
    ratio = (GAMMA - 1.0) / (GAMMA + 1.0)
    sound = np.sqrt(GAMMA * LEFT[2] / LEFT[0])
    behind = LEFT[0] * (p / LEFT[2]) ** (1.0 / GAMMA)  # density between fan and contact
    ahead = RIGHT[0] * (p / RIGHT[2] + ratio) / (ratio * p / RIGHT[2] + 1.0)
    front = np.sqrt(GAMMA * RIGHT[2] / RIGHT[0]) * np.sqrt(
        (GAMMA + 1.0) / (2.0 * GAMMA) * p / RIGHT[2] + (GAMMA - 1.0) / (2.0 * GAMMA)
    )
    tail = u - np.sqrt(GAMMA * p / behind)
    fan = 2.0 / (GAMMA + 1.0) - ratio * speed / sound
    within = [speed < -sound, speed < tail, speed < u, speed < front]
    density = np.select(
        within, [LEFT[0], LEFT[0] * np.abs(fan) ** (2.0 / (GAMMA - 1.0)), behind, ahead], RIGHT[0]
    )
    pressure = np.select(
        within, [LEFT[2], LEFT[2] * np.abs(fan) ** (2.0 * GAMMA / (GAMMA - 1.0)), p, p], RIGHT[2]
    )
    return density, pressure


def field(folder: Path, name: str, cells: int) -> Array:
    """Values (cells,) or (cells, 3) of a field that OpenFOAM wrote as text."""
    text = (folder / name).read_text()
    inside = text[text.index("internalField") :]
    uniform = re.match(r"internalField\s+uniform\s+([^;]+);", inside)
    if uniform:
        row = np.array(uniform[1].strip("() ").split(), float)
        return np.repeat(row[None], cells, axis=0).squeeze()
    block = inside[inside.index("(") : inside.index("boundaryField")]
    numbers = np.array(re.findall(r"[-+0-9.eE]+", block), float)
    return numbers.reshape(cells, -1).squeeze()


def main(cells: int, rows: int) -> None:
    """Write times, errors of density and pressure, drifts of mass and energy."""
    last, count = Path(f"{END:g}"), cells * rows
    density, pressure = field(last, "rho", count), field(last, "p", count)
    velocity = field(last, "U", count)
    x = np.tile((np.arange(cells) + 0.5) / cells, rows)
    right = x > DIAPHRAGM
    # OpenFOAM's gas constant is 1 but for some digits of the molar one: its own is taken.
    constant = float((pressure / (density * field(last, "T", count))).mean())
    inner = 1.0 / (HEAT_CAPACITY / constant - 1.0)  # gamma - 1
    energy = pressure / inner + 0.5 * density * (velocity**2).sum(axis=1)
    mass_begun = np.where(right, RIGHT[0], LEFT[0]).mean() / constant
    energy_begun = np.where(right, RIGHT[2], LEFT[2]).mean() / inner
    true_density, true_pressure = exact(x, END)
    errors = (
        np.abs(density - true_density).mean(),
        np.abs(pressure - true_pressure).mean(),
        density.mean() / mass_begun - 1.0,
        energy.mean() / energy_begun - 1.0,
    )
    lines = ["time,density,pressure,mass,energy", "0,0,0,0,0"]
    lines.append(",".join(f"{value:.12g}" for value in (END, *errors)))
    Path("errors.csv").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
