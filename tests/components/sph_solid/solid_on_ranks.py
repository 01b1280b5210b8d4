"""What test_sph_solid_ranks.py runs on several ranks; rank 0 writes what came out."""

import json
import os
import sys

import numpy as np
from mpi4py import MPI
from pydantic import TypeAdapter

from quintet.components.sph_solid.component import SphSolid
from quintet.components.sph_solid.params import SphSolidParams
from quintet.interfaces.component import Resources, outputs_of
from quintet.interfaces.errors import StepError

WORLD = MPI.COMM_WORLD
ORIGIN = [0.0, 0.0, 0.0]
PLATE = {"lowest": ORIGIN, "highest": [0.08, 0.08, 0.02], "material": "steel"}
BALL = {
    "lowest": [0.02, 0.02, 0.02],
    "highest": [0.06, 0.06, 0.06],
    "velocity": [300.0, 100.0, -2000.0],
    "material": "aluminium",
}
RUBBER = {"density": 1000.0, "youngs_modulus": 1e7, "poissons_ratio": 0.4}
COMMON = {"spacing": 0.005, "total_lagrangian": False}
PARAMS = {
    "impact": {
        **COMMON,
        "bodies": [PLATE, BALL],
        "gauges": [[0.04, 0.04, 0.01], [0.04, 0.04, 0.04]],
        "levels": [{"body": 1, "place": [0.04, 0.04]}],
        "gravity": [0.0, 0.0, -9.81],
    },
    "quarter": {  # between two planes of symmetry
        **COMMON,
        "bodies": [PLATE, {**BALL, "lowest": [0.0, 0.0, 0.02], "velocity": [0.0, 0.0, -3000.0]}],
        "symmetry": [{"axis": "x"}, {"axis": "y"}],
        "kernel_correction": True,
    },
    "lasting": {  # neighbours of the start, of bodies that touch and slide
        "spacing": 0.005,
        "total_lagrangian": True,
        "bodies": [
            {**PLATE, "material": RUBBER},
            {**BALL, "material": RUBBER, "velocity": [12.0, 0.0, -8.0]},
        ],
        "symmetry": [{"axis": "y"}],
    },
    "glued": {
        **COMMON,
        "bodies": [PLATE, {**BALL, "velocity": [0.0, 0.0, -500.0]}],
        "glued": [{"lowest": ORIGIN, "highest": [0.02, 0.08, 0.02]}],
        "fixed": [{"lowest": [0.07, 0.0, 0.0], "highest": [0.08, 0.08, 0.02]}],
        "artificial_stress": 0.3,
    },
}


def make(name):
    params = TypeAdapter(SphSolidParams).validate_json(json.dumps(PARAMS[name]))
    return SphSolid(params, Resources(communicator=WORLD if WORLD.size > 1 else None))


def fields(solid):
    """Motion of the mesh that carries the glued particles, some of which it lets go."""
    state = solid.state
    if not len(state.active):
        return {}
    number = np.arange(len(state.active))
    velocity = np.zeros((len(number), 3))
    velocity[:, 2] = -20.0 * np.sin(3e5 * state.time) * number / len(number)
    active = np.where(number < 5 * (state.steps // 30), 0.0, 1.0)
    return {"glued.velocity": velocity, "glue_activity.active": active}


def go(solid, steps):
    for _ in range(steps):
        solid.take(fields(solid))
        solid.step(solid.stable_dt())


def results(solid):
    totals = solid.totals()
    numbers = [totals.mass, totals.kinetic, totals.potential, totals.internal]
    numbers += [*totals.momentum, *totals.angular_momentum]
    warned = np.array(sorted(solid.warnings()), dtype=str)
    view = dict(solid.view())
    ranks = view.pop("rank", np.zeros(0))
    assert len(ranks) == (len(view["points"]) if WORLD.size > 1 else 0) or WORLD.rank
    assert set(ranks) == set(range(WORLD.size)) or WORLD.size == 1
    seen = {f"view {name}": array for name, array in view.items()}
    return {**outputs_of(solid), **seen, "totals": np.array(numbers), "warned": warned}


def failure(solid, identity=700):
    """What a step says of a particle whose velocity is no number, and by which rank it is owned."""
    rows = np.flatnonzero(solid.state.identity == identity)
    solid.state.velocity[rows] = np.nan
    text = "nothing"
    try:
        solid.step(solid.stable_dt())
    except StepError as error:
        text = str(error)
    text, owner = WORLD.bcast(text), WORLD.allreduce(WORLD.rank if len(rows) else 0)
    if WORLD.size > 1:
        assert f"particle {identity} (rank {owner} on {os.uname().nodename}) of body" in text, text
        text = text.replace(f" (rank {owner} on {os.uname().nodename})", "")
    return text


def run(name, steps, folder, earlier):
    """Go on from a state of as many ranks as `earlier` says, or from the start; write the end."""
    solid = make(name)
    described = solid.describe()
    joined = frozenset({"glued", "glue_activity", "glued_load"} if described else ())
    solid.bind({}, joined)
    if earlier:
        solid.load(dict(np.load(f"{folder}/{name}-{earlier}-state.npz")))
    go(solid, steps)
    state, reached = solid.save(), results(solid)
    reached["failure"] = np.array(failure(solid))
    if WORLD.rank == 0:
        path = f"{folder}/{name}-{WORLD.size}"
        np.savez(f"{path}-state.npz", **state)
        reached |= {f"described {key}": array for key, array in described.items()}
        np.savez(f"{path}-{earlier}.npz" if earlier else f"{path}.npz", **reached, **state)


def main(folder, steps, earlier, names):
    for name in names.split(","):
        run(name, int(steps), folder, int(earlier))


if __name__ == "__main__":
    main(*sys.argv[1:])
