"""Program that test_dem_bodies_opencl_ranks.py runs: spheres on devices, one for each rank.

Each rank names a device, all of them the first.
"""

import dem_on_ranks
from dem_on_ranks import PLANES, heap
from solver_run import COMMUNICATOR, WORLD

from quintet.components.dem_bodies.component import DemBodies
from quintet.components.dem_bodies.params import DemBodiesParams
from quintet.interfaces.component import Resources
from quintet.interfaces.params import read


def restarted():
    """Spheres that begin from another run: the floor vanishes, less friction."""
    return heap(9, 9, 13, friction=0.1) | {"planes": [*PLANES[1:], {**PLANES[0], "until": 1e-3}]}


def crowd():
    """Spheres in more blocks of rows than ranks: borders are moved in steps of a block."""
    return heap(13, 13, 17) | {"contact_forces": True}


def few():
    """Spheres of which the first rank owns none."""
    return heap(3, 3, 3) | {"contact_forces": True}


class Run(dem_on_ranks.Run):
    """A scene on devices; one of them begins from a run on the processor."""

    scenes = dem_on_ranks.SCENES | {"crowd": crowd, "few": few, "begun": restarted}
    resources = Resources(
        1, communicator=COMMUNICATOR, device="opencl:" + ",".join("0" * WORLD.size)
    )

    def state_elsewhere(self):
        """State of the same spheres on the processor, with other friction and planes."""
        params, _ = read(DemBodiesParams, heap(9, 9, 13, friction=0.5), self.name)
        bodies = DemBodies(params)
        for _ in range(40):
            bodies.step(bodies.stable_dt())
        return bodies.save()
