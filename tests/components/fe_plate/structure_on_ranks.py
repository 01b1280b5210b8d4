"""Cases of a structure that test_fe_plate_ranks.py runs on ranks; rank 0 writes the results."""

import json

import numpy as np
from pydantic import TypeAdapter
from solver_run import COMMUNICATOR, SolverRun

from quintet.components.fe_plate.component import FePlate
from quintet.components.fe_plate.params import FePlateParams
from quintet.interfaces.component import Resources

BLOCK = {
    "lowest": [0.0, 0.0, 0.0],
    "highest": [0.016, 0.012, 0.02],
    "elements": [8, 6, 10],
    "material": "steel",
    "velocity": [20.0, 0.0, -300.0],
}
GAUGES = {
    "node_gauges": [[0.0, 0.0, 0.02], [0.016, 0.012, 0.0]],
    "element_gauges": [[0.008, 0.006, 0.01], [0.0, 0.0, 0.0]],
    "part_gauge": True,
    "node_set_gauges": ["end"],
    "element_set_gauges": [{"lowest": [0.0, 0.0, 0.0], "highest": [0.016, 0.012, 0.01]}],
}
END = {"name": "end", "lowest": [0.0, 0.0, 0.02], "highest": [0.016, 0.012, 0.02]}
WALL = {"point": [0.0, 0.0, 0.0], "normal": [0.0, 0.1, 1.0]}
BRITTLE = {
    "density": 2700.0,
    "youngs_modulus": 7e10,
    "poissons_ratio": 0.3,
    "johnson_cook": {"a": 1e8, "b": 2e8, "n": 0.3, "c": 0.01},
    "failure_strain": 0.15,
}
PARAMS = {
    "struck": {  # two parts, one of them eroding, against a wall that leans
        "parts": [
            BLOCK,
            {**BLOCK, "lowest": [0.02, 0.0, 0.0], "highest": [0.036, 0.012, 0.02],
             "elements": [5, 4, 9], "material": BRITTLE},
        ],
        "rigid_walls": [WALL],
        "node_sets": [END],
        "gauges": GAUGES,
        "gravity": [0.0, 0.0, -9.81],
    },
    "pressed": {  # damped, under a pressure and a partner's forces
        "parts": [{**BLOCK, "velocity": [0.0, 0.0, 0.0]}],
        "fixed": [{"lowest": [0.0, 0.0, 0.0], "highest": [0.0, 0.012, 0.02]}],
        "pressures": [
            {"faces": {"lowest": [0.0, 0.0, 0.02], "highest": [0.016, 0.012, 0.02]},
             "pressure": 8e8},
        ],
        "mass_damping": 2e4,
        "coupled_faces": [{"lowest": [0.016, 0.0, 0.0], "highest": [0.016, 0.012, 0.02]}],
    },
    "tetrahedra": {  # eroding against a wall, under a pressure, seen by a partner
        "parts": [{**BLOCK, "elements": [4, 3, 5], "tetrahedra": True, "material": BRITTLE}],
        "rigid_walls": [WALL],
        "node_sets": [END],
        "gauges": GAUGES,
        "pressures": [
            {"faces": {"lowest": [0.0, 0.0, 0.02], "highest": [0.016, 0.012, 0.02]},
             "pressure": 2e8},
        ],
    },
    "bent": {  # eight points an element
        "parts": [{**BLOCK, "highest": [0.03, 0.012, 0.004], "elements": [15, 6, 2],
                   "velocity": [0.0, 0.0, 0.0]}],
        "integration": "full",
        "fixed": [{"lowest": [0.0, 0.0, 0.0], "highest": [0.0, 0.012, 0.004]}],
    },
    "glued": {  # glued particles add their mass to a face; some of it is released
        "parts": [{**BLOCK, "velocity": [0.0, 0.0, 0.0]}],
        "coupled_faces": [{"lowest": [0.0, 0.0, 0.02], "highest": [0.016, 0.012, 0.02]}],
        "gauges": {"part_gauge": True},
    },
    "plane": {
        "parts": [{**BLOCK, "highest": [0.016, 1.0, 0.02], "elements": [12, 1, 14]}],
        "dimensions": 2,
        "rigid_walls": [{**WALL, "normal": [0.0, 0.0, 1.0]}],
    },
}  # fmt: skip
FORCED = ("pressed", "bent", "glued")
TOUCHED = ("struck", "tetrahedra")  # a partner touches what erosion opens


class Run(SolverRun):
    """A case of a structure under forces on the nodes of its surface."""

    def build(self):
        params = TypeAdapter(FePlateParams).validate_json(json.dumps(PARAMS[self.name]))
        structure = FePlate(params, Resources(communicator=COMMUNICATOR))
        if self.name in TOUCHED:
            structure.sample({"contact_surface.inner": np.ones(1)})
        nodes, glued = len(structure.surface), self.name == "glued"
        static = {"node_load.added_mass": np.full(nodes, 1e-5)} if glued else {}
        structure.bind(static, frozenset({"node_load", *["node_glue"] * glued}))
        return structure

    def inputs(self):
        """Forces on the nodes of the surface, and of glued particles their mass too."""
        if self.name in TOUCHED:
            number = np.arange(self.solver.loaded.size)
            force = 5.0 * np.sin(np.add.outer(number, np.arange(3.0)) + 0.1 * self.steps)
            return {"contact_surface_load.force": force}
        if self.name not in FORCED:
            return {}
        number = np.arange(len(self.solver.surface))
        force = 50.0 * np.sin(np.add.outer(number, np.arange(3.0)) + 0.1 * self.steps)
        if self.name != "glued":
            return {"node_load.force": force}
        added = np.where(number < 5 * (self.steps // 20), 0.0, 1e-5)
        return {"node_load.force": 20.0 * force, "node_mass.added": added}
