"""Scenes that test_spheres_ranks.py runs on several ranks; rank 0 writes the results."""

import json

import numpy as np
from pydantic import TypeAdapter
from solver_run import COMMUNICATOR, SolverRun

from quintet.components.particle_dynamics.spheres.component import ParticleSpheres
from quintet.components.particle_dynamics.spheres.params import ParticleSpheresParams
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import StepError

LONG = "too long steps"  # a case
R = 0.01  # m
RANDOM = np.random.default_rng(5)


def crowd(count, spacing):
    """Spheres at random velocities on a lattice, `spacing` diameters apart, in a box of walls."""
    sides = 2.0 * R * spacing * np.array(count)
    places = np.stack(np.meshgrid(*map(np.arange, count)), -1).reshape(-1, 3)
    spheres = [
        {
            "centre": (2.0 * R * spacing * (place + 0.5)).tolist(),
            "velocity": RANDOM.normal(size=3).tolist(),
            "angular_velocity": RANDOM.normal(size=3).tolist(),
            "radius": float(R * RANDOM.uniform(0.8, 1.0)),
            "density": float(RANDOM.uniform(500.0, 2000.0)),
        }
        for place in RANDOM.permutation(places)
    ]
    walls = []
    for axis in range(3):
        walls.append({"normal": np.eye(3)[axis].tolist()})
        walls.append({"normal": (-np.eye(3)[axis]).tolist(), "offset": -float(sides[axis])})
    return {"spheres": spheres, "walls": walls}


ROW = [{"centre": [2.0 * R * k, 0.0, 0.0], "radius": R, "density": 1e3} for k in range(1, 40)]
STRIKER = {"centre": [-0.03, 0.002, 0.001], "radius": R, "density": 1e3, "velocity": [3.0, 0, 0]}
STREAM = {"radius": R, "density": 1e3, "launch": 1e-3}
STREAM["copies"] = {"number": [4, 5, 5], "spacing": [0.06, 0.06, 0.06], "interval": 1e-5}
PARAMS = {
    "gas": {**crowd((6, 5, 4), 1.2), "restitution": 0.9},
    "pile": {**crowd((4, 4, 4), 1.05), "restitution": 0.5, "gravity": [0.0, 0.0, -9.81]},
    LONG: {**crowd((3, 3, 2), 1.2), "restitution": 0.7},
    "row": {"spheres": [*reversed(ROW), STRIKER], "restitution": 0.99},
    "streams": {  # two streams of spheres launched in turn; they pass through each other
        "spheres": [
            {**STREAM, "centre": [0.0, 0.0, 0.0], "velocity": [2.0, 0.05, 0.0]},
            {**STREAM, "centre": [0.205, 0.013, 0.011], "velocity": [-2.0, 0.0, 0.05]},
        ],
        "restitution": 0.8,
    },
    "tethered": {
        "spheres": [
            {"centre": [0.03 * k, 0, 0], "radius": R, "density": 1e3, "tether": 5.0 * (k % 3)}
            for k in range(12)
        ],
        "integrator": "yoshida",
    },
    "parcels": {
        "spheres": [{**STREAM, "centre": [0.0] * 3, "parcel": 7.0, "velocity": [1.0, 0.0, -1.0]}],
        "walls": [{"normal": [0.0, 0.0, 1.0], "offset": -0.02}],
        "collisions": False,
        "longest_step": 1e-3,
    },
}


class Run(SolverRun):
    """Spheres under forces, torques and heat that change in every step."""

    def build(self):
        params = TypeAdapter(ParticleSpheresParams).validate_json(json.dumps(PARAMS[self.name]))
        return ParticleSpheres(params, Resources(communicator=COMMUNICATOR))

    def inputs(self):
        number = np.arange(self.solver.items())
        wave = np.sin(number[:, None] + 0.3 * self.steps + np.arange(3))
        return {
            "load.force": 2e-2 * wave,
            "load.torque": 1e-5 * wave[:, ::-1],
            "heat.heat_flow": 5.0 * wave[:, 0],
        }

    def step_length(self):
        """The stable step; far too long in one case."""
        return (20.0 if self.name == LONG else 1.0) * min(self.solver.stable_dt(), 2e-3)

    def failure(self):
        """Error message of a step under a load of NaN."""
        load = np.zeros((self.solver.items(), 3))
        load[[3, 7]] = np.nan
        self.solver.take({"load.force": load})
        try:
            self.solver.step(1e-3)
        except StepError as error:
            return str(error)
        return "nothing"
