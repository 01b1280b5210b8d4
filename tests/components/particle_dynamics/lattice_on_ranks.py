"""What test_lattice_ranks.py runs on several ranks; rank 0 writes what came out."""

import sys

import numpy as np
from mpi4py import MPI

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
from quintet.interfaces.component import Resources, outputs_of

WORLD = MPI.COMM_WORLD
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


def make(name):
    return ParticleLattice(params(name), Resources(communicator=WORLD))


def go(lattice, steps):
    for k in range(steps):
        warm = np.full(len(lattice.wall.rows), (1.0 + k % 3) * 1e-4 * UNIT)
        lattice.take({"wall_temperature.temperature": warm})
        lattice.step(lattice.stable_dt())


def results(lattice):
    totals = lattice.totals()
    numbers = [totals.mass, totals.kinetic, totals.internal, totals.work, *totals.momentum]
    warned = np.array(sorted(lattice.warnings()), dtype=str)
    return {**outputs_of(lattice), "totals": np.array(numbers), "warned": warned}


def run(name, steps, folder, earlier):
    """Go on from a state of as many ranks as `earlier` says, or from the start; write the end."""
    lattice = make(name)
    if earlier:
        lattice.load(dict(np.load(f"{folder}/{name}-{earlier}-state.npz")))
    go(lattice, steps)
    state, reached = lattice.save(), results(lattice)
    # What was saved on each rank brings it back.
    go(lattice, 3)
    lattice.load(state)
    again = results(lattice)
    if WORLD.rank == 0:
        assert all(again[key].tobytes() == value.tobytes() for key, value in reached.items())
        path = f"{folder}/{name}-{WORLD.size}"
        np.savez(f"{path}-state.npz", **state)
        np.savez(f"{path}-{earlier}.npz" if earlier else f"{path}.npz", **reached, **state)


def main(folder, steps, earlier, names):
    for name in names.split(","):
        run(name, int(steps), folder, int(earlier))


if __name__ == "__main__":
    main(*sys.argv[1:])
