"""Error against run time: ``python -m quintet.scenarios.shock_tube.precision STUDY...``.

STUDY is a folder of ``quintet study shock_tube``, or of ``quintet study blunt_sphere``; each has a
panel, with other codes as points. Draws `precision.png` beside the first.
"""

import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.ticker import NullFormatter

# Mean error of the density of Sod's tube, processor time [s]: OpenFOAM 1912, 200 cells along x.
SOD = {"rhoCentralFoam, 200": (3.12e-3, 0.08)}
# The same of Clawpack 5 (Roe, van Leer), whose times are not known.
LEVELS = {"Clawpack, 100": 4.39e-3, "Clawpack, 200": 2.25e-3, "Clawpack, 400": 1.27e-3}
# Stand-off of the shock before a sphere at Mach 6 over its radius, processor time [s]: OpenFOAM
# 1912 on a wedge of cells; stand-off of the Euler equations, by extrapolation.
SPHERE = {"rhoCentralFoam, 24 x 24": (0.1480, 5.5), "rhoCentralFoam, 48 x 48": (0.1464, 45.7)}
STANDOFF, UNSURE = 0.1465, 0.001


def main(folders: list[str]) -> None:
    """Draw."""
    studies = [json.loads((Path(folder) / "study.json").read_text()) for folder in folders]
    figure, panels = plt.subplots(
        1, len(studies), figsize=(5.6 * len(studies), 4.2), layout="constrained", squeeze=False
    )
    for panel, study in zip(panels[0], studies, strict=True):
        is_tube = study["scene"] == "shock_tube"
        name = "density" if is_tube else "standoff"
        rows = [row for row in study["rows"] if name in row["errors"]]
        scale = 1.0 if is_tube else 1.0 / STANDOFF
        errors = [scale * row["errors"][name] for row in rows]
        times = [row["cpu"] for row in rows]
        panel.loglog(times, errors, "o-", color="tab:blue", label="quintet")
        for row, time, error in zip(rows, times, errors, strict=True):
            panel.annotate(row["label"], (time, error), (5, 5), textcoords="offset points")
        others = SOD if is_tube else SPHERE
        for label, (value, time) in others.items():
            error = value if is_tube else abs(value - STANDOFF) / STANDOFF
            panel.plot(time, error, "s", color="tab:red")
            panel.annotate(label, (time, error), (5, -12), textcoords="offset points")
        for label, level in LEVELS.items() if is_tube else ():
            panel.axhline(level, color="grey", linewidth=0.8, linestyle=":")
            panel.annotate(
                label, (times[-1], level), (0, 2), textcoords="offset points", ha="right"
            )
        if not is_tube:
            panel.axhline(UNSURE / STANDOFF, color="grey", linewidth=0.8, linestyle=":")
            place = (times[0], UNSURE / STANDOFF)
            panel.annotate("uncertainty of 0.1465", place, (0, 2), textcoords="offset points")
        panel.margins(x=0.3)
        panel.xaxis.set_minor_formatter(NullFormatter())
        axis_label = "mean error of the density [kg/m3]" if is_tube else "error of the stand-off"
        panel.set(xlabel="processor time [s]", ylabel=axis_label, title=study["scene"])
    out = Path(folders[0]) / "precision.png"
    figure.savefig(out, dpi=110)
    print(f"drawn in {out}")


if __name__ == "__main__":
    main(sys.argv[1:])
