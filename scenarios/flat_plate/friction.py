"""Friction along the plate: ``python -m quintet.scenarios.flat_plate.friction RUN ...``.

RUN is the folder of a run of this scene, or several. Draws `friction.png` beside the first, over
that of Blasius, 0.664/√Re_x of ρU²/2, and prints it where README has it.
"""

import sys
from pathlib import Path

import matplotlib
import numpy as np

from quintet.coupler.files.recording import Recording
from quintet.interfaces.component import Array

matplotlib.use("Agg")
import matplotlib.pyplot as plt

SPEED, VISCOSITY = 0.3, 3e-5  # m/s, m2/s
DRAG = 0.01328  # 1, of Blasius, 1.328/√Re
PLACES = (0.1, 0.15, 0.25, 0.51, 0.69, 0.8)  # m


def blasius(x: Array) -> Array:
    """Friction [Pa]."""
    return np.asarray(0.332 * SPEED**2 / np.sqrt(SPEED * x / VISCOSITY))


def friction(run: Path) -> tuple[Array, Array, float]:
    """Places [m] along the plate, and the friction [Pa] there at the end; coefficient of drag."""
    with Recording(run) as recording:
        x = recording.field("gas", "wall.position")[-1, :, 0]
        stress = recording.field("gas", "wall.friction")[-1, :, 0]
        drag = float(recording.field("gas", "body.drag_coefficient")[-1, 0])
    on_plate = x > 0.0
    order = np.argsort(x[on_plate])
    return x[on_plate][order], stress[on_plate][order], drag


def main(folders: list[str]) -> None:
    """Draw, and print."""
    figure, panel = plt.subplots(figsize=(6.0, 4.0), layout="constrained")
    for folder in map(Path, folders):
        x, stress, drag = friction(folder)
        panel.plot(x, stress / blasius(x), "o-", markersize=3, label=folder.name)
        near = [int(np.abs(x - place).argmin()) for place in PLACES]
        ratios = ", ".join(f"{x[k]:.2f}: {stress[k] / blasius(x[k]):.3f}" for k in near)
        print(f"{folder.name}: {ratios}, whole plate: {drag / DRAG:.3f}")
    panel.axhline(1.0, color="k", linewidth=0.8)
    panel.set(xlim=(0.0, 1.0), ylim=(0.85, 1.15), xlabel="x [m]", ylabel="friction over Blasius'")
    panel.legend()
    out = folders[0] + "/friction.png"
    figure.savefig(out, dpi=90)
    print(f"drawn in {out}")


if __name__ == "__main__":
    main(sys.argv[1:])
