"""One ring of finite elements bounces off a rigid wall: what each of two rings does.

Two equal rings that meet head-on are each other's image, so that each moves as one that strikes a
rigid wall without friction. Run as a program, ``python -m quintet.scenarios.rubber_rings.elements
LAYERS ...``, it makes a mesh of so many elements across the ring, runs it with `fe_plate`, and
prints the speed of rebound over that before, and how high the ring reaches.
"""

import math
import sys
import tempfile
from pathlib import Path

import meshio
import numpy as np

from quintet.coupler.report.run import Run
from quintet.coupler.run.run_scene import run_scene
from quintet.coupler.scene.read import load

INNER, OUTER, MIDDLE = 0.03, 0.04, 0.041  # m
SPEED = 50.268  # m/s
SCENE = """
name = "ring_of_elements"
title = "A ring of finite elements strikes a rigid wall"
end = 1.8e-3
window = 1e-5

[components.ring]
kind = "fe_plate"
viscosity_linear = 0.0
viscosity_quadratic = 0.0
fixed = [{ lowest = [-1.0, -1.0, -1.0], highest = [1.0, 1.0, 1.0], directions = ["y"] }]
rigid_walls = [{ point = [0.0, 0.0, 0.0], normal = [1.0, 0.0, 0.0] }]

[[components.ring.parts]]
shape = "mesh"
file = "ring.vtk"
velocity = [-50.268, 0.0, 0.0]
material = { density = 1010.0, youngs_modulus = 4.5083e8, poissons_ratio = 0.39752 }

[output]
fields = ["ring.part_gauge.velocity", "ring.node_gauge.position"]

[components.ring.gauges]
node_gauges = [[0.041, 0.0, 0.04]]
part_gauge = true
"""


def write_mesh(path: Path, layers: int) -> None:
    """Write a ring of 8-node solids, one of them deep: so many across, as long as wide."""
    width = (OUTER - INNER) / layers
    around = 4 * round(0.5 * math.pi * 0.5 * (INNER + OUTER) / width)
    radius, angle = np.linspace(INNER, OUTER, layers + 1), np.arange(around) * math.tau / around
    y, a, r = np.meshgrid([0.0, width], angle, radius, indexing="ij")
    points = np.stack([MIDDLE + r * np.cos(a), y, r * np.sin(a)], axis=-1).reshape(-1, 3)
    number = np.arange(len(points)).reshape(2, around, layers + 1)
    turned = np.roll(number, -1, axis=1)
    corners = [
        number[0, :, :-1], turned[0, :, :-1], turned[0, :, 1:], number[0, :, 1:],
        number[1, :, :-1], turned[1, :, :-1], turned[1, :, 1:], number[1, :, 1:],
    ]  # fmt: skip
    cells = np.stack([corner.ravel() for corner in corners], axis=1)
    a, b, c, d = (points[cells[0, k]] for k in (0, 1, 3, 4))
    if np.dot(np.cross(b - a, c - a), d - a) < 0.0:
        cells = cells[:, [4, 5, 6, 7, 0, 1, 2, 3]]
    meshio.Mesh(points, [("hexahedron", cells)]).write(path)


def rebound(layers: int) -> tuple[float, float]:
    """Speed after over speed before, and greatest height [m], of a ring of elements."""
    with tempfile.TemporaryDirectory() as folder:
        write_mesh(Path(folder) / "ring.vtk", layers)
        (Path(folder) / "scene.toml").write_text(SCENE)
        place, _ = run_scene(load(str(Path(folder) / "scene.toml")), Path(folder) / "run")
        run = Run(place)
        speed = run.fields["ring.part_gauge.velocity"].values[-1, 0, 0] / SPEED
        return float(speed), float(run.fields["ring.node_gauge.position"].values[:, 0, 2].max())


if __name__ == "__main__":
    for count in map(int, sys.argv[1:] or ["10", "20"]):
        speed, top = rebound(count)
        print(f"{count} elements across: rebound {speed:.4f}, top {1e3 * top:.2f} mm")
