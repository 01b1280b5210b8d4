"""Program that test_lattice_opencl_ranks.py runs: lattices on devices, one for each rank.

Each rank names a device, all of them the first.
"""

from dataclasses import replace

import lattice_on_ranks
from solver_run import COMMUNICATOR, WORLD

from quintet.components.particle_dynamics.component import ParticleLattice
from quintet.interfaces.component import Resources

DEVICES = "opencl:" + ",".join("0" * WORLD.size)


class Run(lattice_on_ranks.Run):
    """A lattice without collisions on devices."""

    def build(self):
        params = replace(lattice_on_ranks.params(self.name), collision_rate=0.0)
        return ParticleLattice(params, Resources(1, communicator=COMMUNICATOR, device=DEVICES))
