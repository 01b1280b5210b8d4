"""Numerical schlieren pictures of both halves of the flow, with particles, and a cloud of nodes.

``python -m quintet.scenarios.shock_layer_particle.flow RUN``, RUN the folder of a run of this
scene. Draws `flow.png` in it: the times of its pictures, and the nodes around the particle at one
of them.
"""

import sys
import tomllib
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Wedge
from matplotlib.tri import Triangulation

from quintet.coupler.files import vtkhdf_reader
from quintet.coupler.report.field_drawing import spans_a_hole
from quintet.interfaces.component import Array

matplotlib.use("Agg")
import matplotlib.pyplot as plt

DARK = 4.0  # exponent of the gradient that stands for a strong one
STRONG = 0.97  # share of nodes off the wall with weaker gradients
OFF_WALL = 1.03  # of the sphere's radius
BEYOND = 0.45  # R, of what is shown ahead of the particle
TALL = 1.5  # R, of what is shown on either side of the axis
COLOURS = ("tab:red", "tab:orange")  # of particles


class Flow:
    """Nodes at one time, and spheres in them."""

    def __init__(self, run: Path, step: int) -> None:
        self.time, gas = vtkhdf_reader.read_step(run / "gas.vtkhdf", step)
        _, held = vtkhdf_reader.read_step(run / "particle.vtkhdf", step)
        self.nodes, self.spacing = gas["points"], gas["spacing"]
        self.centres, self.radii = held["points"], held["radius"]
        with np.errstate(divide="ignore"):
            gradient = np.minimum(-np.log(gas["schlieren"]), 700.0)
        away = np.sqrt(self.nodes[:, 0] ** 2 + self.nodes[:, 2] ** 2) > OFF_WALL
        strong = np.quantile(gradient[away], STRONG)
        self.shade = np.exp(-DARK * np.minimum(gradient / strong, 1.0))

    @property
    def apex(self) -> float:
        """Foremost of the particles along x."""
        return float(self.centres[:, 0].min())


def draw_flow(panel: Axes, flow: Flow, apex: float) -> None:
    """Both halves of the flow; bodies as they are."""
    both = np.concatenate([flow.nodes, flow.nodes * np.array([1.0, 1.0, -1.0])])
    triangles = Triangulation(both[:, 0], both[:, 2])
    triangles.set_mask(spans_a_hole(both, np.tile(flow.spacing, 2), triangles.triangles))
    panel.tripcolor(
        triangles, np.tile(flow.shade, 2), cmap="gray", vmin=0.0, vmax=1.0, shading="gouraud",
        rasterized=True,
    )  # fmt: skip
    panel.add_patch(Wedge((0.0, 0.0), 1.0, 90.0, 270.0, facecolor="0.55", edgecolor="k"))
    _particles(panel, flow)
    panel.set(xlim=(apex - BEYOND, 0.0), ylim=(-TALL, TALL), aspect="equal")
    panel.set(xlabel="x [R]", ylabel="z [R]", title=f"t = {flow.time:.2f} s")


def draw_nodes(panel: Axes, flow: Flow) -> None:
    """Nodes around the foremost particle, over the flow."""
    draw_flow(panel, flow, flow.apex)
    panel.plot(flow.nodes[:, 0], flow.nodes[:, 2], "b.", markersize=2.0)
    _window(panel, flow.centres, flow.radii)
    panel.set(title=f"nodes at t = {flow.time:.2f} s")


def _window(panel: Axes, centres: Array, radii: Array) -> None:
    """Show some radii of the foremost particle about it, on one side of the axis."""
    first = centres[:, 0].argmin()
    wide, middle = 5.0 * radii[first], centres[first, 0]
    panel.set(xlim=(middle - 0.8 * wide, middle + 1.2 * wide), ylim=(-0.4 * wide, 2.2 * wide))


def _particles(panel: Axes, flow: Flow) -> None:
    for k, (centre, radius) in enumerate(zip(flow.centres, flow.radii, strict=True)):
        circle = Circle(
            (centre[0], centre[2]), radius, facecolor=COLOURS[k % len(COLOURS)], edgecolor="k",
            linewidth=0.5, zorder=3,
        )  # fmt: skip
        panel.add_patch(circle)


def main() -> None:
    """Draw."""
    run = Path(sys.argv[1])
    times = vtkhdf_reader.times(run / "gas.vtkhdf")
    wanted = tomllib.loads((run / "scene.toml").read_text())["output"]["pictures"]
    steps = sorted({int(np.abs(times - time).argmin()) for time in wanted})
    flows = [Flow(run, step) for step in steps]
    apex = min(flow.apex for flow in flows)
    columns = (len(flows) + 2) // 2
    wide = 4.6 * (BEYOND - apex) / (2.0 * TALL) + 0.7
    figure, panels = plt.subplots(
        2, columns, figsize=(wide * columns, 9.6), layout="constrained", squeeze=False
    )
    places = panels.ravel().tolist()
    for panel, flow in zip(places, flows, strict=False):
        draw_flow(panel, flow, apex)
    draw_nodes(places[len(flows)], flows[len(flows) // 2])
    for unused in places[len(flows) + 1 :]:
        unused.remove()
    figure.savefig(run / "flow.png", dpi=90)


if __name__ == "__main__":
    main()
