"""Program that test_sph_fluid_opencl_ranks.py runs: fluids of fluid_on_ranks.py on devices.

Each rank names a device, all of them the first.
"""

import fluid_on_ranks
from fluid_on_ranks import BODIES, PARAMS, SHARES
from solver_run import COMMUNICATOR, WORLD

from quintet.components.sph_fluid.opencl.device_fluid import DeviceFluid
from quintet.interfaces.component import Resources

PARAMS |= {
    "uneven": PARAMS["block"] | {"fluid": [((0.0, 0.0, 0.0), (0.57, 0.4, 0.37))]},
    "filmed": PARAMS["body"]
    | {"boundary__lubrication_films": "auto", "remove_inside_bodies": True},
    "reloaded": PARAMS["body"] | {"boundary__symmetry": ["y-"], "remove_inside_bodies": True},
}
BODIES |= {"filmed": (0.9, 0.2, 0.11), "reloaded": (0.9, 0.15, 0.1)}  # m
SHARES["reloaded"] = 0.8


class Run(fluid_on_ranks.Run):
    """A case of a fluid on devices; in some of them a box is pushed through it."""

    def make(self, params, threads):
        """Return the fluid of some parameters."""
        device = "opencl:" + ",".join("0" * WORLD.size)
        return DeviceFluid(params, Resources(1, communicator=COMMUNICATOR, device=device))

    def build(self):
        """Return the fluid; in one case it returns to its first state after some steps."""
        fluid = super().build()
        if self.name == "reloaded":
            first = fluid.save()
            for _ in range(2):
                fluid.take(self.inputs())
                fluid.step(fluid.stable_dt())
            fluid.load(first)
        return fluid

    def failure(self):
        """Message of a step that is too large, by the state that the host then has."""
        self.solver.state = self.solver.host.state
        return super().failure()
