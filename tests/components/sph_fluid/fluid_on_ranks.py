"""What test_sph_fluid_ranks.py runs on several ranks; rank 0 writes what came out."""

import re
import sys
from pathlib import Path

import numpy as np
from mpi4py import MPI

sys.path.append(str(Path(__file__).parent))

from fluid_params import fluid_params
from sampled_bodies import BOX, fill, mirrors

from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.component import Resources, outputs_of
from quintet.interfaces.errors import StepError

WORLD = MPI.COMM_WORLD
SPACING, SIZE = 0.05, np.full(3, 0.2)  # m
ORIGIN = (0.0, 0.0, 0.0)
TANK = (ORIGIN, (1.6, 0.4, 0.8))
DAM = (ORIGIN, (0.6, 0.4, 0.5))
GAUGES = {
    "gauges__pressure_gauges": [[0.3, 0.2, 0.0], [0.0, 0.2, 0.2]],
    "gauges__level_gauges": [[0.3, 0.2], [1.2, 0.2]],
    "gauges__front_gauge": "x",
    "gauges__motion_gauge": True,
}
PARAMS = {
    "dam": {
        "boundary__method": "dbc",
        "boundary__walls": TANK,
        "fluid": [DAM],
        "xsph": 0.3,
        "shepard_every": 7,
        **GAUGES,
    },
    "symmetric": {
        "boundary__method": "mdbc",
        "boundary__walls": TANK,
        "boundary__symmetry": ["y-"],
        "fluid": [DAM],
        "integration": "symplectic",
        "courant": 1.0,
        "acoustic_damper": 0.3,
        "negative_pressure": True,
        "density_diffusion": 0.1,
        "viscosity__kinematic": 1e-3,
        "viscosity__artificial": 0.0,
        **GAUGES,
    },
    "body": {
        "boundary__method": "mdbc",
        "boundary__walls": TANK,
        "boundary__lubrication_films": False,
        "fluid": [DAM, ((0.6, 0.0, 0.0), (1.6, 0.4, 0.15))],
        "integration": "symplectic",
        "courant": 1.0,
        "density_diffusion": 0.1,
        "viscosity__artificial": 0.05,
    },
    "single": {  # precision, with a plane of symmetry
        "precision": "float32",
        "boundary__method": "mdbc",
        "boundary__walls": TANK,
        "boundary__symmetry": ["y-"],
        "fluid": [DAM],
        "density_diffusion": 0.1,
        "shepard_every": 9,
        "viscosity__kinematic": 1e-3,
        **GAUGES,
    },
    "spilling": {  # over an edge, and out of the domain
        "boundary__method": "dbc",
        "boundary__walls": (ORIGIN, (0.5, 0.4, 0.4)),
        "boundary__open_faces": ["x+", "z+"],
        "initial": {"velocity": ["14.0", "0.0", "2.0"]},
        "fluid": [(ORIGIN, (0.5, 0.4, 0.4))],
        "sound_speed": 60.0,
    },
}


def make(name):
    params = fluid_params(spacing=SPACING, **({"sound_speed": 40.0} | PARAMS[name]))
    communicator = WORLD if WORLD.size > 1 else None
    threads = 2 if name == "dam" and WORLD.size > 1 else 1
    return SphFluid(params, Resources(threads, communicator=communicator))


class Body:
    """A box of samples that is pushed through the fluid."""

    def __init__(self, fluid):
        arm, normal, volume = fill(BOX, SIZE, SPACING, 0.5 * SPACING)
        self.arm, self.normal = arm, normal
        self.mirror = mirrors(BOX, SIZE, arm, normal)
        static = {"surface.normal": normal, "surface.volume": volume}
        fluid.bind(static | {"surface.body": np.zeros(len(arm))}, frozenset({"surface"}))
        self.time = 0.0

    def fields(self):
        t = self.time
        place = np.array([0.9 - 0.5 * t, 0.2, 0.3 + 0.05 * np.sin(9.0 * t)])
        velocity = np.array([-0.5, 0.0, 0.45 * np.cos(9.0 * t)])
        return {
            "surface.position": place + self.arm,
            "surface.velocity": np.tile(velocity, (len(self.arm), 1)),
            "surface.mirror": place + self.mirror,
        }


def go(fluid, body, steps):
    for _ in range(steps):
        if body is not None:
            fluid.take(body.fields())
        dt = fluid.stable_dt()
        fluid.step(dt)
        if body is not None:
            body.time += dt


def failure(fluid):
    """What a step says that no fluid bears, without the rank that it names, which is right."""
    text = "nothing"
    try:
        fluid.step(0.05)
    except StepError as error:
        text = str(error)
    text = WORLD.bcast(text)
    if WORLD.size > 1:
        words = re.search(r"particle (\d+)( \(rank (\d+) on \S+\))", text)
        owns = int(words[1]) in fluid.state.identity[: fluid.state.fluid]
        assert owns == (WORLD.rank == int(words[3])), text
        text = text.replace(words[2], "")
    return text


def results(fluid):
    totals = fluid.totals()
    numbers = [totals.mass, totals.kinetic, totals.potential, totals.internal]
    numbers += [*totals.momentum, *totals.angular_momentum]
    warned = np.array(sorted(fluid.warnings()), dtype=str)
    view = dict(fluid.view())
    ranks = view.pop("rank", np.zeros(0))
    assert len(ranks) == (len(view["points"]) if WORLD.size > 1 else 0) or WORLD.rank
    assert set(ranks) == set(range(WORLD.size)) or WORLD.size == 1
    seen = {f"view {name}": array for name, array in view.items()}
    return {**outputs_of(fluid), **seen, "totals": np.array(numbers), "warned": warned}


def run(name, steps, folder, earlier):
    """Go on from a state of as many ranks as `earlier` says, or from the start; write the end."""
    fluid = make(name)
    body = Body(fluid) if name == "body" else None
    if body is not None:
        fluid.prime(body.fields())
    if earlier:
        state = dict(np.load(f"{folder}/{name}-{earlier}-state.npz"))
        if body is not None:
            body.time = float(state.pop("time"))
        fluid.load(state)
    go(fluid, body, steps)
    state, reached = fluid.save(), results(fluid)
    reached["failure"] = np.array(failure(fluid))
    if WORLD.rank == 0:
        path = f"{folder}/{name}-{WORLD.size}"
        time = {} if body is None else {"time": np.array(body.time)}
        np.savez(f"{path}-state.npz", **state, **time)
        np.savez(f"{path}-{earlier}.npz" if earlier else f"{path}.npz", **reached, **state)


def main(folder, steps, earlier, names):
    for name in names.split(","):
        run(name, int(steps), folder, int(earlier))


if __name__ == "__main__":
    main(*sys.argv[1:])
