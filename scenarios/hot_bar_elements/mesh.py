"""What held points give by mesh: ``python -m quintet.scenarios.hot_bar_elements.mesh STUDY``.

STUDY is the folder that `quintet study hot_bar_elements --out STUDY` left. Prints mean temperature
and heat flow by the size of the elements, and draws `mesh.png` there.
"""

import sys
import tomllib
from pathlib import Path

import matplotlib
import numpy as np

from quintet.coupler.files.recording import Recording

matplotlib.use("Agg")
import matplotlib.pyplot as plt

ACROSS = 10.0  # mm, of the bar
SLOPE, THIRD = 3.6, 500.0 / 3.0  # K/mm, K


def read(folder: Path) -> tuple[float, float, float, float]:
    """Size of the elements [mm], mean temperature, that 5 mm from the hot vertex [K], heat [W]."""
    bar = tomllib.loads((folder / "scene.toml").read_text())["components"]["bar"]
    with Recording(folder) as recording:
        mean = recording.field("bar", "parts.temperature")[-1, 0]
        beside = recording.field("bar", "node_gauge.temperature")[-1, 0]
        heat = recording.field("bar", "held.heat_flow")[-1, 0]
    return ACROSS / bar["parts"][0]["elements"][1], float(mean), float(beside), float(heat)


def main(study: str) -> None:
    """Print and draw."""
    folders = sorted(path.parent for path in Path(study).rglob("scene.toml"))
    rows = np.array(sorted(read(folder) for folder in folders))
    print("elements [mm]  mean [K]  5 mm from the hot vertex [K]  heat [W]")
    for size, mean, beside, heat in rows[::-1].tolist():
        print(f"{size:13.3f} {mean:9.2f} {beside:29.2f} {heat:9.2f}")
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
    left.semilogx(rows[:, 0], rows[:, 1], "o-", label="mean")
    left.semilogx(rows[:, 0], rows[:, 2], "s-", label="node nearest to 5 mm from the hot vertex")
    left.semilogx(rows[:, 0], THIRD + SLOPE * rows[:, 0], "k:", label="166.7 K + 3.6 K/mm h")
    left.axhline(THIRD, color="k", linewidth=0.8)
    left.set(xlabel="size of the elements h [mm]", ylabel="temperature [K]")
    left.legend()
    right.loglog(rows[:, 0], rows[:, 3], "o-", label="enters at 500 K")
    right.loglog(rows[:, 0], rows[0, 3] * rows[:, 0] / rows[0, 0], "k:", label="~ h")
    right.set(xlabel="size of the elements h [mm]", ylabel="heat flow [W]")
    right.legend()
    figure.tight_layout()
    figure.savefig(Path(study) / "mesh.png", dpi=90)


if __name__ == "__main__":
    main(sys.argv[1])
