"""Scenes that test_dem_bodies_ranks.py runs on several ranks; rank 0 writes the results."""

import numpy as np
from dem_scenes import NOTHING, box, material, sphere
from solver_run import COMMUNICATOR, SolverRun

from quintet.components.dem_bodies.component import DemBodies
from quintet.components.dem_bodies.params import DemBodiesParams
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import StepError
from quintet.interfaces.params import read

DIAMETER = 0.02  # m
FRONT = {"front_gauge": "x"}
WALLS = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
PLANES = [{"point": NOTHING, "normal": normal, "material": "a"} for normal in WALLS]


def heap(nx, ny, nz, seed=1, **changes):
    """Spheres that nearly touch and fly about at random: they collide, mix and settle."""
    random = np.random.default_rng(seed)
    grid = np.stack(np.meshgrid(*map(np.arange, (nx, ny, nz)), indexing="ij"), -1).reshape(-1, 3)
    places = (grid + 0.55) * 1.08 * DIAMETER
    speeds = random.uniform(-0.6, 0.6, places.shape)
    radii = np.where(random.random(len(places)) < 0.3, 0.4 * DIAMETER, 0.5 * DIAMETER)
    bodies = [
        sphere(place, 2.0 * radius, velocity=speed)
        for place, speed, radius in zip(
            places.tolist(), speeds.tolist(), radii.tolist(), strict=True
        )
    ]
    table = {
        "bodies": bodies,
        "planes": PLANES,
        "materials": {"a": material(youngs_modulus=1e7, **changes)},
        "gravity": [-2.0, -2.0, -9.81],
        "impact_speed": 1.0,
    }
    return table


def heap_with_boxes():
    """Two boxes fall into the spheres: every rank computes their contacts."""
    table = heap(9, 9, 12)
    size = (0.05, 0.05, 0.05)
    table["bodies"].insert(5, box((0.06, 0.06, 0.31), size, velocity=[0.0, 0.0, -2.0]))
    table["bodies"].append(box((0.13, 0.13, 0.31), size, velocity=[0.3, 0.0, -2.0]))
    return table


def restarted_heap():
    """Spheres that begin from another run: the floor vanishes, a box is released, less friction."""
    table = heap(9, 9, 12, friction=0.1)
    table["planes"] = [*PLANES[1:], {**PLANES[0], "until": 1e-3}]
    locks = {"locked": ["x", "y", "z", "rotation_x", "rotation_y", "rotation_z"]}
    table["bodies"].append(box((0.1, 0.1, 0.31), (0.05, 0.05, 0.05), **locks, released_at=5e-4))
    return table


def state_elsewhere():
    """State of the same bodies on one rank, with another friction and other planes."""
    table = restarted_heap() | heap(9, 9, 12, friction=0.5) | {"bodies": restarted_heap()["bodies"]}
    params, _ = read(DemBodiesParams, table, "begun")
    bodies = DemBodies(params)
    for _ in range(40):
        bodies.step(bodies.stable_dt())
    return bodies.save()


SCENES = {
    "heap": lambda: heap(10, 10, 12),
    "rolling": lambda: heap(9, 9, 13, rolling_friction=0.1) | {"contact_forces": True, **FRONT},
    "boxes": lambda: heap_with_boxes() | FRONT,
    "begun": restarted_heap,
}


class Run(SolverRun):
    """A scene under a changing load; each rank receives the loads of all bodies."""

    scenes = SCENES
    resources = Resources(communicator=COMMUNICATOR)

    def build(self):
        params, _ = read(DemBodiesParams, self.scenes[self.name](), self.name)
        bodies = DemBodies(params, self.resources)
        bodies.bind({}, frozenset(port.name for port in bodies.takes + bodies.gives))
        if self.name == "begun":
            bodies.begin_from(self.state_elsewhere())
        return bodies

    def state_elsewhere(self):
        """State from which a scene begins."""
        return state_elsewhere()

    def inputs(self):
        number = np.arange(self.solver.items())
        force = np.zeros((len(number), 3))
        force[:, 0] = 1e-3 * np.sin(40.0 * self.time + number)
        return {"load.force": force, "load.torque": 1e-3 * force}

    def failure(self):
        force = np.zeros((self.solver.items(), 3))
        force[7, 0] = np.inf
        self.solver.take({"load.force": force})
        try:
            self.solver.step(1e-5)
        except StepError as error:
            return str(error)
        return "none"
