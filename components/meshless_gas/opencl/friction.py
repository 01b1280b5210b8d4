"""Friction and heat conduction on a device, as `viscous/terms.py`; only for scenes with them."""

import numpy as np

from quintet.components.meshless_gas.kernels.motion import STAGES
from quintet.components.meshless_gas.opencl.device_cloud import INDEX
from quintet.components.meshless_gas.opencl.device_state import DeviceState, groups
from quintet.components.meshless_gas.viscous.terms import Viscous
from quintet.components.shared.opencl.arrays import DeviceArray
from quintet.components.shared.opencl.types import bytes_of
from quintet.interfaces.component import Array


class DeviceFriction:
    """Terms of viscosity of one gas.

    Parameters
    ----------
    friction : Viscous
        Friction of the host's gas.
    state : DeviceState
        States of the gas on the device.
    """

    def __init__(self, friction: Viscous, state: DeviceState) -> None:
        self.state, tables, queue = state, state.tables, state.queue
        self._law, self._gamma = bytes_of(friction.law, np.float64), np.float64(friction.gamma)
        self._spread = bytes_of(friction.spread, np.float64)
        self.walls = len(friction.rows)
        self._rows = DeviceArray.of(queue, friction.rows.astype(INDEX))
        self._above = tables.of(friction.above, INDEX)
        self._weights, self._velocity = tables.of(friction.weights), tables.of(friction.velocity)
        self._temperature = DeviceArray.of(queue, friction.temperature)
        self._sizes = DeviceArray.of(queue, np.sqrt((friction.areas**2).sum(axis=1)))
        whole = state.cloud.whole
        self._transported, self._slopes = tables.empty(whole, 2), tables.empty(whole, 3)
        self._groups = groups(self.walls)
        self._parts = DeviceArray.of(queue, np.zeros((len(STAGES), self._groups, 5)))

    def add_rates(self) -> None:
        """Add rates of momentum and energy, by the gradients of this stage."""
        state, cloud = self.state, self.state.cloud
        nodes, whole, width = map(np.int32, (cloud.nodes, cloud.whole, cloud.width))
        stencils = (cloud.neighbours, cloud.coefficients)
        self._write_transport()
        state.run(
            "write_temperature_slopes", cloud.nodes, nodes, whole, width, *stencils,
            self._transported, self._slopes,
        )  # fmt: skip
        state.run(
            "write_ghost_slopes", cloud.ghosts, nodes, whole, cloud.owner, cloud.turn,
            self._slopes,
        )  # fmt: skip
        count = cloud.inner.shape[0]
        state.run(
            "add_friction", -(-count // state.lanes), np.int32(count), nodes, whole, width,
            cloud.inner, cloud.positions, state.primitive, self._transported,
            state.gradients, self._slopes, *stencils, self._law, state.residual,
        )  # fmt: skip

    def write_walls(self) -> None:
        """Write the states of walls: their velocity and temperature, the gas's pressure."""
        cloud = self.state.cloud
        self.state.run(
            "write_no_slip_walls", self.walls, *map(np.int32, (self.walls, cloud.whole)),
            np.int32(cloud.width), self._rows, cloud.neighbours, self._weights, cloud.normals,
            self._velocity, self._temperature, self._gamma, self._law, self.state.primitive,
        )  # fmt: skip

    def sum_flows(self, stage: int) -> None:
        """Sum the friction and the heat flux of all walls after a stage."""
        cloud, first = self.state.cloud, np.int32(5 * stage * self._groups)
        self.state.run(
            "sum_wall_flows", self.walls, np.int32(self.walls), np.int32(cloud.whole), self._rows,
            self._above, cloud.positions, cloud.normals, self._sizes, self._velocity,
            self._temperature, self.state.primitive, self._law, first, self._parts,
        )  # fmt: skip

    def flows(self) -> Array:
        """What friction and conduction add (3, 5) kg/s, N, W to what enters, after each stage."""
        return np.asarray(self._parts.get().sum(axis=1))

    def shorten(self, first: np.int32, parts: DeviceArray) -> None:
        """Shorten the stable steps of nodes by what diffusion needs."""
        state, cloud = self.state, self.state.cloud
        count, whole, width = map(np.int32, (cloud.inner.shape[0], cloud.whole, cloud.width))
        self._write_transport()
        state.run(
            "shorten_bounds", cloud.inner.shape[0], count, whole, width, cloud.inner,
            cloud.positions, state.primitive, self._transported, cloud.neighbours,
            cloud.coefficients, self._gamma, self._spread, state.bounds, first, parts,
        )  # fmt: skip

    def _write_transport(self) -> None:
        """Write temperature and viscosity of all nodes."""
        whole = self.state.cloud.whole
        self.state.run(
            "write_transport", whole, np.int32(whole), self.state.primitive, self._law,
            self._transported,
        )  # fmt: skip
