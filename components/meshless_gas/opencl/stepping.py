"""Steps of a gas on a device: fluxes over a cloud, boundaries, stages of SSP-RK3."""

from typing import Any, NamedTuple

import numpy as np

from quintet.components.meshless_gas.build import Domain
from quintet.components.meshless_gas.kernels.motion import STAGES
from quintet.components.meshless_gas.laws.limiters import limiter_of
from quintet.components.meshless_gas.opencl.device_state import DeviceState, groups
from quintet.components.meshless_gas.opencl.parts import DevicePart
from quintet.components.meshless_gas.opencl.programs import Physics
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.parts import Stage
from quintet.components.shared.opencl.arrays import DeviceArray
from quintet.components.shared.opencl.devices import Device
from quintet.components.shared.opencl.types import bytes_of
from quintet.interfaces.component import Array

MOMENTS = len(STAGES) + 1  # at which boundaries are written: at the step's begin, after each stage


class Outcome(NamedTuple):
    """Results of a step."""

    # Through the boundary at the step's begin, if nodes move, and after each stage.
    flows: Array  # (4, 5) kg/s, N, W
    shortest: float  # s, stable for all nodes of this rank at a Courant number of 1
    squares: Array  # (g,) 1, of the densities' relative change, summed over groups of nodes
    # Of each stage: row, among nodes that are advanced here, of a state that is none; or -1.
    wrong: Array  # (3,)


