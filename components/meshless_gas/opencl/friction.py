"""Friction and heat conduction on a device, as `viscous/terms.py`; only for scenes with them."""

from typing import TYPE_CHECKING

import numpy as np

from quintet.components.meshless_gas.kernels.motion import STAGES
from quintet.components.meshless_gas.opencl.device_cloud import INDEX
from quintet.components.meshless_gas.opencl.device_state import DeviceState, groups
from quintet.components.meshless_gas.opencl.parts import DevicePart
from quintet.components.meshless_gas.parts import Stage
from quintet.components.meshless_gas.viscous.terms import Viscous
from quintet.components.shared.opencl.arrays import DeviceArray
from quintet.components.shared.opencl.types import bytes_of
from quintet.interfaces.component import Array

if TYPE_CHECKING:
    from quintet.components.meshless_gas.opencl.sliding import DeviceSliding


class DeviceFriction(DevicePart):
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
        self._velocity = tables.of(friction.velocity)
        self._temperature = DeviceArray.of(queue, friction.temperature)
        self._written = WrittenWalls(friction, state)
        self._sizes = DeviceArray.of(queue, np.sqrt((friction.areas**2).sum(axis=1)))
        self.sliding = sliding_walls(friction, state)
        whole = state.cloud.whole
        self.transported, self.slopes = tables.empty(whole, 2), tables.empty(whole, 3)
        self.slopes.clear()  # as those of the state
        self._groups = groups(self.walls)
        self._parts = DeviceArray.of(queue, np.zeros((len(STAGES) + 1, self._groups, 5)))

    def add_rates(self, dt: float, stage: Stage) -> None:
        """Add rates of momentum and energy, by the gradients of this stage."""
        state, cloud = self.state, self.state.cloud
        nodes, whole, width = map(np.int32, (cloud.nodes, cloud.whole, cloud.width))
        stencils, sloped = (cloud.neighbours, cloud.coefficients), cloud.every.shape[0]
        self._write_transport()
        state.run(
            "write_temperature_slopes", sloped, np.int32(sloped), whole, width, cloud.every,
            *stencils, self.transported, self.slopes,
        )  # fmt: skip
        state.run(
            "write_ghost_slopes", cloud.ghosts, nodes, whole, cloud.owner, cloud.turn,
            self.slopes,
        )  # fmt: skip
        count = cloud.inner.shape[0]
        state.run(
            "add_friction", -(-count // state.lanes), np.int32(count), nodes, whole, width,
            cloud.inner, cloud.positions, state.primitive, self.transported,
            state.gradients, self.slopes, *stencils, self._law, state.residual,
        )  # fmt: skip

    def write_walls(self) -> None:
        """Write the states of walls: their velocity and temperature, the gas's pressure."""
        cloud, written = self.state.cloud, self._written
        count, whole, width = map(np.int32, (written.count, cloud.whole, cloud.width))
        self.state.run(
            "write_no_slip_walls", written.count, count, whole, width, written.rows,
            cloud.neighbours, written.weights, cloud.normals, written.velocity,
            written.temperature, self._gamma, self._law, self.state.primitive,
        )  # fmt: skip
        for sliding in self.sliding:
            sliding.write_walls(
                self._rows, self._above, self._velocity, self._temperature, self._law
            )

    def sum_flows(self, moment: int) -> None:
        """Sum the friction and the heat flux of all walls at a moment of a step."""
        cloud, first = self.state.cloud, np.int32(5 * moment * self._groups)
        arguments = [argument for sliding in self.sliding for argument in sliding.arguments]
        self.state.run(
            "sum_wall_flows", self.walls, np.int32(self.walls), np.int32(cloud.whole), self._rows,
            self._above, cloud.positions, cloud.normals, self._sizes, self._velocity,
            self._temperature, self.state.primitive, self._law, first, self._parts, *arguments,
        )  # fmt: skip

    def flows(self) -> Array:
        """What friction and conduction add (4, 5) kg/s, N, W to what enters."""
        return np.asarray(self._parts.get().sum(axis=1))

    def shorten(self, first: np.int32, parts: DeviceArray) -> None:
        """Shorten the stable steps of nodes by what diffusion needs."""
        state, cloud = self.state, self.state.cloud
        count, whole, width = map(np.int32, (cloud.inner.shape[0], cloud.whole, cloud.width))
        self._write_transport()
        state.run(
            "shorten_bounds", cloud.inner.shape[0], count, whole, width, cloud.inner,
            cloud.positions, state.primitive, self.transported, cloud.neighbours,
            cloud.coefficients, self._gamma, self._spread, state.bounds, first, parts,
        )  # fmt: skip

    def _write_transport(self) -> None:
        """Write temperature and viscosity of all nodes."""
        whole = self.state.cloud.whole
        self.state.run(
            "write_transport", whole, np.int32(whole), self.state.primitive, self._law,
            self.transported,
        )  # fmt: skip


class WrittenWalls:
    """Walls whose states this rank computes.

    Parameters
    ----------
    friction : Viscous
        Friction of the host's gas.
    state : DeviceState
    """

    def __init__(self, friction: Viscous, state: DeviceState) -> None:
        part, tables, queue = friction.written, state.tables, state.queue
        rows = friction.rows[part]
        self.count, self.rows = len(rows), DeviceArray.of(queue, rows.astype(INDEX))
        self.weights, self.velocity = map(
            tables.of, (friction.weights[part], friction.velocity[part])
        )
        self.temperature = DeviceArray.of(queue, friction.temperature[part])


def sliding_walls(friction: Viscous, state: DeviceState) -> "list[DeviceSliding]":
    """Walls along which a rarefied gas slides, if there are any."""
    if not friction.rarefied:
        return []
    # Left out where no gas slides along walls.
    from quintet.components.meshless_gas.opencl.sliding import DeviceSliding

    return [DeviceSliding(part, len(friction.rows), state) for part in friction.rarefied]
