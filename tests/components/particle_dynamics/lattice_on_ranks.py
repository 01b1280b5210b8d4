"""Scenes that test_lattice_ranks.py runs on several ranks; rank 0 writes the results."""

import numpy as np
from solver_run import WORLD, SolverRun

from quintet.components.particle_dynamics.component import ParticleLattice
from quintet.components.particle_dynamics.params import (
    Averages,
    Bath,
    Damping,
    Drive,
    Lattice,
    ParticleLatticeParams,
    SevenRootForce,
)
from quintet.interfaces.component import Resources

A, MASS, TOP = 0.01, 1e-3, 50.0  # m, kg, Hz
UNIT = MASS * (A * 2.0 * np.pi * TOP) ** 2  # J


def bath(x, **keys):
    box = {"lowest": (x * A, 0.0, 0.0), "highest": (x * A, 1.0, 1.0)}
    return Bath(**box, rate=100.0, tether=1.0, **keys)


def params(name):
    keys = {"averages": Averages(begin=0.002, block=0.004)}
    force = {"seven_roots": SevenRootForce(top_frequency=TOP)}
    if name == "driven":
        lattice = Lattice(cells=(9, 3, 3), spacing=A, mass=MASS, temperature=1e-5 * UNIT)
        keys |= {
            "frozen": ((0.09, 0.0, 0.0), (0.09, 0.0, 0.01)),
            "drive": Drive(point=(0.04, 0.03, 0.03), partner="+x", frequency=40.0, amplitude=4e-4),
            "damping": Damping(coefficient=0.3 * MASS),
        }
    elif name == "heated":
        lattice = Lattice(cells=(9, 3, 3), spacing=A, mass=MASS, temperature=1e-4 * UNIT)
        keys |= {
            "baths": (
                bath(0, temperature=1e-4 * UNIT, coupled=True),
                bath(9, temperature=2e-4 * UNIT),
            ),
            "collision_rate": 100.0,
        }
    elif name == "periodic":
        keys |= {"integrator": "yoshida"}
        lattice = Lattice(
            cells=(7, 6, 8), spacing=A, mass=MASS, temperature=3e-4 * UNIT, periodic=("x", "z")
        )
    else:  # breaks up
        keys |= {"if_point_lost": "report", "courant": 0.01}
        keys |= {"baths": (bath(2, temperature=1e-3 * UNIT),)}
        lattice = Lattice(cells=(5, 4, 4), spacing=A, mass=MASS, temperature=0.02 * UNIT)
    return ParticleLatticeParams(lattice=lattice, boltzmann=1.0, **force, **keys)


class Run(SolverRun):
    """A lattice with a wall whose temperature changes in every step."""

    def build(self):
        return ParticleLattice(params(self.name), Resources(communicator=WORLD))

    def inputs(self):
        temperatures = np.full(len(self.solver.wall.rows), (1.0 + self.steps % 3) * 1e-4 * UNIT)
        return {"wall_temperature.temperature": temperatures}

    def results(self):
        """Results of the base class; they must be the same after a saved state is restored."""
        saved, results = self.save(), super().results()
        self.advance(3)
        self.load(saved)
        repeated = super().results()
        if WORLD.rank == 0:
            assert all(repeated[key].tobytes() == value.tobytes() for key, value in results.items())
        return results
