"""Program that test_lattice_opencl_ranks.py runs: lattices on devices, one for each rank.

Each rank names a device, all of them the first.
"""

from dataclasses import replace

import lattice_on_ranks
from one_at_a_time import one_at_a_time
from solver_run import COMMUNICATOR, WORLD

from quintet.components.particle_dynamics.component import ParticleLattice
from quintet.components.particle_dynamics.opencl.device_points import DevicePoints
from quintet.interfaces.component import Resources

DEVICES = "opencl:" + ",".join("0" * WORLD.size)
one_at_a_time(DevicePoints)


def state_elsewhere(params):
    """State of a lattice with other temperatures on the processor."""
    baths = tuple(replace(bath, temperature=2.0 * bath.temperature) for bath in params.baths)
    lattice = ParticleLattice(replace(params, baths=baths), Resources(1))
    for _ in range(20):
        lattice.step(lattice.stable_dt())
    return lattice.save()


class Run(lattice_on_ranks.Run):
    """A lattice without collisions on devices; one begins from a run on the processor."""

    def build(self):
        is_begun = self.name == "begun"
        params = lattice_on_ranks.params("heated" if is_begun else self.name)
        params = replace(params, collision_rate=0.0)
        lattice = ParticleLattice(params, Resources(1, communicator=COMMUNICATOR, device=DEVICES))
        if is_begun:
            lattice.begin_from(state_elsewhere(params))
        return lattice
