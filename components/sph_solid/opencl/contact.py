"""Particles of one rank that may touch each other on a device."""

from typing import NamedTuple

from quintet.components.shared.opencl.arrays import DeviceArray
from quintet.components.sph_solid.state import Array


class Moving(NamedTuple):
    """Rows of particles as they are in a step."""

    place: DeviceArray  # (all, 4)
    motion: DeviceArray  # (all, 4)
    stress: DeviceArray  # (all, 12), nominal


class Particles(NamedTuple):
    """What may touch from now on."""

    low: Array  # (3,) m, corners of the box around it
    high: Array
    start: DeviceArray  # (all, 4) rows of places at the start
    order: DeviceArray | None  # (all,) numbers in the order of one rank; None: the rows are


class OwnParticles:
    """All particles of a solid on one rank."""

    others = 0  # rows behind those of this rank

    def find(self, rows: Moving, count: int, particles: Particles, reach: float) -> Particles:
        """Return the `count` particles."""
        return particles

    def extend(self, rows: Moving, count: int) -> Moving:
        """Return the rows."""
        return rows
