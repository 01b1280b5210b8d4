"""The gas as a component whose steps run on an OpenCL device.

A `MeshlessGas` on the host makes the nodes, and reads gauges, totals, views, checks and snapshots;
the states are copied into its arrays first. A step copies back the flows through the boundary, the
shortest stable step and the change of the densities. Point particles stay on the host: with them
each stage copies the states.
"""

from dataclasses import replace
from typing import TYPE_CHECKING

from quintet.components.meshless_gas import MANIFEST
from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.diagnostics import step_error
from quintet.components.meshless_gas.kernels.motion import STAGES
from quintet.components.meshless_gas.opencl.refusal import refuse_what_needs_the_processor
from quintet.components.meshless_gas.opencl.stepping import Outcome, Stepping
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.parts import FixedNodes, WallFriction
from quintet.components.meshless_gas.ports import SHOWS
from quintet.components.meshless_gas.ranks.one import OneRank
from quintet.components.shared.opencl.device_component import DeviceComponent
from quintet.components.shared.opencl.devices import device_of, require_doubles
from quintet.components.shared.opencl.limits import refuse_parts
from quintet.interfaces.component import Fields, Resources

if TYPE_CHECKING:
    from quintet.components.meshless_gas.point_particles.point_particles import CoupledParticles

FIRST_DEVICE = Resources(device="opencl")


class DeviceGas(DeviceComponent):
    """Moves a gas through the nodes of a fixed cloud, on a device."""

    Params: type[MeshlessGasParams] = MeshlessGasParams
    manifest = MANIFEST
    shows = SHOWS
    host: MeshlessGas

    def __init__(self, params: MeshlessGasParams, resources: Resources = FIRST_DEVICE) -> None:
        refuse_what_needs_the_processor(params, resources.device)
        device = device_of(resources.device)
        require_doubles(device, resources.device)
        self.params, (self.takes, self.gives) = params, self.ports_of(params)
        self.host = MeshlessGas(params, replace(resources, device="cpu"))
        self._particles = particles(self.host)
        self._refuse_other_parts(resources.device)
        domain = self.host.motion.domain
        self.stepping = Stepping(params, device, resources.threads, domain, self.host.friction)
        for part in self._particles:
            # Left out of scenes without particles.
            from quintet.components.meshless_gas.opencl.particles import DeviceParticles

            self.stepping.particles = DeviceParticles(
                part, domain, self.host.fluxes, self.stepping.state
            )
        self._put()

    def _refuse_other_parts(self, device: str) -> None:
        """Refuse parts that only a step on the processor calls."""
        host = self.host
        known = (FixedNodes, WallFriction)
        names = [
            type(part).__name__
            for part in host.parts
            if not isinstance(part, known) and part not in self._particles
        ]
        names += [] if isinstance(host.all_ranks, OneRank) else [type(host.all_ranks).__name__]
        refuse_parts(names, device, "a gas")

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
        self._is_read = False
        outcome = self.stepping.step(dt, host.scheme.shortest_step)
        if outcome.wrong >= 0:
            self._get()
            share = dt / host.scheme.shortest_step
            raise step_error(
                [outcome.wrong], host.motion.domain, host.fluxes.primitive, host.state.time, share,
                host.params.planar, host.team, host.all_ranks,
            )  # fmt: skip
        flows = [host.fluxes.flows.copy(), *outcome.flows[:-1]]  # at the begin of each stage
        for (_, _, share), entering in zip(STAGES, flows, strict=True):
            state.entered += share * dt * entering
            state.work += share * dt * float(entering[4])
        for part in self._particles:
            state.entered -= dt * part.loss_rates()
        state.time += dt
        self._follow(outcome)
        state.change = outcome.change
        if host.monitor.looks_next:
            self._get()
        host.monitor.update(host.fluxes.primitive, state.change, state.time)

    def _follow(self, outcome: Outcome) -> None:
        """Let the host have the flows and the stable step of the states as they are."""
        self.host.fluxes.flows[:] = outcome.flows[-1]
        self.host.scheme.accept(outcome.shortest, self.host.state.time)

    def _put(self) -> None:
        """Copy the host's state to the device."""
        host = self.host
        outcome = self.stepping.put(host.fluxes.primitive, host.state.conservative)
        self._is_read = False  # boundaries have the bits of the device
        self._follow(outcome)

    def _read(self) -> None:
        """Copy the states into the host's arrays; find loads on walls."""
        host = self.host
        self.stepping.state.get(host.fluxes.primitive, host.state.conservative)
        host.friction.add_flows(host.motion.domain, host.fluxes.primitive, host.fluxes.flows.copy())

    def warnings(self) -> dict[str, str]:
        """Doubts about the cloud and the order, and about inflows at which waves have arrived."""
        self._get()
        return self.host.warnings()


def particles(gas: MeshlessGas) -> "list[CoupledParticles]":
    """Point particles of a gas on the processor."""
    if gas.params.particles is None:
        return []
    # Left out of scenes without particles.
    from quintet.components.meshless_gas.point_particles.point_particles import CoupledParticles

    return [part for part in gas.parts if isinstance(part, CoupledParticles)]
