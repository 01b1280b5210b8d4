"""Copies of other ranks' points on a device, and what all ranks must agree on."""

from collections.abc import Sequence
from typing import Any, Protocol

from quintet.components.particle_dynamics.opencl.device_points import DevicePoints


class Copies(Protocol):
    """Copies among the points of a rank."""

    source: str  # kernels that they need
    are_there: bool  # whether there may be any; then new lists come with new rows

    def connect(self, queue: Any, kernels: Any) -> None:
        """Take a queue, and kernels built from a text that has `source`."""

    def release(self) -> None:
        """Forget rows, so that their memory can be freed."""

    def follow(self, points: DevicePoints) -> None:
        """Follow new rows."""

    def exchange(self) -> None:
        """Bring places, and velocities that damping takes, up to date."""

    def greatest(self, *numbers: float) -> Sequence[float]:
        """Greatest of all ranks of each number."""


class NoCopies:
    """No copies: one rank."""

    source, are_there = "", False

    def connect(self, queue: Any, kernels: Any) -> None:
        """Nothing to do."""

    def release(self) -> None:
        """Nothing to do."""

    def follow(self, points: DevicePoints) -> None:
        """Nothing to do."""

    def exchange(self) -> None:
        """Nothing to do."""

    def greatest(self, *numbers: float) -> Sequence[float]:
        """Return the numbers."""
        return numbers
