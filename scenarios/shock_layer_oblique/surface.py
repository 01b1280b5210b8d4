"""Pressure and heat flux on the sphere, over those without a particle, and the particle's way.

``python -m quintet.scenarios.shock_layer_oblique.surface RUN ALONE``, folders of a run of this
scene and of one of `alone.toml`, with friction or without as the first. Draws `surface.png`
beside the first: the sphere as the stream sees it at several times, the meridian that the particle
flies over, and the largest values over time.
"""

import sys
from pathlib import Path

import matplotlib
import numpy as np

from quintet.coupler.files.recording import Recording
from quintet.interfaces.component import Array

matplotlib.use("Agg")
import matplotlib.pyplot as plt

SHOWN = 4  # times at which the sphere is drawn
MERIDIAN = 0.1  # m, from y = 0, within which nodes count as on the meridian
ASIDE = 0.15  # m, from the axis, from which on the particle's effect is looked at: before, the
# stream's arrival is felt
NEAR = 0.35  # rad from the axis: where the undisturbed value is taken
NAMES = {"pressure": "pressure", "heat_flux": "heat flux"}


class Run:
    """Values on the sphere, and where the particle is, over time."""

    def __init__(self, folder: Path) -> None:
        with Recording(folder) as recording:
            self.times = recording.times("gas")
            wall = recording.field("gas", "surface.position")[0]
            bodies = recording.field("gas", "bodies.position")
            self.way = bodies[:, 1] if bodies.shape[1] > 1 else None
            on = np.abs(np.sqrt((wall**2).sum(axis=1)) - 1.0) < 1e-6  # of the sphere, not moving
            self.wall = wall[on]
            self.fields = {name: recording.field("gas", f"surface.{name}")[:, on] for name in NAMES}

    @property
    def name(self) -> str:
        """What is of interest: heat flux if there is friction, else pressure."""
        return "heat_flux" if self.fields["heat_flux"].any() else "pressure"


def undisturbed(run: Run, name: str) -> float:
    """Value where the stream meets a sphere that is alone, at the end of its run.

    Of the parabola in the angle that fits best near the axis.
    """
    angle = np.arccos(-run.wall[:, 0])
    near = angle < NEAR
    last = max(1, len(run.times) // 4)
    values = run.fields[name][-last:, near].mean(axis=0)
    return float(np.polyfit(angle[near] ** 2, values, 1)[1])


def peaks(run: Run, name: str, begin: float) -> tuple[Array, Array, Array]:
    """Rows after a time, the largest value of each, and its node."""
    rows = np.flatnonzero(run.times >= begin)
    values = run.fields[name][rows]
    return rows, values.max(axis=1), values.argmax(axis=1)


def draw(run: Run, rest: dict[str, float], begin: float, path: Path) -> None:
    """Draw maps, meridian and peaks."""
    name = run.name
    figure, axes = plt.subplots(2, SHOWN, figsize=(4.0 * SHOWN, 7.6), layout="constrained")
    shown = [int(np.abs(run.times - t).argmin()) for t in np.linspace(begin, run.times[-1], SHOWN)]
    top = run.fields[name][shown].max() / rest[name]
    meridian = np.flatnonzero(np.abs(run.wall[:, 1]) < MERIDIAN)
    angle = np.degrees(np.arctan2(run.wall[:, 2], -run.wall[:, 0]))
    meridian = meridian[np.argsort(angle[meridian])]
    below = axes[1]
    for k, row in enumerate(shown):
        values = run.fields[name][row] / rest[name]
        drawn = axes[0, k].tripcolor(
            run.wall[:, 1], run.wall[:, 2], values, shading="gouraud", vmin=0.0, vmax=top,
            cmap="inferno",
        )  # fmt: skip
        axes[0, k].set(aspect="equal", title=f"t = {run.times[row]:.2f} s", xlabel="y [R]")
        if run.way is not None:
            axes[0, k].add_patch(plt.Circle(tuple(run.way[row, 1:]), 0.075, fill=False, ec="cyan"))
        shade = plt.get_cmap("viridis")(k / (SHOWN - 1))
        below[0].plot(
            angle[meridian], values[meridian], color=shade, label=f"t = {run.times[row]:.2f} s"
        )
    axes[0, 0].set_ylabel("z [R]")
    figure.colorbar(drawn, ax=axes[0, -1], label=f"{NAMES[name]} over the undisturbed")
    below[0].set(
        xlabel="angle in the plane of flight [degrees]",
        ylabel=f"{NAMES[name]} over the undisturbed",
    )
    below[0].legend(fontsize="small")
    for field, colour in zip(NAMES, ("tab:blue", "tab:red"), strict=True):
        if rest[field] > 0.0:
            rows, high, at = peaks(run, field, begin)
            below[1].plot(run.times[rows], high / rest[field], color=colour, label=NAMES[field])
            below[2].plot(run.times[rows], angle[at], ".", color=colour, label=NAMES[field])
    below[1].set(xlabel="t [s]", title="largest, over the undisturbed")
    below[2].set(xlabel="t [s]", title="where, angle in the plane of flight [degrees]")
    below[1].legend(fontsize="small")
    if run.way is not None:
        below[3].plot(run.way[:, 0], run.way[:, 2])
    below[3].add_patch(plt.Circle((0.0, 0.0), 1.0, fill=False))
    below[3].set(aspect="equal", xlim=(-2.5, 0.1), ylim=(-1.2, 1.8), title="the particle's way [R]")
    figure.savefig(path, dpi=110)
    plt.close(figure)


def main() -> None:
    """Draw, and print what the README says."""
    run, alone = (Run(Path(folder)) for folder in sys.argv[1:3])
    assert run.way is not None
    begin = float(run.times[np.flatnonzero(run.way[:, 2] > ASIDE)[0]])
    rest = {name: undisturbed(alone, name) for name in NAMES}
    for name, words in NAMES.items():
        if rest[name] > 0.0:
            rows, high, at = peaks(run, name, begin)
            best = high.argmax()
            place = run.wall[at[best]]
            angle = np.degrees(np.arctan2(place[2], -place[0]))
            print(
                f"{words}: undisturbed {rest[name]:.4g}; largest {high[best] / rest[name]:.2f} "
                f"times that, at t = {run.times[rows[best]]:.2f} s, {angle:.0f} degrees in the "
                "plane of flight"
            )
    draw(run, rest, begin, Path(sys.argv[1]) / "surface.png")


if __name__ == "__main__":
    main()
