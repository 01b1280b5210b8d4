"""What test_gas_ranks.py runs on several ranks; rank 0 writes what came out."""

import json
import sys

import numpy as np
from mpi4py import MPI
from pydantic import TypeAdapter

from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.component import Resources, outputs_of

WORLD = MPI.COMM_WORLD
AIR = {"gamma": 1.4, "gas_constant": 1.0 / 1.4}
STREAM = {"density": 1.0, "pressure": 1.0 / 1.4, "velocity": [3.0, 0.0, 0.0]}
VISCOUS = {**AIR, "viscosity": 0.01, "reference_temperature": 1.0, "sutherland": 1.104}
OPEN = {"x-": {"kind": "inflow", "state": STREAM}, "x+": {"kind": "outflow"}}
OPEN |= {"z-": {"kind": "outflow"}, "z+": {"kind": "outflow"}}
BODIES = [
    {
        "centre": [0.0, 0.0, 0.0],
        "radius": 0.5,
        "points_around": 40,
        "thickness": 0.25,
        "spacing": 0.08,
        "first_spacing": 0.03,
        "growth": 1.2,
        "temperature": 2.0,
    },
    {
        "centre": [-1.1, 0.0, 0.2],
        "velocity": [0.5, 0.0, 0.1],
        "radius": 0.15,
        "points_around": 24,
        "thickness": 0.12,
        "spacing": 0.05,
        "first_spacing": 0.02,
        "growth": 1.2,
        "temperature": 2.0,
    },
]
PARAMS = {
    "bodies": {  # that move, cut holes and rub
        "gas": VISCOUS,
        "viscous": True,
        "initial": STREAM,
        "box": {"lowest": [-2.0, 0.0, -1.5], "highest": [1.5, 1.0, 1.5], "spacing": 0.1},
        "boundaries": OPEN,
        "moving": {"bodies": BODIES},
        "limiter": "van_albada",
    },
    "vortex": {  # in a periodic box in space
        "dimensions": 3,
        "gas": {"gas_constant": 1.0},
        "initial": {"density": 1.0, "velocity": [1.0, 0.0, 1.0], "pressure": 1.0},
        "vortex": {"centre": [5.0, 0.0, 5.0], "strength": 5.0},
        "box": {"lowest": [0.0] * 3, "highest": [10.0] * 3, "spacing": 0.8, "jitter": 0.3},
        "neighbours": 14,
    },
    "steady": {  # in steps of each node's own, to rest
        "gas": AIR,
        "initial": STREAM,
        "box": {"lowest": [0.0, 0.0, 0.0], "highest": [1.0, 1.0, 1.0], "spacing": 0.05},
        "boundaries": OPEN | {"z-": {"kind": "symmetry"}},
        "zones": [
            {
                "lowest": [0.3, 0.0, 0.0],
                "highest": [0.6, 1.0, 0.4],
                "state": {"density": 2.0, "pressure": 1.0, "velocity": [3.0, 0.0, 0.0]},
            }
        ],
        "local_steps": True,
        "steady": {},
    },
}


def make(name):
    params = TypeAdapter(MeshlessGasParams).validate_json(json.dumps(PARAMS[name]))
    return MeshlessGas(params, Resources(communicator=WORLD if WORLD.size > 1 else None))


def go(gas, steps):
    for _ in range(steps):
        gas.step(min(gas.stable_dt(), 1.0))


def results(gas):
    totals = gas.totals()
    numbers = [totals.mass, totals.kinetic, totals.internal, totals.work]
    numbers += [*totals.momentum, *totals.angular_momentum]
    warned = np.array(sorted(gas.warnings() | gas.final_warnings()), dtype=str)
    seen = {f"view {name}": array for name, array in gas.view().items()}
    return {**outputs_of(gas), **seen, "totals": np.array(numbers), "warned": warned}


def run(name, steps, folder, earlier):
    """Go on from a state of as many ranks as `earlier` says, or from the start; write the end."""
    gas = make(name)
    if earlier:
        gas.load(dict(np.load(f"{folder}/{name}-{earlier}-state.npz")))
    go(gas, steps)
    state, reached = gas.save(), results(gas)
    if WORLD.rank == 0:
        path = f"{folder}/{name}-{WORLD.size}"
        np.savez(f"{path}-state.npz", **state)
        np.savez(f"{path}-{earlier}.npz" if earlier else f"{path}.npz", **reached, **state)


def main(folder, steps, earlier, names):
    for name in names.split(","):
        run(name, int(steps), folder, int(earlier))


if __name__ == "__main__":
    main(*sys.argv[1:])
