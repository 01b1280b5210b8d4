"""Clouds that go with bodies on a device; only for scenes with them.

The host moves bodies, cuts holes and fits stencils across overlaps. The device places the nodes;
rows of stencils that the host has written are copied there. The states of walls are copied to the
host, which computes the loads on bodies from them.
"""

from typing import TYPE_CHECKING

import numpy as np

from quintet.components.meshless_gas.kernels.motion import STAGES
from quintet.components.meshless_gas.moving.clouds import MovingClouds, Rows
from quintet.components.meshless_gas.moving.friction import SlipBodies
from quintet.components.meshless_gas.opencl.changed_rows import ChangedRows
from quintet.components.meshless_gas.opencl.device_cloud import INDEX
from quintet.components.meshless_gas.opencl.device_state import DeviceState
from quintet.components.meshless_gas.opencl.parts import DevicePart
from quintet.components.meshless_gas.ranks.one import Ranks
from quintet.components.shared.opencl.arrays import DeviceArray
from quintet.interfaces.component import Array

if TYPE_CHECKING:
    from quintet.components.meshless_gas.opencl.held_bodies import HeldWalls


class DeviceBodies(DevicePart):
    """Bodies of one gas, and the nodes of their clouds.

    Parameters
    ----------
    motion : MovingClouds
        Clouds of the host's gas.
    ranks : Ranks
        That share out the nodes.
    state : DeviceState
        States of the gas on the device.
    """

    def __init__(self, motion: MovingClouds, ranks: Ranks, state: DeviceState) -> None:
        self.motion, self.state, self.changed = motion, state, ChangedRows(state)
        self.ranks = ranks
        layout, tables, queue = motion.layout, state.tables, state.queue
        self._gamma = np.float64(motion.gamma)

        def whole_numbers(rows: Rows) -> DeviceArray:
            return DeviceArray.of(queue, rows.astype(INDEX))

        self._first = int(layout.carried[0])
        self._carrier, self._offsets = whole_numbers(layout.carrier), tables.of(layout.offsets)
        self._images, self._imaged = whole_numbers(layout.images), whole_numbers(layout.imaged)
        self._leaving, self._before = whole_numbers(layout.leaving), whole_numbers(layout.before)
        self._walls, self._above = whole_numbers(layout.walls), tables.of(layout.above, INDEX)
        self._heights = tables.of(layout.heights)
        self._velocity = tables.empty(len(layout.walls), 3)  # m/s, of walls
        self._centres, self._velocities = (  # m, m/s, by rows
            DeviceArray(queue, (len(layout.radii), 3)) for _ in range(2)
        )
        self.held = held_walls(motion, state)
        above = [layout.above.ravel()] if self.held else []
        self._load_nodes = np.unique(np.concatenate([layout.walls, *above]))
        self._rows = whole_numbers(self._load_nodes)
        self._states = DeviceArray(queue, (len(STAGES) + 1, len(self._load_nodes), 5))

    # Steps

    def put(self) -> None:
        """Copy the clouds as they are on the host."""
        self.state.cloud.put(self.ranks.share(self.motion.domain))
        self._find_foreign_nodes()
        self._put_poses()
        self._put_across()

    def begin(self, fresh: Rows | None, primitive: Array, conservative: Array) -> None:
        """Follow the host to the step's start.

        Parameters
        ----------
        fresh : (m,) int array or None
            Nodes that came back, if holes were cut.
        primitive : (m, 5)
        conservative : (n, 5)
            States of the host, which hold those of fresh nodes.
        """
        self._put_poses()
        self._put_stencils()
        if fresh is None:
            return
        cloud, domain, rows = self.state.cloud, self.motion.domain, self.motion.fringe.written
        self.changed.put(cloud.neighbours, rows, domain.stencils.neighbours[rows])
        self.changed.put(self.state.primitive, fresh, primitive[fresh])
        changed = np.union1d(fresh, self._foreign_nodes)  # ranks may own other nodes from now on
        self.changed.put(self.state.conservative, changed, conservative[changed])
        self._find_foreign_nodes()
        cloud.put_rows(self.ranks.share(domain))
        if self.motion.layout.is_cut.any():
            self.state.tables.put(cloud.areas, domain.cloud.areas)
        self._put_across()

    def place(self, stage: int, dt: float) -> None:
        """Move clouds to where they are at a stage, unless an earlier one has failed."""
        if stage > 0 and not self.state.has_failed():
            self.motion.place(stage, dt)
            self._place()
            self._put_stencils()

    def end(self, dt: float) -> None:
        """Move clouds to the step's end, unless the step has failed."""
        if not self.state.has_failed():
            self.motion.end(dt)
            self._place()
            self._put_stencils()

    def flatten(self) -> None:
        """Set gradients to zero at nodes that reach over a fringe, if the scene asks for it."""
        if self.motion.params.fringe_order == 1:
            count = self._across.shape[0]
            self.state.run(
                "clear_gradients", count, np.int32(count), self._whole, self._across,
                self.state.gradients,
            )  # fmt: skip

    def write_walls(self) -> None:
        """Write the states of the bodies' walls."""
        state, many, walls = self.state, self._leaving.shape[0], self._walls.shape[0]
        state.run(
            "copy_states", many, np.int32(many), self._whole, self._leaving, self._before,
            state.primitive,
        )  # fmt: skip
        state.run(
            "write_slip_walls", walls, np.int32(walls), self._whole, self._walls, self._above,
            self._heights, state.cloud.normals, self._velocity, self._gamma, state.primitive,
        )  # fmt: skip
        for held in self.held:
            count = held.numbers.shape[0]
            state.run(
                "write_held_walls", count, *map(np.int32, (count, walls)), self._whole,
                held.numbers, self._walls, self._above, self._heights, held.temperature,
                self._velocity, held.gas_constant, state.primitive,
            )  # fmt: skip

    def sum_flows(self, moment: int) -> None:
        """Keep the states of walls at a moment of the step."""
        count = self._rows.shape[0]
        sizes = map(np.int32, (count, 5, self.state.cloud.whole, 5 * count * moment))
        self.state.run(
            "read_rows", 5 * count, *sizes, self._rows, self.state.primitive, self._states
        )

    def states_at_walls(self) -> tuple[Rows, Array]:
        """Nodes (m,) from which loads are computed, and states (4, m, 5) of the moments."""
        return self._load_nodes, self._states.get()

    def _find_foreign_nodes(self) -> None:
        """Find the nodes that other ranks advance: their conserved states are not exchanged."""
        domain = self.motion.domain
        self._foreign_nodes = np.setdiff1d(domain.inner, self.ranks.share(domain).inner)

    # Geometry

    @property
    def _whole(self) -> np.int32:
        return np.int32(self.state.cloud.whole)

    def _put_poses(self) -> None:
        """Copy velocities of bodies and walls; place all nodes."""
        layout, state = self.motion.layout, self.state
        self._velocities.put(self.motion.pose.velocity)
        state.tables.put(self._velocity, self.motion.wall_velocity)
        count = len(layout.carried)
        state.run(
            "set_frame", count, *map(np.int32, (self._first, count)), self._whole, self._carrier,
            self._velocities, *state.frame,
        )  # fmt: skip
        self._place()

    def _place(self) -> None:
        """Place the nodes of all clouds, and their images, as `MovingClouds` has placed them."""
        layout, state = self.motion.layout, self.state
        self._centres.put(self.motion.placed)
        count, images = len(layout.carried), len(layout.images)
        positions = state.cloud.positions
        state.run(
            "place_carried", count, *map(np.int32, (self._first, count)), self._whole,
            self._carrier, self._offsets, self._centres, positions,
        )  # fmt: skip
        state.run(
            "place_images", images, np.int32(images), self._whole, self._images, self._imaged,
            positions,
        )  # fmt: skip

    def _put_stencils(self) -> None:
        """Copy the rows of stencils, and of weights at boundaries, that were written last."""
        fringe, cloud = self.motion.fringe, self.state.cloud
        rows = fringe.written
        self.changed.put(cloud.coefficients, rows, fringe.stencils.coefficients[rows])
        edges = fringe.edges_of(rows)
        self.changed.put(cloud.weights, edges, fringe.weights[edges])

    def _put_across(self) -> None:
        """Copy which nodes reach over an overlap."""
        across = self.motion.fringe.across
        self._across = DeviceArray.of(self.state.queue, across.astype(INDEX))


def held_walls(motion: MovingClouds, state: DeviceState) -> "list[HeldWalls]":
    """Walls of bodies that hold the gas, if there are any."""
    if isinstance(motion.friction, SlipBodies):
        return []
    # Left out of scenes without friction.
    from quintet.components.meshless_gas.moving.no_slip import NoSlipBodies
    from quintet.components.meshless_gas.opencl.held_bodies import HeldWalls

    assert isinstance(motion.friction, NoSlipBodies)
    return [HeldWalls(motion.friction, state)]
