"""Densities along tubes beside exact ones: ``python -m quintet.scenarios.shock_tube.profiles RUN``.

RUN is the folder of a run of this scene; several give a panel each. Draws `profiles.png` beside the
first.
"""

import csv
import sys
import tomllib
from pathlib import Path

import matplotlib
import numpy as np

from quintet.coupler.files import vtkhdf_reader
from quintet.interfaces.component import Array

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def exact() -> dict[str, Array]:
    """Of each tube places and densities (k, 2) m, kg/m3 at the run's end."""
    text = Path(__file__).with_name("exact.csv").read_text().splitlines()[2:]
    rows = list(csv.reader(text))
    names = dict.fromkeys(row[0] for row in rows)
    return {name: np.array([row[1:] for row in rows if row[0] == name], float) for name in names}


def nodes(run: Path) -> tuple[Array, Array]:
    """Places along the tube [m] and densities [kg/m3] of all nodes at the end."""
    file = run / "gas.vtkhdf"
    view = vtkhdf_reader.read_step(file, len(vtkhdf_reader.times(file)) - 1)[1]
    return view["points"][:, 0], view["density"]


def tube_of(run: Path) -> str:
    """Name of the tube whose states a run begins with."""
    states = tomllib.loads((run / "scene.toml").read_text())["components"]["gas"]["riemann"]
    left = states["left"]["density"]
    for name, rows in exact().items():
        right = states["right"]["density"]
        if np.allclose(rows[[0, -1], 1], [left, right]) and is_end(run, name):
            return name
    raise SystemExit(f"{run}: its states are none of {', '.join(exact())}.")


ENDS = {
    "sod": 0.2,
    "lax": 0.13,
    "rarefactions": 0.15,
    "woodward_colella": 0.012,
    "noh": 1.0,
    "vacuum": 0.05,
}  # s


def is_end(run: Path, name: str) -> bool:
    """Whether a run ends when the exact densities of a tube are known."""
    return bool(np.isclose(tomllib.loads((run / "scene.toml").read_text())["end"], ENDS[name]))


def main(folders: list[str]) -> None:
    """Draw."""
    runs = [Path(folder) for folder in folders]
    columns = min(3, len(runs))
    rows = -(-len(runs) // columns)
    figure, panels = plt.subplots(
        rows, columns, figsize=(4.6 * columns, 3.4 * rows), layout="constrained", squeeze=False
    )
    for panel in panels.flat[len(runs) :]:
        panel.set_visible(False)
    for panel, run in zip(panels.flat, runs, strict=False):
        name = tube_of(run)
        line, (x, density) = exact()[name], nodes(run)
        panel.plot(x, density, ".", color="tab:blue", markersize=2.0, label="nodes")
        panel.plot(line[:, 0], line[:, 1], color="black", linewidth=0.8, label="exact")
        panel.set_title(f"{name}, t = {ENDS[name]:g} s", fontsize=10)
        panel.set(xlabel="x [m]", ylabel="density [kg/m3]")
    panels[0, 0].legend(frameon=False, markerscale=4.0)
    out = runs[0] / "profiles.png"
    figure.savefig(out, dpi=110)
    print(f"drawn in {out}")


if __name__ == "__main__":
    main(sys.argv[1:])
