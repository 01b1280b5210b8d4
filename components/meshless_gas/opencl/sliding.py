"""Walls along which a rarefied gas slides, on a device; only for scenes with them."""

from typing import Any

import numpy as np

from quintet.components.meshless_gas.opencl.device_state import DeviceState
from quintet.components.meshless_gas.viscous.rarefied import RarefiedWalls
from quintet.components.shared.opencl.arrays import DeviceArray


class DeviceSliding:
    """The walls of one gas that have accommodation coefficients.

    Parameters
    ----------
    rarefied : RarefiedWalls
        Walls of the host's gas.
    walls : int
        Number of all walls, with and without slip.
    state : DeviceState
    """

    def __init__(self, rarefied: RarefiedWalls, walls: int, state: DeviceState) -> None:
        self.state, self._walls = state, np.int32(walls)
        self._curvature = np.float64(rarefied.curvature)
        lengths = np.zeros((walls, 2))
        lengths[rarefied.chosen] = rarefied.lengths
        self._lengths = state.tables.of(lengths)  # mean free paths, 0 of walls that hold the gas

    def write_walls(
        self, rows: DeviceArray, above: DeviceArray, velocity: DeviceArray,
        temperature: DeviceArray, law: Any,
    ) -> None:  # fmt: skip
        """Let the gas have its own temperature and velocity at walls that have others."""
        state, cloud, walls = self.state, self.state.cloud, self._walls
        nodes, whole, width = map(np.int32, (cloud.nodes, cloud.whole, cloud.width))
        state.run(
            "write_jumps", int(walls), walls, whole, rows, above, cloud.positions, cloud.normals,
            velocity, temperature, self._lengths, self._curvature, law, state.primitive,
        )  # fmt: skip
        state.run(
            "write_slips", int(walls), walls, nodes, whole, width, rows, above, cloud.positions,
            cloud.normals, cloud.neighbours, cloud.coefficients, cloud.owner, velocity,
            self._lengths, self._curvature, law, state.primitive,
        )  # fmt: skip

    @property
    def arguments(self) -> tuple[Any, ...]:
        """Last arguments of the kernel that sums what enters through walls."""
        cloud = self.state.cloud
        stencils = np.int32(cloud.width), cloud.neighbours, cloud.coefficients
        return *stencils, self._lengths, self._curvature
