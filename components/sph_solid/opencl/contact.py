"""Particles of one rank that may touch each other on a device."""

from typing import NamedTuple

from quintet.components.shared.opencl.arrays import DeviceArray
from quintet.components.sph_solid.opencl.device_state import DeviceState
from quintet.components.sph_solid.state import Array


class Found(NamedTuple):
    """What may touch from now on."""

    low: Array  # (3,) m, corners of the box around it
    high: Array
    start: DeviceArray  # (all, 4) rows of places at the start
    order: DeviceArray | None  # (all,) numbers in the order of one rank; None: the rows are


class Touched(NamedTuple):
    """Rows of what may touch, as they are in a step."""

    place: DeviceArray  # (all, 4)
    motion: DeviceArray  # (all, 4)
    stress: DeviceArray  # (all, 12)


class OwnParticles:
    """All particles of a solid on one rank."""

    others = 0  # rows behind own ones

    def find(self, rows: DeviceState, start: DeviceArray, reach: float) -> Found | None:
        """All particles; None where one is at no place."""
        low, high, is_wrong = rows.extremes_of(rows.place)
        return None if is_wrong else Found(low, high, start, None)

    def touched(self, rows: DeviceState) -> Touched:
        """Rows of all particles."""
        return Touched(rows.place, rows.motion, rows.stress)
