"""Program that test_sph_solid_opencl_ranks.py runs: solids of solid_on_ranks.py on devices.

Each rank names a device, all of them the first.
"""

import solid_on_ranks
from solver_run import COMMUNICATOR, WORLD

from quintet.components.sph_solid.opencl.device_solid import DeviceSolid
from quintet.interfaces.component import Resources


class Run(solid_on_ranks.Run):
    """A case of a solid on devices."""

    def make(self, params):
        """Return the solid of some parameters."""
        device = "opencl:" + ",".join("0" * WORLD.size)
        return DeviceSolid(params, Resources(1, communicator=COMMUNICATOR, device=device))

    def inputs(self):
        """Inputs of the solid on the host of a device."""
        device, self.solver = self.solver, self.solver.host
        fields = super().inputs()
        self.solver = device
        return fields

    def failure(self):
        """Nothing: a state cannot be changed from outside of a device."""
        return ""
