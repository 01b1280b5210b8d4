"""Cases of a gas that test_gas_ranks.py runs on several ranks; rank 0 writes the results."""

import json

from pydantic import TypeAdapter
from solver_run import COMMUNICATOR, WORLD, SolverRun

from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import StepError

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
    "bodies": {  # that move, cut holes and have friction
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
    "steady": {  # with local time steps, until it is steady
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
    "sphere": {  # with friction along a wall on which the gas slips, and a bow shock
        "axisymmetric": True,
        "gas": VISCOUS,
        "viscous": True,
        "initial": STREAM,
        "sphere": {"radius": 1.0, "points_around": 16, "layers": {"count": 16}},
        "boundaries": {
            "wall": {
                "kind": "isothermal",
                "temperature": 1.5,
                "accommodation": {"momentum": 0.9, "energy": 0.8},
            },
            "far": {"kind": "inflow", "state": STREAM},
            "exit": {"kind": "outflow"},
        },
        "steady": {"steps": 20},
        "probes": [[-1.2, 0.0, 0.1]],
    },
    "tube": {  # between walls that hold the gas, with probes
        "gas": VISCOUS,
        "viscous": True,
        "riemann": {
            "position": 0.5,
            "left": {"density": 1.0, "pressure": 1.0},
            "right": {"density": 0.125, "pressure": 0.1},
        },
        "box": {"lowest": [0.0] * 3, "highest": [1.0, 1.0, 0.3], "spacing": 0.025, "jitter": 0.2},
        "boundaries": {
            "x-": {"kind": "slip"},
            "x+": {"kind": "outflow", "pressure": 0.1},
            "z-": {"kind": "adiabatic"},
            "z+": {"kind": "isothermal", "temperature": 1.4},
        },
        "probes": [[0.3, 0.0, 0.1], [0.8, 0.0, 0.2]],
        "fronts": [{"begin": [0.9, 0.0, 0.1], "end": [0.3, 0.0, 0.2], "level": 0.2}],
    },
}


class Run(SolverRun):
    """A case of a gas."""

    def build(self):
        params = TypeAdapter(MeshlessGasParams).validate_json(json.dumps(PARAMS[self.name]))
        return MeshlessGas(params, Resources(communicator=COMMUNICATOR))

    def step_length(self):
        return min(self.solver.stable_dt(), 1.0)

    def failure(self):
        """The error, the same on all ranks, after steps so long that a state is invalid."""
        text = ""
        if self.name == "tube":
            try:
                for _ in range(60):
                    self.solver.step(8.0 * self.solver.stable_dt())
            except StepError as error:
                text = str(error)
            assert set(WORLD.allgather(text)) == {text}
        return text
