"""The gas as a component whose steps run on an OpenCL device.

A `MeshlessGas` on the host makes the nodes, and reads gauges, totals, views, checks and snapshots;
the states are copied into its arrays first. A step copies back the flows through the boundary, the
shortest stable step and the change of the densities. Point particles stay on the host: with them
each stage copies the states. So do bodies that carry clouds: it moves them, and computes the loads
on them from the states at their walls.
"""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas import MANIFEST
from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.diagnostics import step_error
from quintet.components.meshless_gas.kernels.motion import STAGES
from quintet.components.meshless_gas.opencl.features import (
    bodies_of,
    particles_of,
    physics_of,
    terms,
)
from quintet.components.meshless_gas.opencl.stepping import Outcome, Stepping
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.ports import SHOWS
from quintet.components.shared.opencl.device_component import DeviceComponent
from quintet.components.shared.opencl.devices import require_doubles
from quintet.components.shared.opencl.ranks import device_and_queue
from quintet.interfaces.component import Array, Fields, Resources

if TYPE_CHECKING:
    from quintet.components.meshless_gas.opencl.bodies import DeviceBodies

FIRST_DEVICE = Resources(device="opencl")
CODE = 2**40  # more than there are nodes


class DeviceGas(DeviceComponent):
    """Moves a gas through the nodes of a cloud, on a device."""

    Params: type[MeshlessGasParams] = MeshlessGasParams
    manifest = MANIFEST
    shows = SHOWS
    host: MeshlessGas

    def __init__(self, params: MeshlessGasParams, resources: Resources = FIRST_DEVICE) -> None:
        device, queue = device_and_queue(resources)  # before any other use of OpenCL
        require_doubles(device, resources.device)
        self.params, (self.takes, self.gives) = params, self.ports_of(params)
        self.host = host = MeshlessGas(params, resources)
        self._particles = particles_of(host)
        domain = host.all_ranks.share(host.motion.domain)
        self.stepping = Stepping(params, device, queue, domain, physics_of(host))
        self.stepping.parts = terms(host, self.stepping.state, resources.device)
        self._bodies = bodies_of(host, self.stepping.parts)
        self._put()

    def prime(self, fields: Fields) -> None:
        """Take the places of particles at the start."""
        self._get()
        self.host.prime(fields)

    def stable_dt(self) -> float:
        """Return the share `courant` of the shortest stable step, or what particles allow."""
        if self._particles:
            self._get()
        return self.host.stable_dt()

    def step(self, dt: float) -> None:
        """Advance by dt [s]; with local time steps, dt is the smallest."""
        host, state = self.host, self.host.state
        if host.monitor.is_settled:
            state.time += dt
            return
        for part in self._particles:
            part.begin(dt, host.fluxes.primitive, state.conservative)
        for bodies in self._bodies:
            self._begin(bodies, dt)
        self._is_read = False
        outcome = self.stepping.step(dt, host.scheme.shortest_step)
        self._refuse_failure(dt, outcome.wrong)
        if not self._bodies:  # boundaries are as they were after the last step
            outcome.flows[0] = host.fluxes.flows
        self._count(dt, outcome.flows)
        for part in self._particles:
            state.entered -= dt * part.loss_rates()
        state.time += dt
        self._follow(outcome)
        state.change = density_change(outcome.squares, host)
        if host.monitor.looks_next:
            self._get()
        host.monitor.update(host.fluxes.primitive, state.change, state.time)

    def _refuse_failure(self, dt: float, wrong: NDArray[np.int32]) -> None:
        """Raise where a stage of a step of dt [s] failed; see `Outcome` for its rows."""
        host, ranks, domain = self.host, self.host.all_ranks, self.host.motion.domain
        first, stages = ranks.first(domain), len(wrong)
        # Of the earliest stage the last of all rows.
        codes = [
            (stages - stage) * CODE + first + row
            for stage, row in enumerate(wrong.tolist())
            if row >= 0
        ]
        failed = ranks.greatest(max(codes, default=-1))
        if failed < 0:
            return
        stage, mine = stages - int(failed // CODE), list[int]()
        if failed in codes:
            mine.append(int(wrong[stage]))
        self._get()
        share = dt / host.scheme.shortest_step
        raise step_error(
            mine, domain, host.fluxes.primitive, host.state.time, share, host.params.planar,
            host.team, ranks,
        )  # fmt: skip

    def _begin(self, bodies: "DeviceBodies", dt: float) -> None:
        """Let the host move bodies to the start of a step of dt [s], and the device follow."""
        host, motion, fresh = self.host, bodies.motion, None
        motion.move_to_start(dt)
        if motion.holes.are_old(motion.pose.centre):
            self._get()
            fresh = motion.cut_again(host.fluxes.primitive, host.state.conservative)
        else:
            motion.fringe.refit(motion.pose.centre)
        bodies.begin(fresh, host.fluxes.primitive, host.state.conservative)

    def _count(self, dt: float, flows: Array) -> None:
        """Count what entered in a step of dt [s], by the flows (4, 5) kg/s, N, W at its moments.

        Those through the walls of bodies are added to them.
        """
        state, motion = self.host.state, self.host.motion
        walls = [bodies.states_at_walls() for bodies in self._bodies]
        shares = [share for _, _, share in STAGES]
        for moment, share in enumerate([*shares, None]):
            for rows, states in walls:
                self.host.fluxes.primitive[rows] = states[moment]
                motion.add_flows(motion.domain, self.host.fluxes.primitive, flows[moment])
            if share is not None:  # at the step's end the loads and flows are those of the next one
                motion.sum_loads(share)
                state.entered += share * dt * flows[moment]
                state.work += share * dt * (float(flows[moment, 4]) - motion.partner_power())

    def _follow(self, outcome: Outcome) -> None:
        """Let the host have the flows and the stable step of the states as they are."""
        self.host.fluxes.flows[:] = outcome.flows[-1]
        shortest = self.host.all_ranks.least(outcome.shortest)
        self.host.scheme.accept(shortest, self.host.state.time)

    def _put(self) -> None:
        """Copy the host's state to the device."""
        host = self.host
        for bodies in self._bodies:
            bodies.put()
        outcome = self.stepping.put(host.fluxes.primitive, host.state.conservative)
        self._is_read = False  # boundaries have the bits of the device
        self._follow(outcome)

    def _read(self) -> None:
        """Copy the states into the host's arrays; find loads on walls."""
        host, domain = self.host, self.host.motion.domain
        self.stepping.state.get(host.fluxes.primitive, host.state.conservative)
        host.all_ranks.exchange_conserved(domain, host.state.conservative)
        for part in (host.friction, host.motion):
            part.add_flows(domain, host.fluxes.primitive, np.zeros(5))

    def warnings(self) -> dict[str, str]:
        """Doubts about the cloud and the order, and about inflows at which waves have arrived."""
        self._get()
        return self.host.warnings()


def density_change(squares: Array, gas: MeshlessGas) -> float:
    """Root mean square of the densities' relative change, by squares of this rank's groups."""
    ranks, domain = gas.all_ranks, gas.motion.domain
    return float(np.sqrt(float(ranks.from_owner(squares).sum()) / ranks.advanced(domain)))
