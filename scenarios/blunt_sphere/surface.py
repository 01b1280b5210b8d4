"""Pressure and heat flux along a sphere: ``python -m quintet.scenarios.blunt_sphere.surface RUN``.

RUN is the folder of a run of this scene, or several. Draws `surface.png` beside the first:
pressure over that of Rayleigh where the flow meets the sphere, beside modified Newtonian
theory, and heat flux over that of Fay and Riddell there, of runs with friction.
"""

import sys
import tomllib
from pathlib import Path

import matplotlib
import numpy as np

from quintet.coupler.files.recording import Recording
from quintet.interfaces.component import Array

matplotlib.use("Agg")
import matplotlib.pyplot as plt

TIMES = (1.0,)  # over the end of the run: before it local steps have no meaning
GAMMA = 1.4


def mach_of(run: Path) -> float:
    """Mach number of the stream; its speed of sound is 1."""
    gas = tomllib.loads((run / "scene.toml").read_text())["components"]["gas"]
    return float(gas["boundaries"]["far"]["state"]["velocity"][0])


def pitot(mach: float) -> float:
    """Pressure behind a normal shock, brought to rest, over the static one ahead (Rayleigh)."""
    square, g = mach * mach, GAMMA
    above = (g + 1.0) ** 2 * square / (4.0 * g * square - 2.0 * (g - 1.0))
    return float(above ** (g / (g - 1.0)) * (1.0 - g + 2.0 * g * square) / (g + 1.0))


def curves(run: Path, field: str) -> tuple[Array, Array, Array]:
    """Angles (w,) rad from the stagnation point; times (k,) s; values (k, w)."""
    with Recording(run / "recording.h5") as recording:
        places = recording.field("gas", "wall.position")[-1]
        angle = np.arctan2(np.hypot(places[:, 1], places[:, 2]), -places[:, 0])
        order = np.argsort(angle)
        times = recording.times("gas")
        rows = [int(np.abs(times - share * times[-1]).argmin()) for share in TIMES]
        return angle[order], times[rows], recording.field("gas", field)[rows][:, order]


def draw(run: Path, field: str, panel: plt.Axes) -> None:
    """Draw a field at several times, over its law at the stagnation point."""
    mach = mach_of(run)
    angle, times, values = curves(run, field)
    degrees = np.degrees(angle)
    if field == "wall.pressure":
        scale = pitot(mach) / GAMMA  # the density and the speed of sound of the stream are 1
        least = 1.0 / pitot(mach)
        theory = least + (1.0 - least) * np.cos(angle) ** 2
        panel.plot(degrees, theory, "k--", linewidth=0.8, label="modified Newtonian")
        panel.set_ylabel("pressure over that of Rayleigh")
    else:
        with Recording(run / "recording.h5") as recording:
            ratio = float(recording.field("gas", "body.heat_ratio")[-1][0])
        near = angle < max(0.25, 3.0 * angle[0])
        scale = float(np.polyfit(angle[near] ** 2, values[-1][near], 1)[1]) / ratio
        panel.axhline(1.0, color="black", linestyle="--", linewidth=0.8, label="Fay and Riddell")
        panel.set_ylabel("heat flux over that of Fay and Riddell")
    for time, line in zip(times, values, strict=True):
        panel.plot(degrees, line / scale, ".-", markersize=3.0, label=f"t = {time:.3g} s")
    panel.set(xlabel="angle from the stagnation point [degrees]", title=f"M = {mach:g}", ylim=0.0)
    panel.legend(frameon=False, fontsize=8)


def main(folders: list[str]) -> None:
    """Draw."""
    shown = []
    for run in map(Path, folders):
        with Recording(run / "recording.h5") as recording:
            known = recording.fields("gas")
        fields = ("wall.pressure", "wall.heat_flux")
        shown += [(run, field) for field in fields if field in known]
    figure, panels = plt.subplots(
        1, len(shown), figsize=(4.6 * len(shown), 3.8), layout="constrained", squeeze=False
    )
    for panel, (run, field) in zip(panels.flat, shown, strict=True):
        draw(run, field, panel)
    out = Path(folders[0]) / "surface.png"
    figure.savefig(out, dpi=110)
    print(f"drawn in {out}")


if __name__ == "__main__":
    main(sys.argv[1:])
