"""Drag of a sphere: ``python -m quintet.scenarios.blunt_sphere.drag STUDY``.

STUDY is the folder of `quintet study blunt_sphere --preset drag`, or several of them: the first is
drawn with full marks, others with open ones. Prints a table and draws `drag.png` into the first:
drag coefficients by the Reynolds number, beside the correlation of Loth and others, AIAA J. 59
(2021) 3261, and 8 % to either side.
"""

import sys
import tomllib
from pathlib import Path
from typing import NamedTuple

import matplotlib
import numpy as np

from quintet.coupler.files.recording import Recording

matplotlib.use("Agg")
import matplotlib.pyplot as plt

WITHIN = 0.08


class Drag(NamedTuple):
    """Drag of one sphere; its stream has density 1 and speed of sound 1."""

    mach: float
    reynolds: float
    drag: float
    by_friction: float


def loth(mach: float, reynolds: float) -> float:
    """Drag coefficient of the correlation, from M = 1.5 and a Reynolds number of 45 on."""
    c = 2.18 - 0.13 * np.tanh(0.9 * mach - 2.7)
    g, h = 5.0 + 40.0 / mach**3, 0.93 + 1.0 / (3.5 + mach**5)
    viscous = 24.0 / reynolds * (1.0 + 0.15 * reynolds**0.687) * h
    return float(
        viscous + 0.42 * c / (1.0 + 42500.0 / reynolds ** (1.16 * c) + g / np.sqrt(reynolds))
    )


def drag(run: Path) -> Drag:
    """What a run has found."""
    gas = tomllib.loads((run / "scene.toml").read_text())["components"]["gas"]
    mach = float(gas["boundaries"]["far"]["state"]["velocity"][0])
    radius = float(gas["sphere"]["radius"])
    with Recording(run / "recording.h5") as recording:
        coefficient = float(recording.field("gas", "body.drag_coefficient")[-1][0])
        places = recording.field("gas", "wall.position")[-1] / radius
        friction = recording.field("gas", "wall.friction")[-1][:, 0]
    half = 0.5 * np.pi / len(places)  # rad, between rays
    angle = np.arctan2(np.hypot(places[:, 1], places[:, 2]), places[:, 0])
    rings = 2.0 * (np.cos(angle - half) - np.cos(angle + half))  # over the cross-section
    part = float((friction * rings).sum() / (0.5 * mach**2))
    return Drag(mach, 2.0 * radius * mach / gas["gas"]["viscosity"], coefficient, part)


def of_study(folder: Path) -> list[Drag]:
    """All runs of a study, by Mach and Reynolds number."""
    return sorted(drag(path.parent) for path in folder.glob("*/recording.h5"))


def draw(panel: plt.Axes, mach: float, studies: dict[str, list[Drag]]) -> None:
    """Draw drags at a Mach number against the Reynolds number."""
    smooth = np.geomspace(75.0, 1400.0, 100)
    law = np.array([loth(mach, reynolds) for reynolds in smooth])
    panel.plot(smooth, law, "k-", linewidth=0.8, label="Loth et al., ± 8 %")
    panel.fill_between(smooth, (1.0 - WITHIN) * law, (1.0 + WITHIN) * law, color="0.9")
    for number, (name, drags) in enumerate(studies.items()):
        points = [point for point in drags if point.mach == mach]
        fill = "none" if number else "tab:blue"
        reynolds = [point.reynolds for point in points]
        values = [point.drag for point in points]
        panel.plot(reynolds, values, "o", color="tab:blue", markerfacecolor=fill, label=name)
    panel.set(xscale="log", title=f"M = {mach:g}", xlabel="Reynolds number by the diameter")


def main(folders: list[str]) -> None:
    """Print, and draw."""
    studies = {}
    for folder in map(Path, folders):
        drags = studies[folder.name] = of_study(folder)
        print(f"{folder}\n   M     Re   drag  by friction  over Loth")
        for point in drags:
            over = point.drag / loth(point.mach, point.reynolds)
            print(
                f"{point.mach:4g} {point.reynolds:6.0f} {point.drag:6.3f} {point.by_friction:12.3f}"
                f" {over:10.3f}"
            )
    numbers = sorted({point.mach for drags in studies.values() for point in drags})
    figure, panels = plt.subplots(
        1, len(numbers), figsize=(3.2 * len(numbers), 3.6), layout="constrained", sharey=True,
        squeeze=False,
    )  # fmt: skip
    for panel, mach in zip(panels.flat, numbers, strict=True):
        draw(panel, mach, studies)
    panels[0, 0].set_ylabel("drag coefficient")
    panels[0, 0].legend(frameon=False, fontsize=8)
    out = Path(folders[0]) / "drag.png"
    figure.savefig(out, dpi=110)
    print(f"drawn in {out}")


if __name__ == "__main__":
    main(sys.argv[1:])
