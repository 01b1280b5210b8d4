"""Pressure on the sphere, and ways of particles.

``python -m quintet.scenarios.shock_layer_particle.surface RUN ...``, RUN the folder of a run of
this scene. Draws `surface.png` beside the first: pressure along the
sphere at several times, its largest value and where it is, and how far particles go.
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

CURVES = 6  # times at which pressure is drawn


class Run:
    """One run: pressure along the sphere, and where particles are, over time."""

    def __init__(self, folder: Path) -> None:
        scene = tomllib.loads((folder / "scene.toml").read_text())
        self.name = folder.name
        self.launch = float(scene["components"]["particle"]["spheres"][0]["launch"])
        state = scene["components"]["gas"]["initial"]
        self.rest = _pitot(state)
        with Recording(folder) as recording:
            self.times = recording.times("gas")
            pressure = recording.field("gas", "surface.pressure")
            angle = recording.field("gas", "surface.angle")[0]
            self.places = recording.field("gas", "bodies.position")[:, 1:, 0]
        wall = np.flatnonzero(np.diff(angle) < 0.0)
        nodes = wall[0] + 1 if len(wall) else len(angle)  # of the first body
        self.pressure = pressure[:, :nodes] / self.rest
        self.angle = np.degrees(angle[:nodes])

    def at(self, time: float) -> int:
        """Row of a time."""
        return int(np.abs(self.times - time).argmin())


def _pitot(state: dict[str, object]) -> float:
    """Rayleigh's pitot pressure [Pa]; γ = 1.4."""
    density, pressure = float(str(state["density"])), float(str(state["pressure"]))
    speed = np.array(state["velocity"], float)
    square = float(speed @ speed) * density / (1.4 * pressure)
    behind = (1.0 - 1.4 + 2.8 * square) / 2.4
    return pressure * behind * (2.4**2 * square / (5.6 * square - 0.8)) ** 3.5


def ring(run: Run) -> tuple[Array, Array]:
    """Largest pressure off the axis over time, and its angle [degrees]."""
    off = run.angle > 10.0
    row = run.pressure[:, off].argmax(axis=1)
    return run.pressure[:, off][np.arange(len(row)), row], run.angle[off][row]


def draw(runs: list[Run], path: Path) -> None:
    """Draw the three panels."""
    figure, (along, peak, ways) = plt.subplots(1, 3, figsize=(15.0, 4.6), layout="constrained")
    one = runs[0]
    shown = np.linspace(one.launch, one.times[-1], CURVES)
    for k, time in enumerate(shown):
        colour = plt.get_cmap("viridis")(k / (CURVES - 1))
        row = one.at(time)
        label = f"t = {one.times[row]:.1f} s, particle at {-one.places[row, 0]:.2f} R"
        along.plot(one.angle, one.pressure[row], color=colour, label=label)
    newton = np.cos(np.radians(np.minimum(one.angle, 90.0))) ** 2
    along.plot(one.angle, newton, "k:", label="cos², without a particle")
    along.set(xlim=(0, 110), xlabel="angle from the axis [degrees]", title=f"sphere, {one.name}")
    along.set_ylabel("pressure over Rayleigh's pitot pressure")
    along.legend(fontsize="small")
    after = one.times >= one.launch
    height, angle = ring(one)
    peak.plot(one.times[after], angle[after], color="tab:blue")
    peak.set(xlabel="t [s]", title="largest pressure off the axis")
    peak.set_ylabel("its angle [degrees]", color="tab:blue")
    other = peak.twinx()
    other.plot(one.times[after], height[after], color="tab:red")
    other.set_ylabel("its size over Rayleigh's pitot pressure", color="tab:red")
    for run in runs:
        for k in range(run.places.shape[1]):
            ways.plot(run.times, -run.places[:, k], label=f"{run.name}, particle {k}")
    ways.set(xlabel="t [s]", ylabel="distance from the sphere's centre [R]", title="particles")
    ways.legend(fontsize="small")
    figure.savefig(path, dpi=110)


def main() -> None:
    """Draw, and print what the README says."""
    runs = [Run(Path(folder)) for folder in sys.argv[1:]]
    for run in runs:
        height, angle = ring(run)
        after = run.times >= run.launch + 0.3
        best = np.flatnonzero(after)[height[after].argmax()]
        print(
            f"{run.name}: farthest {np.round(-run.places.min(axis=0), 3).tolist()} R; largest "
            f"{height[best]:.2f} of Rayleigh's at {angle[best]:.0f} degrees, t = "
            f"{run.times[best]:.2f} s; outermost ring at {angle[after].max():.0f} degrees"
        )
    draw(runs, Path(sys.argv[1]) / "surface.png")


if __name__ == "__main__":
    main()
