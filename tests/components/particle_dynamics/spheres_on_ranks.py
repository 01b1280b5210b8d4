"""What test_spheres_ranks.py runs on several ranks; rank 0 writes what came out."""

import json
import sys
from itertools import pairwise

import numpy as np
from mpi4py import MPI
from pydantic import TypeAdapter

from quintet.components.particle_dynamics.spheres.component import ParticleSpheres
from quintet.components.particle_dynamics.spheres.params import ParticleSpheresParams
from quintet.interfaces.component import Resources, outputs_of
from quintet.interfaces.errors import StepError

WORLD = MPI.COMM_WORLD
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
    "too long steps": {**crowd((3, 3, 2), 1.2), "restitution": 0.7},
    "row": {"spheres": [*reversed(ROW), STRIKER], "restitution": 0.99},
    "streams": {  # that are launched one after another and pass through each other
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


def make(name):
    params = TypeAdapter(ParticleSpheresParams).validate_json(json.dumps(PARAMS[name]))
    return ParticleSpheres(params, Resources(communicator=WORLD if WORLD.size > 1 else None))


def loads(spheres, step):
    """Forces, torques and heat that change from step to step."""
    number = np.arange(spheres.items())
    wave = np.sin(number[:, None] + 0.3 * step + np.arange(3))
    return {
        "load.force": 2e-2 * wave,
        "load.torque": 1e-5 * wave[:, ::-1],
        "heat.heat_flow": 5.0 * wave[:, 0],
    }


def go(spheres, first, steps):
    """Steps as they come, from the number of the first on; far too long ones of few spheres."""
    longest = 20.0 if spheres.items() == 18 else 1.0
    for step in range(first, first + steps):
        spheres.take(loads(spheres, step))
        spheres.step(longest * min(spheres.stable_dt(), 2e-3))


def results(spheres):
    """All that partners, files and pictures get, and what is said."""
    totals = spheres.totals()
    numbers = [totals.mass, totals.kinetic, totals.potential, totals.internal]
    numbers += [*totals.momentum, *totals.angular_momentum, spheres.stable_dt()]
    warned = np.array(sorted(spheres.warnings().values()), dtype=str)
    seen = {f"view {name}": array for name, array in spheres.view().items()}
    stated = {f"described {key}": array for key, array in spheres.describe().items()}
    everything = {**outputs_of(spheres), **seen, **stated}
    return everything | {"totals": np.array(numbers), "warned": warned}


def failure(spheres):
    """What a step says under a load that is not a number."""
    load = np.zeros((spheres.items(), 3))
    load[[3, 7]] = np.nan
    spheres.take({"load.force": load})
    try:
        spheres.step(1e-3)
    except StepError as error:
        return str(error)
    return "nothing"


def run(name, steps, folder, earlier, first):
    """Go on from a state of as many ranks as `earlier` says, or from the start; write the end."""
    spheres = make(name)
    if earlier:
        spheres.load(dict(np.load(f"{folder}/{name}-{earlier}-state.npz")))
    go(spheres, first, steps)
    state, reached = spheres.save(), results(spheres)
    reached["failure"] = np.array(failure(spheres))
    if WORLD.rank == 0:
        path = f"{folder}/{name}-{WORLD.size}"
        np.savez(f"{path}-state.npz", **state)
        np.savez(f"{path}-{earlier}.npz" if earlier else f"{path}.npz", **reached, **state)


def snapshots(name, steps, folder):
    """Write a state after each of some numbers of steps, rising."""
    spheres, reached = make(name), 0
    for step in steps:
        go(spheres, reached, step - reached)
        reached, state = step, spheres.save()
        if WORLD.rank == 0:
            np.savez(f"{folder}/{name}-{step}-of-{WORLD.size}.npz", **state)


def resume(name, windows, folder, ranks):
    """Go on with each snapshot but the last of some ranks to the next; compare with that."""
    for first, last in pairwise(windows):
        spheres = make(name)
        spheres.load(dict(np.load(f"{folder}/{name}-{first}-of-{ranks}.npz")))
        go(spheres, first, last - first)
        state = spheres.save()
        if WORLD.rank == 0:
            expected = np.load(f"{folder}/{name}-{last}-of-{ranks}.npz")
            assert set(expected.files) == set(state)
            wrong = [k for k in state if state[k].tobytes() != expected[k].tobytes()]
            assert not wrong, (name, first, last, wrong)


def main(folder, steps, earlier, names, first="0"):
    for name in names.split(","):
        if "," in steps:
            windows = [int(step) for step in steps.split(",")]
            if int(earlier):
                resume(name, windows, folder, int(earlier))
            else:
                snapshots(name, windows, folder)
        else:
            run(name, int(steps), folder, int(earlier), int(first))


if __name__ == "__main__":
    main(*sys.argv[1:])