class Stepping:
    """Steps of one gas on a device.

    Parameters
    ----------
    params : MeshlessGasParams
    device : Device
    queue : pyopencl.CommandQueue
    domain : Domain
        That this rank computes.
    physics : Physics
        For which the program is printed.
    """

    def __init__(
        self, params: MeshlessGasParams, device: Device, queue: Any, domain: Domain,
        physics: Physics,
    ) -> None:  # fmt: skip
        self.state = state = DeviceState(params, device, queue, domain, physics)
        self.cloud, self.run = state.cloud, state.run
        self._limiter = bytes_of(limiter_of(params.limiter, params.limiter_threshold), np.float64)
        self._gamma = np.float64(params.gas.gamma)
        self._gas_constant = np.float64(params.gas.gas_constant)
        self.local_steps = params.local_steps
        # Sums and least numbers of groups: flows after each stage, stable steps, changes.
        self._flow_groups = groups(self.cloud.bounding.shape[0])
        self._node_groups = groups(self.cloud.nodes)
        size = 5 * MOMENTS * self._flow_groups + 2 * self._node_groups
        self._parts = DeviceArray(state.queue, (size,))
        self.moves = params.moving is not None
        self.parts: list[DevicePart] = []  # in the order of their terms

    @property
    def first_least(self) -> int:
        """Where, among the numbers of groups, the least stable steps begin."""
        return 5 * MOMENTS * self._flow_groups

    def put(self, primitive: Array, conservative: Array) -> Outcome:
        """Copy states (m, 5) of nodes and ghosts and (n, 5) of nodes; compute all that follows."""
        self.state.put(primitive, conservative)
        self._parts.put(np.zeros(self._parts.shape))
        self._apply_boundaries(len(STAGES))
        self._find_stable_steps()
        return self._outcome()

    def step(self, dt: float, shortest: float) -> Outcome:
        """Advance by dt [s]; `shortest` [s] is the shortest of the nodes' stable steps."""
        state, cloud, inner = self.state, self.cloud, self.cloud.inner
        sizes = np.int32(inner.shape[0]), np.int32(cloud.nodes), np.int32(cloud.whole)
        local = np.float64(shortest if self.local_steps else 0.0)
        if self.moves:
            self._apply_boundaries(0)
        for number, (old, new, weight) in enumerate(STAGES):
            for part in self.parts:
                part.place(number, dt)
            self._write_rates(dt, (old, new, weight))
            shares = map(np.float64, (dt, local, old, new))
            self.run(
                "advance", inner.shape[0], *sizes, np.int32(number), *shares, self._gamma, inner,
                state.bounds, state.residual, state.start, state.conservative, state.primitive,
                state.wrong,
            )  # fmt: skip
            for part in self.parts:
                part.finish_stage()
            self.run(
                "hold_along_walls", cloud.mirrored.shape[0], np.int32(cloud.mirrored.shape[0]),
                *sizes[1:], np.int32(number), cloud.mirrored, cloud.normals, state.wrong,
                state.conservative, state.primitive,
            )  # fmt: skip
            self._apply_boundaries(number + 1)
        for part in self.parts:
            part.end(dt)
        self._find_stable_steps()
        return self._outcome()

    def _write_rates(self, dt: float, stage: Stage) -> None:
        """Write the rates of change of density, momentum and energy in a stage of a step [s]."""
        state, cloud, inner = self.state, self.cloud, self.cloud.inner
        whole, width = np.int32(cloud.whole), np.int32(cloud.width)
        nodes, stencils = np.int32(cloud.nodes), (cloud.neighbours, cloud.coefficients)
        self.run(
            "write_gradients", cloud.every.shape[0], np.int32(cloud.every.shape[0]), whole, width,
            cloud.every, state.primitive, *stencils, state.gradients, state.lowest,
        )  # fmt: skip
        self.run(
            "write_ghost_gradients", cloud.ghosts, nodes, whole, cloud.owner, cloud.turn,
            state.gradients, state.lowest,
        )  # fmt: skip
        for part in self.parts:
            part.flatten()
        self.run(
            "write_residuals", -(-inner.shape[0] // state.lanes), np.int32(inner.shape[0]), nodes,
            whole, width, inner, cloud.positions, state.primitive, state.gradients, state.lowest,
            *stencils, self._gamma, self._limiter, state.residual, *state.frame,
        )  # fmt: skip
        for part in self.parts:
            part.add_rates(dt, stage)

    def _apply_boundaries(self, moment: int) -> None:
        """Write the states of boundary nodes and ghosts; sum what enters at a moment of a step."""
        state, cloud, edges, gamma = self.state, self.cloud, self.cloud.edges, self._gamma
        whole, width = np.int32(cloud.whole), np.int32(cloud.width)
        self.run(
            "write_boundaries", edges.shape[0], np.int32(edges.shape[0]), whole, width, edges,
            cloud.kind, cloud.patch, cloud.normals, cloud.neighbours, cloud.weights,
            cloud.patches, gamma, self._gas_constant, state.primitive,
        )  # fmt: skip
        leaving, near = cloud.outflows, cloud.near
        self.run(
            "continue_outflows", leaving.shape[0], np.int32(leaving.shape[0]), whole,
            np.int32(near.shape[1]), leaving, near, cloud.planes, cloud.positions, cloud.patch,
            cloud.patches, cloud.normals, gamma, state.primitive,
        )  # fmt: skip
        for part in self.parts:
            part.write_walls()
        self.run(
            "write_ghosts", cloud.ghosts, np.int32(cloud.nodes), whole, cloud.owner, cloud.turn,
            state.primitive,
        )  # fmt: skip
        first = np.int32(5 * moment * self._flow_groups)
        self.run(
            "sum_flows", cloud.bounding.shape[0], np.int32(cloud.bounding.shape[0]), whole,
            cloud.bounding, cloud.areas, state.primitive, gamma, first, self._parts,
        )  # fmt: skip
        for part in self.parts:
            part.sum_flows(moment)

    def _find_stable_steps(self) -> None:
        """Find the stable step of each node, and how much densities change in it."""
        state, cloud, inner = self.state, self.cloud, self.cloud.inner
        count, whole = np.int32(inner.shape[0]), np.int32(cloud.whole)
        first = np.int32(self.first_least)
        self.run("write_sound", cloud.whole, whole, state.primitive, self._gamma, state.sound)
        self.run(
            "write_bounds", inner.shape[0], count, whole, np.int32(cloud.width), inner,
            state.primitive, state.sound, cloud.neighbours, cloud.coefficients, state.bounds, first,
            self._parts, *state.frame,
        )  # fmt: skip
        for part in self.parts:
            part.shorten(first, self._parts)
        self.run(
            "sum_changes", inner.shape[0], count, np.int32(cloud.nodes), inner, state.residual,
            state.bounds, state.conservative, np.int32(first + self._node_groups), self._parts,
        )  # fmt: skip

    def _outcome(self) -> Outcome:
        """Read the numbers of groups, and join them in their order."""
        first, parts, wrong = self.first_least, self._parts.get(), self.state.wrong.get()
        flows = parts[:first].reshape(MOMENTS, -1, 5).sum(axis=1)
        for part in self.parts:
            flows += part.flows()
        advanced = self.cloud.inner.shape[0]
        least, squares = parts[first:].reshape(2, -1)[:, : groups(advanced)]
        return Outcome(flows, float(least.min()), squares, wrong)
