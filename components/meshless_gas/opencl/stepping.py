"""Steps of a gas on a device: fluxes over a fixed cloud, boundaries, stages of SSP-RK3."""

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from quintet.components.meshless_gas.build import Domain
from quintet.components.meshless_gas.kernels.motion import STAGES
from quintet.components.meshless_gas.laws.limiters import limiter_of
from quintet.components.meshless_gas.opencl.device_cloud import DeviceCloud
from quintet.components.meshless_gas.opencl.programs import gas_program
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.parts import Inviscid, Stage, WallFriction
from quintet.components.shared.opencl.arrays import GROUP, DeviceArray, run
from quintet.components.shared.opencl.devices import Device, build
from quintet.components.shared.opencl.tables import Tables
from quintet.components.shared.opencl.types import bytes_of
from quintet.interfaces.component import Array

if TYPE_CHECKING:
    from quintet.components.meshless_gas.opencl.friction import DeviceFriction
    from quintet.components.meshless_gas.opencl.particles import DeviceParticles

LANES_OF_PROCESSORS = 4  # doubles in one of its vectors; other devices make lanes of rows


class Outcome(NamedTuple):
    """What a step returns."""

    flows: Array  # (3, 5) kg/s, N, W, through the boundary after each stage
    shortest: float  # s, stable for all nodes at a Courant number of 1
    change: float  # 1, root mean square of the densities' relative change
    wrong: int  # row, among nodes that are advanced, of a state that is none; -1: all are


