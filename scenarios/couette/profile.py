"""Temperature and velocity across the gap: ``python -m quintet.scenarios.couette.profile RUN ...``.

RUN is the folder of a run of this scene, or several. Draws `profile.png` beside the first, with
the exact solution: T = T_w + Pr/(2 c_p) u (U - u), and u where the friction ∫ μ(T(u)) du/h is one.
Prints by how much less heat goes through the upper wall, which moves, than through the lower one.
"""

import sys
import tomllib
from pathlib import Path

import matplotlib
import numpy as np

from quintet.coupler.files import vtkhdf_reader
from quintet.coupler.files.recording import Recording
from quintet.interfaces.component import Array

matplotlib.use("Agg")
import matplotlib.pyplot as plt

PRANDTL, HEAT = 0.72, 2.5  # 1; J/(kg K), c_p of γ = 1.4 and R = 1/1.4
SUTHERLAND = 0.4  # K; walls are at 1 K, the upper one moves at 1 m/s


def exact() -> tuple[Array, Array, Array]:
    """Heights [m], velocities [m/s] and temperatures [K]."""
    u = np.linspace(0.0, 1.0, 401)
    temperature = 1.0 + PRANDTL / (2.0 * HEAT) * u * (1.0 - u)
    viscosity = temperature**1.5 * (1.0 + SUTHERLAND) / (temperature + SUTHERLAND)
    height = np.append(0.0, np.cumsum(0.5 * (viscosity[1:] + viscosity[:-1]) * np.diff(u)))
    return height / height[-1], u, temperature


def nodes(run: Path) -> tuple[Array, Array, Array]:
    """The same of all nodes at the end of a run."""
    file = run / "gas.vtkhdf"
    view = vtkhdf_reader.read_step(file, len(vtkhdf_reader.times(file)) - 1)[1]
    return view["points"][:, 2], view["velocity"][:, 0], view["temperature"]


def missing(run: Path) -> float:
    """Heat that the upper wall takes less than the lower one, over that, at the end of a run."""
    with Recording(run) as recording:
        heat = recording.field("gas", "wall.heat_flux")[-1]
    lower, upper = heat[::2], heat[1::2]  # a column of nodes after the other
    return float(1.0 - upper.mean() / lower.mean())


def main(folders: list[str]) -> None:
    """Draw."""
    figure, (fast, warm) = plt.subplots(1, 2, figsize=(9.0, 4.0), layout="constrained")
    for folder, mark in zip(folders, "osd^v", strict=False):
        table = tomllib.loads((Path(folder) / "scene.toml").read_text())["components"]["gas"]
        label = f"{round(1.0 / table['box']['spacing'])} in the gap"
        height, speed, temperature = nodes(Path(folder))
        print(f"{label}: {missing(Path(folder)):.2%} less heat through the upper wall")
        fast.plot(speed, height, mark, markersize=4, fillstyle="none", label=label)
        warm.plot(temperature, height, mark, markersize=4, fillstyle="none", label=label)
    height, speed, temperature = exact()
    fast.plot(speed, height, "k", linewidth=0.8, label="exact")
    warm.plot(temperature, height, "k", linewidth=0.8, label="exact")
    fast.set(xlabel="velocity [m/s]", ylabel="height in the gap [m]")
    warm.set(xlabel="temperature [K]")
    warm.legend()
    out = Path(folders[0]) / "profile.png"
    figure.savefig(out, dpi=90)
    print(f"drawn in {out}")


if __name__ == "__main__":
    main(sys.argv[1:])
