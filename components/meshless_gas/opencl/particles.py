"""Point particles in a gas on a device; only for a scene that has some.

What particle and gas give each other is computed on the host, from the states of a stage: these are
copied to it, and the rates of momentum and energy back.
"""

import numpy as np

from quintet.components.meshless_gas.build import Domain
from quintet.components.meshless_gas.opencl.device_state import DeviceState
from quintet.components.meshless_gas.opencl.parts import DevicePart
from quintet.components.meshless_gas.parts import Stage
from quintet.components.meshless_gas.point_particles.point_particles import CoupledParticles
from quintet.components.meshless_gas.state import Fluxes


class DeviceParticles(DevicePart):
    """The exchange of particles with one gas.

    Parameters
    ----------
    particles : CoupledParticles
        Particles of the host's gas.
    domain : Domain
    work : Fluxes
        Work arrays of the host's gas; its states and residuals are overwritten.
    state : DeviceState
        States of the gas on the device.
    """

    def __init__(
        self, particles: CoupledParticles, domain: Domain, work: Fluxes, state: DeviceState
    ) -> None:
        self.particles, self.domain, self.work, self.state = particles, domain, work, state
        self._rates = state.tables.empty(state.cloud.nodes, 5)

    def add_rates(self, dt: float, stage: Stage) -> None:
        """Exchange momentum and heat in a stage of a step [s]."""
        work, state, tables = self.work, self.state, self.state.tables
        if state.has_failed():
            return  # the step fails: loads of the last valid stage are left
        work.primitive[:] = tables.get(state.primitive)
        work.residual[:] = 0.0
        self.particles.add_rates(self.domain, work, dt, stage)
        if self.particles.exchange.reaction:
            tables.put(self._rates, work.residual)
            words = 5 * state.cloud.nodes
            state.run(
                "add_rates", words, np.int32(words), self._rates, state.residual
            )  # fmt: skip
