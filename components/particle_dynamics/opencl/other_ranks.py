"""What a device needs of other ranks: copies of their points, and the greatest of numbers."""

from collections.abc import Sequence
from typing import Any, Protocol

from quintet.components.particle_dynamics.opencl.device_points import DevicePoints


class OtherRanks(Protocol):
    """Exchange of a rank's points on a device with other ranks."""

    source: str  # kernels that it needs
    are_there: bool  # then there are copies among the points, and new lists come with new rows

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


class NoOtherRanks:
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
