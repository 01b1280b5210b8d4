"""Zones in which the fluid's motion is damped; imported only by a scene that has some.

    du/dt = -β ξ² u,  ξ from 0 to 1 across the zone

so that waves find no edge at which to turn back; the quadratic law of the DualSPHysics code
(Altomare et al., Coast. Eng. 127 (2017) 37), in which β is `redumax`. At the end of a step all
components of the velocity are divided by 1 + β ξ² dt, which is stable for every β. The kinetic
energy that is taken counts as negative work.
"""

import numpy as np

from quintet.components.sph_fluid.constants import constants
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.ranks.method import Ranks
from quintet.components.sph_fluid.setup.damping_zones import DampingZone
from quintet.components.sph_fluid.state import Array, State, Whole
from quintet.components.sph_fluid.waves.laws import damped_share, damping_strength
from quintet.interfaces.component import Fields

SAVED = "damping"  # key of a saved state: work [J]


class DampingZones:
    """All damping zones of one fluid."""

    def __init__(self, params: SphFluidParams, ranks: Ranks) -> None:
        self.zones, self.ranks, self.work = params.boundary.damping, ranks, 0.0
        self.axes = (0, 1, 2) if params.dimensions == 3 else (0, 2)
        self.mass = constants(params).mass * params.slab_thickness  # kg, of a particle

    def apply(self, state: State, dt: float) -> None:
        """Damp velocities at the end of a step [s]."""
        speed2_loss = np.zeros(state.fluid)  # m2/s2
        for zone in self.zones:
            rows, strength = self._inside(zone, state)
            velocity = state.velocity_pressure[rows, :3]
            u, v, w = velocity.T
            speed2 = u * u + v * v + w * w
            share = damped_share(strength, zone.rate, dt)
            state.velocity_pressure[rows, :3] = velocity * share[:, np.newaxis]
            speed2_loss[rows] += speed2 * (1.0 - share * share)
        self.count_work(state, speed2_loss)

    def count_work(self, state: State, speed2_loss: Array) -> None:
        """Count the work of a loss of squared velocities (fluid,) m2/s2."""
        (sum2,) = self.ranks.sums(state, [speed2_loss]).tolist()
        self.work -= 0.5 * self.mass * sum2

    def _inside(self, zone: DampingZone, state: State) -> tuple[Whole, Array]:
        """Rows (k,) of the fluid in a zone, without those of buffers, and ξ² (k,) there."""
        position = state.position_density[: state.fluid, :3]
        low, high = zone.bounds
        inside = np.ones(state.fluid, bool)
        for axis in self.axes:
            inside &= (position[:, axis] >= low[axis]) & (position[:, axis] <= high[axis])
        if len(state.role):
            inside &= state.role == 0
        rows = np.flatnonzero(inside)
        axis = "xyz".index(zone.towards[0])
        ends = (low[axis], high[axis])
        return rows, damping_strength(position[rows, axis], *ends, zone.towards[1] == "-")

    def save(self) -> dict[str, Array]:
        """Copy out their work."""
        return {SAVED: np.array(self.work)}

    def load(self, state: Fields) -> None:
        """Come back to a saved state."""
        self.work = float(state.get(SAVED, 0.0))
