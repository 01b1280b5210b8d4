"""Pressure and heat flux on the sphere, and ways of particles.

``python -m quintet.scenarios.shock_layer_particle.surface RUN ...``, RUN the folder of a run of
this scene; that of preset `alone` says what is there without a particle. Draws `surface.png` beside
the first.
"""

import sys
import tomllib
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.axes import Axes

from quintet.coupler.files.recording import Recording
from quintet.interfaces.component import Array

matplotlib.use("Agg")
import matplotlib.pyplot as plt

CURVES = 6  # times of which curves are drawn
EARLY = 1.6  # exponent that puts more of them early
OFF = 10.0  # degrees from the axis, beyond which a peak is that of the ring
STEP = 0.14  # s, between times at which the ring is told
BEGUN = 0.1  # s after the last launch
SETTLED = 0.3  # s after the first launch


class Run:
    """One run: what the sphere feels, and where particles are, over time."""

    def __init__(self, folder: Path) -> None:
        scene = tomllib.loads((folder / "scene.toml").read_text())
        gas, bodies = scene["components"]["gas"], scene["components"]["gas"]["moving"]["bodies"]
        self.name = folder.name
        self.has_particles = len(bodies) > 1
        spheres = scene["components"]["particle"]["spheres"]
        launches = [sphere.get("launch", 0.0) for sphere in spheres]
        self.launch, self.last_launch = min(launches), max(launches)
        with Recording(folder) as recording:
            self.times = recording.times("gas")
            pressure = recording.field("gas", "surface.pressure")
            heat = recording.field("gas", "surface.heat_ratio")
            angle = recording.field("gas", "surface.angle")[0]
            self.places = recording.field("gas", "bodies.position")[:, 1:, 0]
            self.forces = recording.field("gas", "bodies.force")[:, 1:, 0]
        ends = np.flatnonzero(np.diff(angle) < 0.0)
        nodes = int(ends[0]) + 1 if len(ends) else len(angle)  # of the first body
        self.angle = np.degrees(angle[:nodes])
        self.pressure = pressure[:, :nodes] / _pitot(gas["initial"])
        self.heat = heat[:, :nodes] if gas.get("viscous") else None  # over Fay and Riddell's

    def at(self, time: float) -> int:
        """Row of a time."""
        return int(np.abs(self.times - time).argmin())


def _pitot(state: dict[str, Any]) -> float:
    """Rayleigh's pitot pressure [Pa]; γ = 1.4."""
    density, pressure = float(state["density"]), float(state["pressure"])
    speed = np.array(state["velocity"], float)
    square = float(speed @ speed) * density / (1.4 * pressure)
    behind = (1.0 - 1.4 + 2.8 * square) / 2.4
    return pressure * behind * (2.4**2 * square / (5.6 * square - 0.8)) ** 3.5


def ring(angle: Array, values: Array) -> tuple[Array, Array]:
    """Largest value off the axis over time, and its angle [degrees].

    Parameters
    ----------
    angle : (a,) degrees
    values : (times, a)
    """
    off = angle > OFF
    row = values[:, off].argmax(axis=1)
    return values[:, off][np.arange(len(row)), row], angle[off][row]


def draw(runs: list[Run], alone: Run | None, path: Path) -> None:
    """Draw all panels."""
    first = runs[0]
    rows = 1 if first.heat is None else 2
    figure, panels = plt.subplots(
        rows, 3, figsize=(16.0, 4.8 * rows), layout="constrained", squeeze=False
    )
    undisturbed = None if alone is None else alone.pressure[-1]
    _along(
        panels[0, 0], first, first.pressure, undisturbed, "pressure over Rayleigh's pitot pressure"
    )
    _against_time(panels[0, 1], first, first.pressure, 1.0, "pressure", "Rayleigh's pitot pressure")
    for run in runs:
        for k in range(run.places.shape[1]):
            panels[0, 2].plot(run.times, -run.places[:, k], label=f"{run.name}, particle {k}")
    panels[0, 2].set(xlabel="t [s]", ylabel="distance from the sphere's centre [R]")
    panels[0, 2].set(title="particles")
    panels[0, 2].legend(fontsize="small")
    if first.heat is not None:
        known = None if alone is None or alone.heat is None else alone.heat[-1]
        rest = 1.0 if known is None else float(known[0])
        label = "heat flux over that of Fay and Riddell"
        _along(panels[1, 0], first, first.heat, known, label)
        text = "that of Fay and Riddell" if known is None else "that at the axis without a particle"
        _against_time(panels[1, 1], first, first.heat, rest, "heat flux", text)
        _map(panels[1, 2], first, first.heat, known)
    figure.savefig(path, dpi=100)


