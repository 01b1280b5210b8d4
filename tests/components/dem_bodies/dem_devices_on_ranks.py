"""Program that test_dem_bodies_opencl_ranks.py runs: spheres on devices, one for each rank.

Each rank names a device, all of them the first.
"""

import dem_on_ranks
from dem_on_ranks import PLANES, heap
from one_at_a_time import one_at_a_time
from solver_run import COMMUNICATOR, WORLD

from quintet.components.dem_bodies.component import DemBodies
from quintet.components.dem_bodies.opencl.device_rows import DeviceRows
from quintet.components.dem_bodies.params import DemBodiesParams
from quintet.components.dem_bodies.state import BLOCK
from quintet.interfaces.component import Resources
from quintet.interfaces.params import read

one_at_a_time(DeviceRows)


def restarted():
    """Spheres that begin from another run: the floor vanishes, less friction."""
    return heap(9, 9, 13, friction=0.1) | {"planes": [*PLANES[1:], {**PLANES[0], "until": 1e-3}]}


def crowd():
    """Spheres in more blocks of rows than ranks: borders are moved in steps of a block."""
    return heap(13, 13, 17) | {"contact_forces": True}


def few():
    """Spheres of which the first rank owns none."""
    return heap(3, 3, 3) | {"contact_forces": True}


def one_block():
    """Spheres that fill one block of rows: the last of two ranks owns the ground alone."""
    return heap(8, 8, BLOCK // 64) | {"contact_forces": True}


class Run(dem_on_ranks.Run):
    """A scene on devices; one of them begins from a run on the processor."""

    scenes = dem_on_ranks.SCENES | {
        "crowd": crowd, "few": few, "one block": one_block, "begun": restarted,
    }  # fmt: skip
    resources = Resources(
        1, communicator=COMMUNICATOR, device="opencl:" + ",".join("0" * WORLD.size)
    )

    def load(self, saved):
        """Go on from a saved state; on several devices by way of the processor."""
        if WORLD.size > 1 and self.name == "heap":
            params, _ = read(DemBodiesParams, self.scenes[self.name](), self.name)
            bodies = DemBodies(params)
            bodies.load({name.removeprefix("state "): saved[name] for name in saved})
            saved = saved | {f"state {name}": array for name, array in bodies.save().items()}
        super().load(saved)

    def state_elsewhere(self):
        """State of the same spheres on the processor, with other friction and planes."""
        params, _ = read(DemBodiesParams, heap(9, 9, 13, friction=0.5), self.name)
        bodies = DemBodies(params)
        for _ in range(40):
            bodies.step(bodies.stable_dt())
        return bodies.save()
