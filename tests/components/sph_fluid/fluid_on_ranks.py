"""Program that test_sph_fluid_ranks.py runs on several ranks; rank 0 writes the results."""

import re
import tempfile
from pathlib import Path

import numpy as np
from fluid_params import fluid_params
from sampled_bodies import BOX, fill, mirrors
from solver_run import COMMUNICATOR, WORLD, SolverRun

from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import StepError

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
BLOCK = Path(tempfile.mkdtemp()) / "block.npy"  # of voxels, in the way of the water
np.save(BLOCK, np.ones((2, 1, 2)))
ABSORBED = {
    "paddle": "piston",
    "depth": 0.4,
    "height": 0.2,
    "period": 1.5,
    "ramp": 0.05,
    "absorption": True,
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
    "rolling": {  # tank, in one pass over pairs
        "boundary__method": "dbc",
        "boundary__walls": TANK,
        "boundary__motion": {"period": 0.5, "angle_amplitude": 0.3, "axis": [0.1, 1.0, 0.0]},
        "fluid": [DAM],
        **GAUGES,
    },
    "swaying": {  # tank, in two passes, along a plane of symmetry
        "boundary__method": "mdbc",
        "boundary__walls": TANK,
        "boundary__symmetry": ["y-"],
        "boundary__motion": {
            "times": [0.0, 0.1, 1.0],
            "displacement": [[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.0, 0.0]],
        },
        "fluid": [DAM],
        "integration": "symplectic",
        "courant": 1.0,
        "density_diffusion": 0.1,
        **GAUGES,
    },
    "pushed": {  # by a block that moves, before a zone that damps
        "boundary__method": "mdbc",
        "boundary__walls": ((-0.2, 0.0, 0.0), (1.6, 0.4, 0.8)),
        "boundary__obstacles": [((-0.15, 0.0, 0.0), (0.0, 0.4, 0.8))],
        "boundary__pistons": [
            {"part": "obstacles.0", "motion": {"period": 0.2, "amplitude": [0.1, 0.0, 0.0]}}
        ],
        "boundary__damping": [
            {"lowest": [0.2, 0.0, 0.0], "highest": [1.6, 0.4, 0.8], "towards": "x+", "rate": 5.0}
        ],
        "fluid": [DAM],
        "density_diffusion": 0.1,
        **GAUGES,
    },
    "absorbing": {  # waves that come back to a paddle
        "boundary__method": "mdbc",
        "boundary__walls": ((-0.4, 0.0, 0.0), (1.6, 1.0, 0.8)),
        "boundary__obstacles": [((-0.2, 0.0, 0.0), (0.0, 1.0, 0.8))],
        "boundary__pistons": [{"part": "obstacles.0", "waves": ABSORBED}],
        "initial": {"velocity": ["0.6", "0.0", "0.0"]},
        "fluid": [(ORIGIN, (1.6, 1.0, 0.4))],
        "dimensions": 2,
        **GAUGES,
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
    "block": {  # from a file
        "boundary__method": "mdbc",
        "boundary__walls": TANK,
        "boundary__meshes": [{"file": str(BLOCK), "scale": 0.2, "origin": [0.8, 0.1, 0.0]}],
        "fluid": [DAM],
        "density_diffusion": 0.1,
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
BODIES = {"body": (0.9, 0.2, 0.3)}  # m, where the box begins
SHARES: dict[str, float] = {}  # volume of the box's samples over that of its particles, if not 1


class Run(SolverRun):
    """A case of a fluid; in one of them a box of samples is pushed through it."""

    def make(self, params, threads):
        """Return the fluid of some parameters."""
        return SphFluid(params, Resources(threads, communicator=COMMUNICATOR))

    def build(self):
        params = fluid_params(spacing=SPACING, **({"sound_speed": 40.0} | PARAMS[self.name]))
        threads = 2 if self.name == "dam" and WORLD.size > 1 else 1
        fluid = self.make(params, threads)
        if self.name in ("pushed", "absorbing"):
            fluid.bind({}, frozenset())
        if self.name in BODIES:
            self.arm, normal, volume = fill(BOX, SIZE, SPACING, 0.5 * SPACING)
            self.mirror = mirrors(BOX, SIZE, self.arm, normal)
            volume = SHARES.get(self.name, 1.0) * volume
            static = {"surface.normal": normal, "surface.volume": volume}
            static["surface.body"] = np.zeros(len(normal))
            fluid.bind(static, frozenset({"surface"}))
            fluid.prime(self.inputs())
        return fluid

    def inputs(self):
        if self.name not in BODIES:
            return {}
        t = self.time
        x, y, z = BODIES[self.name]
        place = np.array([x - 0.5 * t, y, z + 0.05 * np.sin(9.0 * t)])
        velocity = np.array([-0.5, 0.0, 0.45 * np.cos(9.0 * t)])
        return {
            "surface.position": place + self.arm,
            "surface.velocity": np.tile(velocity, (len(self.arm), 1)),
            "surface.mirror": place + self.mirror,
        }

    def failure(self):
        """Message of a step that is too large; its rank is checked and left out."""
        text = "nothing"
        try:
            self.solver.step(0.05)
        except StepError as error:
            text = str(error)
        text = WORLD.bcast(text)
        if WORLD.size > 1:
            match = re.search(r"particle (\d+)( \(rank (\d+) on \S+\))", text)
            state = self.solver.state
            owns = int(match[1]) in state.identity[: state.fluid]
            assert owns == (WORLD.rank == int(match[3])), text
            text = text.replace(match[2], "")
        return text