class Stepping:
    """States of one gas on a device, and their steps.

    Parameters
    ----------
    params : MeshlessGasParams
    device : Device
    threads : int
        Of the processor, where it is the device.
    domain : Domain
    friction : WallFriction
        That of the processor.
    """

    def __init__(
        self, params: MeshlessGasParams, device: Device, threads: int, domain: Domain,
        friction: WallFriction,
    ) -> None:  # fmt: skip
        self.queue = device.queue(threads)
        self.tables = Tables(self.queue, device.is_processor)
        self.lanes = LANES_OF_PROCESSORS if device.is_processor else 1
        limiter = limiter_of(params.limiter, params.limiter_threshold)
        text = gas_program(
            limiter, params.planar, params.order == 2, params.viscous, self.lanes,
            self.tables.by_rows,
        )  # fmt: skip
        program = build(self.queue, text)
        # A kernel is made once: pyopencl makes another at each look.
        self.kernels = {kernel.function_name: kernel for kernel in program.all_kernels()}
        self.cloud = cloud = DeviceCloud(domain, self.tables)
        self._limiter = bytes_of(limiter, np.float64)
        self._gamma = np.float64(params.gas.gamma)
        self._gas_constant = np.float64(params.gas.gas_constant)
        self.local_steps = params.local_steps
        self._make_room(cloud)
        self.friction = device_friction(friction, self)
        self.particles: DeviceParticles | None = None

    def _make_room(self, cloud: DeviceCloud) -> None:
        """Make room for states, and for what a step computes of them."""
        empty, whole, nodes = self.tables.empty, cloud.whole, cloud.nodes
        self.primitive = empty(whole, 5)  # kg/m3, m/s, Pa
        self.gradients = empty(whole, 15)
        self.conservative, self.start, self.residual = (empty(nodes, 5) for _ in range(3))
        self.lowest, self.sound, self.bounds = (
            DeviceArray(self.queue, (count,)) for count in (whole, whole, nodes)
        )
        self.wrong = DeviceArray(self.queue, (len(STAGES),), np.int32)
        # Sums and least numbers of groups: flows after each stage, stable steps, changes.
        self._flow_groups = self.groups(cloud.bounding.shape[0])
        self._node_groups = self.groups(cloud.inner.shape[0])
        size = 5 * len(STAGES) * self._flow_groups + 2 * self._node_groups
        self._parts = DeviceArray(self.queue, (size,))

    @property
    def first_least(self) -> int:
        """Where, among the numbers of groups, the least stable steps begin."""
        return 5 * len(STAGES) * self._flow_groups

    @staticmethod
    def groups(rows: int) -> int:
        """How many groups of work items a kernel over so many rows has."""
        return -(-rows // GROUP)

    def run(self, name: str, rows: int, *arguments: Any) -> None:
        """Run a kernel; whole numbers are those of nodes, and floats are double."""
        run(self.queue, self.kernels[name], rows, *arguments)

    def put(self, primitive: Array, conservative: Array) -> Outcome:
        """Copy states (m, 5) of nodes and ghosts and (n, 5) of nodes; compute all that follows."""
        self.tables.put(self.primitive, primitive)
        self.tables.put(self.conservative, conservative)
        self.wrong.put(np.full(len(STAGES), -1, np.int32))
        self._parts.put(np.zeros(self._parts.shape))
        self.tables.put(self.residual, np.zeros(self.residual.shape))
        self._apply_boundaries(len(STAGES) - 1)
        self._find_stable_steps()
        return self._outcome()

    def get(self, primitive: Array, conservative: Array) -> None:
        """Copy the states into arrays of the host."""
        primitive[:] = self.tables.get(self.primitive)
        conservative[:] = self.tables.get(self.conservative)

    def step(self, dt: float, shortest: float) -> Outcome:
        """Advance by dt [s]; `shortest` [s] is the shortest of the nodes' stable steps."""
        cloud, inner = self.cloud, self.cloud.inner
        sizes = np.int32(inner.shape[0]), np.int32(cloud.nodes), np.int32(cloud.whole)
        local = np.float64(shortest if self.local_steps else 0.0)
        for number, (old, new, weight) in enumerate(STAGES):
            self._write_rates(dt, (old, new, weight))
            shares = map(np.float64, (dt, local, old, new))
            self.run(
                "advance", inner.shape[0], *sizes, np.int32(number), *shares, self._gamma, inner,
                self.bounds, self.residual, self.start, self.conservative, self.primitive,
                self.wrong,
            )  # fmt: skip
            self.run(
                "hold_along_walls", cloud.mirrored.shape[0], np.int32(cloud.mirrored.shape[0]),
                *sizes[1:], np.int32(number), cloud.mirrored, cloud.normals, self.wrong,
                self.conservative, self.primitive,
            )  # fmt: skip
            self._apply_boundaries(number)
        self._find_stable_steps()
        return self._outcome()

    def _write_rates(self, dt: float, stage: Stage) -> None:
        """Write the rates of change of density, momentum and energy in a stage of a step [s]."""
        cloud, inner = self.cloud, self.cloud.inner
        whole, width = np.int32(cloud.whole), np.int32(cloud.width)
        nodes, stencils = np.int32(cloud.nodes), (cloud.neighbours, cloud.coefficients)
        self.run(
            "write_gradients", cloud.nodes, nodes, whole, width, self.primitive, *stencils,
            self.gradients, self.lowest,
        )  # fmt: skip
        self.run(
            "write_ghost_gradients", cloud.ghosts, nodes, whole, cloud.owner, cloud.turn,
            self.gradients, self.lowest,
        )  # fmt: skip
        self.run(
            "write_residuals", -(-inner.shape[0] // self.lanes), np.int32(inner.shape[0]), nodes,
            whole, width, inner, cloud.positions, self.primitive, self.gradients, self.lowest,
            *stencils, self._gamma, self._limiter, self.residual,
        )  # fmt: skip
        if self.friction:
            self.friction.add_rates()
        if self.particles:
            self.particles.add_rates(dt, stage)

    def _apply_boundaries(self, stage: int) -> None:
        """Write the states of boundary nodes and ghosts; sum what enters after a stage."""
        cloud, edges, gamma = self.cloud, self.cloud.edges, self._gamma
        whole, width = np.int32(cloud.whole), np.int32(cloud.width)
        self.run(
            "write_boundaries", edges.shape[0], np.int32(edges.shape[0]), whole, width, edges,
            cloud.kind, cloud.patch, cloud.normals, cloud.neighbours, cloud.weights,
            cloud.patches, gamma, self._gas_constant, self.primitive,
        )  # fmt: skip
        leaving, near = cloud.outflows, cloud.near
        self.run(
            "continue_outflows", leaving.shape[0], np.int32(leaving.shape[0]), whole,
            np.int32(near.shape[1]), leaving, near, cloud.planes, cloud.positions, cloud.patch,
            cloud.patches, cloud.normals, gamma, self.primitive,
        )  # fmt: skip
        if self.friction:
            self.friction.write_walls()
        self.run(
            "write_ghosts", cloud.ghosts, np.int32(cloud.nodes), whole, cloud.owner, cloud.turn,
            self.primitive,
        )  # fmt: skip
        first = np.int32(5 * stage * self._flow_groups)
        self.run(
            "sum_flows", cloud.bounding.shape[0], np.int32(cloud.bounding.shape[0]), whole,
            cloud.bounding, cloud.areas, self.primitive, gamma, first, self._parts,
        )  # fmt: skip
        if self.friction:
            self.friction.sum_flows(stage)

    def _find_stable_steps(self) -> None:
        """Find the stable step of each node, and how much densities change in it."""
        cloud, inner = self.cloud, self.cloud.inner
        count, whole = np.int32(inner.shape[0]), np.int32(cloud.whole)
        first = np.int32(self.first_least)
        self.run("write_sound", cloud.whole, whole, self.primitive, self._gamma, self.sound)
        self.run(
            "write_bounds", inner.shape[0], count, whole, np.int32(cloud.width), inner,
            self.primitive, self.sound, cloud.neighbours, cloud.coefficients, self.bounds, first,
            self._parts,
        )  # fmt: skip
        if self.friction:
            self.friction.shorten(first, self._parts)
        self.run(
            "sum_changes", inner.shape[0], count, np.int32(cloud.nodes), inner, self.residual,
            self.bounds, self.conservative, np.int32(first + self._node_groups), self._parts,
        )  # fmt: skip

    def _outcome(self) -> Outcome:
        """Read the numbers of groups, and join them in their order."""
        first, parts, wrong = self.first_least, self._parts.get(), self.wrong.get()
        flows = parts[:first].reshape(len(STAGES), -1, 5).sum(axis=1)
        if self.friction:
            flows += self.friction.flows()
        least, squares = parts[first:].reshape(2, -1)
        mean = float(squares.sum()) / self.cloud.inner.shape[0]
        failed = wrong[wrong >= 0]
        return Outcome(
            flows, float(least.min()), float(np.sqrt(mean)), int(failed[0]) if len(failed) else -1
        )


def device_friction(friction: WallFriction, stepping: Stepping) -> "DeviceFriction | None":
    """Viscosity and heat conduction on a device."""
    if isinstance(friction, Inviscid):
        return None
    # Left out of scenes without friction.
    from quintet.components.meshless_gas.opencl.friction import DeviceFriction
    from quintet.components.meshless_gas.viscous.terms import Viscous

    assert isinstance(friction, Viscous)
    return DeviceFriction(friction, stepping)
