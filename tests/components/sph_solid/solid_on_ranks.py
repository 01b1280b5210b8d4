"""Scenes that test_sph_solid_ranks.py runs on several ranks; rank 0 writes the results."""

import json
import os

import numpy as np
from pydantic import TypeAdapter
from solver_run import COMMUNICATOR, WORLD, SolverRun

from quintet.components.sph_solid.component import SphSolid
from quintet.components.sph_solid.params import SphSolidParams
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import StepError

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
    "lasting": {  # initial neighbours; the bodies touch and slide
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


class Run(SolverRun):
    """A solid; some particles are glued to a moving mesh, which releases some of them."""

    def build(self):
        params = TypeAdapter(SphSolidParams).validate_json(json.dumps(PARAMS[self.name]))
        solid = self.make(params)
        glue = {"glued", "glue_activity", "glued_load"} if solid.describe() else ()
        solid.bind({}, frozenset(glue))
        return solid

    def make(self, params):
        """Return the solid of some parameters."""
        return SphSolid(params, Resources(communicator=COMMUNICATOR))

    def inputs(self):
        number = np.arange(len(self.solver.state.active))
        if not len(number):
            return {}
        velocity = np.zeros((len(number), 3))
        velocity[:, 2] = -20.0 * np.sin(3e5 * self.time) * number / len(number)
        active = np.where(number < 5 * (self.steps // 30), 0.0, 1.0)
        return {"glued.velocity": velocity, "glue_activity.active": active}

    def failure(self, identity=700):
        """Error message for a particle with a velocity of NaN; it must name the particle's rank."""
        solid, text = self.solver, "nothing"
        rows = np.flatnonzero(solid.state.identity == identity)
        solid.state.velocity[rows] = np.nan
        try:
            solid.step(solid.stable_dt())
        except StepError as error:
            text = str(error)
        text, owner = WORLD.bcast(text), WORLD.allreduce(WORLD.rank if len(rows) else 0)
        if WORLD.size > 1:
            place = f" (rank {owner} on {os.uname().nodename})"
            assert f"particle {identity}{place} of body" in text, text
            text = text.replace(place, "")
        return text
