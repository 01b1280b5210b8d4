"""Free surfaces of runs and finite differences: ``python -m quintet.scenarios.flyer.surface``.

RUNS are folders of runs of this scene, of aluminium at 1000 m/s with a flyer of 2 mm. Draws the
velocity of each free surface beside that of `waves.py` into `surface.png` in the first folder.
"""

import sys
import tomllib
from pathlib import Path

import matplotlib

from quintet.coupler.files.recording import Recording
from quintet.scenarios.flyer.waves import METALS, struck

matplotlib.use("Agg")
import matplotlib.pyplot as plt

CELLS = 200  # of finite differences, in the flyer


def main(folders: list[str]) -> None:
    """Draw."""
    figure, axes = plt.subplots(1, len(folders), figsize=(5 * len(folders), 4), squeeze=False)
    for axis, folder in zip(axes[0], map(Path, folders), strict=True):
        flyer, target = tomllib.loads((folder / "scene.toml").read_text())["components"]["plates"][
            "bodies"
        ]
        thick = target["highest"][2]
        with Recording(folder) as recording:
            time = recording.times("plates")
            speed = recording.history("plates", "gauges.velocity", 0)[:, 2]
        metal = METALS["aluminium"]
        exact = struck(metal, flyer["velocity"][2], -flyer["lowest"][2], thick, time[-1], CELLS)
        axis.plot(1e6 * exact.time, exact.surface, "k-", label=f"finite differences, {CELLS} cells")
        axis.plot(1e6 * time, speed, "C1-", label="particles")
        arrival = 1e6 * float(exact.time[exact.surface > 100.0][0])
        axis.set(
            xlim=(arrival - 0.1, 1e6 * time[-1]), ylim=(500.0, 1050.0), xlabel="t [µs]",
            title=f"aluminium, target {1e3 * thick:.0f} mm",
        )  # fmt: skip
        axis.grid(alpha=0.3)
    axes[0, 0].set_ylabel("velocity of the free surface [m/s]")
    axes[0, 0].legend(loc="lower right")
    figure.tight_layout()
    figure.savefig(Path(folders[0]) / "surface.png", dpi=90)
    print(Path(folders[0]) / "surface.png")


if __name__ == "__main__":
    main(sys.argv[1:])