def _along(panel: Axes, run: Run, values: Array, undisturbed: Array | None, label: str) -> None:
    """Values along the sphere at several times."""
    shown = run.launch + (run.times[-1] - run.launch) * np.linspace(0.0, 1.0, CURVES) ** EARLY
    for k, time in enumerate(shown):
        row = run.at(time)
        text = f"t = {run.times[row]:.1f} s, particle at {-run.places[row, 0]:.2f} R"
        panel.plot(
            run.angle, values[row], color=plt.get_cmap("viridis")(k / (CURVES - 0.5)), label=text
        )
    if undisturbed is not None:
        panel.plot(run.angle, undisturbed, "k--", label="without a particle")
    panel.set(xlim=(0, 90), xlabel="angle from the axis [degrees]", ylabel=label)
    panel.set(title=f"along the sphere, {run.name}")
    panel.legend(fontsize="small")


def _against_time(panel: Axes, run: Run, values: Array, rest: float, name: str, over: str) -> None:
    """Size and angle of the ring over time."""
    after = run.times >= run.launch
    height, angle = ring(run.angle, values)
    panel.plot(run.times[after], angle[after], color="tab:blue", linewidth=0.8)
    panel.set(xlabel="t [s]", title=f"largest {name} beyond {OFF:.0f} degrees")
    panel.set_ylabel("its angle [degrees]", color="tab:blue")
    other = panel.twinx()
    other.plot(run.times[after], height[after] / rest, color="tab:red")
    other.set_ylabel(f"its size over {over}", color="tab:red")


def _map(panel: Axes, run: Run, values: Array, undisturbed: Array | None) -> None:
    """Values over time and angle, over those without a particle where they are known."""
    after = run.times >= run.launch
    shown = values[after] if undisturbed is None else values[after] / undisturbed
    mesh = panel.pcolormesh(
        run.times[after], run.angle, shown.T, cmap="inferno", shading="nearest", vmin=0.0,
        rasterized=True,
    )  # fmt: skip
    panel.set(xlabel="t [s]", ylabel="angle from the axis [degrees]", title="heat flux")
    text = "that of Fay and Riddell" if undisturbed is None else "that there without a particle"
    panel.figure.colorbar(mesh, ax=panel, label=f"over {text}")


def tell(run: Run, alone: Run | None) -> str:
    """Say what the README says of a run."""
    after = run.times >= run.launch + SETTLED
    lines = [f"{run.name}: farthest {np.round(-run.places.min(axis=0), 3).tolist()} R"]
    pairs = [("pressure over Rayleigh's", run.pressure, 1.0)]
    if run.heat is not None:
        pairs.append(("heat flux over Fay and Riddell's", run.heat, 1.0))
        if alone is not None and alone.heat is not None:
            rest = float(alone.heat[-1, 0])
            pairs.append(("heat flux over that at the axis without a particle", run.heat, rest))
            pairs.append(("heat flux over that there without", run.heat / alone.heat[-1], 1.0))
    for name, values, rest in pairs:
        height, angle = ring(run.angle, values)
        best = np.flatnonzero(after)[height[after].argmax()]
        lines.append(
            f"  largest {name}: {height[best] / rest:.2f} at {angle[best]:.0f} degrees, "
            f"t = {run.times[best]:.2f} s, particle at {-run.places[best, 0]:.2f} R; "
            f"outermost at {angle[after].max():.0f} degrees"
        )
    if run.places.shape[1] > 1:
        flight = run.times > run.last_launch + BEGUN
        speeds = np.gradient(run.places, run.times, axis=0)[-3]
        lines.append(
            f"  at t = {run.times[-1]:.2f} s at {np.round(-run.places[-1], 2).tolist()} R with "
            f"{np.round(speeds, 3).tolist()} m/s; mean force since both fly "
            f"{np.round(run.forces[flight].mean(axis=0), 3).tolist()} N"
        )
    if run.heat is not None:
        height, angle = ring(run.angle, run.heat)
        rows = [run.at(time) for time in np.arange(run.launch + STEP, run.times[-1], STEP)]
        lines += [
            f"  t = {run.times[k]:.2f} s, particle at {-run.places[k, 0]:.2f} R: ring of "
            f"{height[k]:.2f} of Fay and Riddell's at {angle[k]:.0f} degrees"
            for k in rows
        ]
    return "\n".join(lines)


def main() -> None:
    """Draw, and print what the README says."""
    all_runs = [Run(Path(folder)) for folder in sys.argv[1:]]
    runs = [run for run in all_runs if run.has_particles]
    alone = next((run for run in all_runs if not run.has_particles), None)
    for run in runs:
        print(tell(run, alone))
    if alone is not None:
        heat = "" if alone.heat is None else f"; heat flux {alone.heat[-1, 0]:.3f} of Fay-Riddell's"
        print(f"{alone.name}: pressure on the axis {alone.pressure[-1, 0]:.3f} of pitot's{heat}")
    draw(runs, alone, Path(sys.argv[1]) / "surface.png")


if __name__ == "__main__":
    main()
