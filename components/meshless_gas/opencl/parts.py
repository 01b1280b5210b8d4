"""Parts of the physics on a device that a scene may leave out: their hooks, in a step's order."""

import numpy as np

from quintet.components.meshless_gas.parts import Stage
from quintet.components.shared.opencl.arrays import DeviceArray
from quintet.interfaces.component import Array


class DevicePart:
    """Optional physics of a gas on a device; a hook that a part does not define does nothing."""

    def place(self, stage: int, dt: float) -> None:
        """Move nodes to their places at a stage of a step of dt [s]."""

    def flatten(self) -> None:
        """Set gradients to zero where the scheme is of first order."""

    def add_rates(self, dt: float, stage: Stage) -> None:
        """Add rates of density, momentum and energy in a stage of a step of dt [s]."""

    def finish_stage(self) -> None:
        """Bring the states of nodes that other ranks advanced."""

    def write_walls(self) -> None:
        """Write the states of wall nodes."""

    def sum_flows(self, moment: int) -> None:
        """Sum what enters through walls at the step's begin, 0, or after a stage, 1 to 3."""

    def flows(self) -> Array:
        """What enters through walls (4, 5) kg/s, N, W at these moments."""
        return np.zeros(5)

    def end(self, dt: float) -> None:
        """Move nodes to their places at the end of a step of dt [s]."""

    def shorten(self, first: np.int32, parts: DeviceArray) -> None:
        """Shorten the stable steps of nodes; `parts` has the least of groups from a place on."""
