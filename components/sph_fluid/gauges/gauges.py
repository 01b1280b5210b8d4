"""Readings of gauges: pressure at points, level above spots, the front, energies.

Pressure is what a face would feel per area: Σ V_j W_j of the particles' pressures, each carried on
to the gauge's height as in still water, over the room Σ V_j W_j that the walls leave. Where fluid
fills that room up to a seventh it is the mean over the fluid instead, which knows no gaps between
particles. A face that a drop strikes feels but its share, as the real one's sensor does; without
fluid near it a gauge reads 0. Dynamic walls keep the fluid off: there it is always the mean.
Where fluid fills less than half of the room there is none to pull: a gauge above the surface, or
before the front, reads nothing below 0 even of a fluid that bears tension.

A level is where the share of volume Σ_j V_j W_j, seen from above, first rises through one half;
beside a wall, where it is nowhere 1, through half of its largest value. Lone drops are passed
over; a dry spot reads the lowest level of the tank. With a smoothing so short that two drops fill
half of a spot or more, a column is wet too where its share of volume sums up to 4 spacings.

The front is half a spacing ahead of the furthest particle with 1/(V W(0)) neighbours or more
(11 in three dimensions, with h = 1.5 spacings): a block's corner has so many, spray has not.
"""

import math
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.smoothing.cubic_spline import SUPPORT
from quintet.components.sph_fluid.boundary.symmetry_planes import SymmetryPlanes
from quintet.components.sph_fluid.constants import constants
from quintet.components.sph_fluid.gauges.kernels import add_around, furthest
from quintet.components.sph_fluid.gauges.levels import SURFACE, Levels
from quintet.components.sph_fluid.gauges.nearness import near_places
from quintet.components.sph_fluid.mass_balance.sums import without_buffers
from quintet.components.sph_fluid.motion.frame import Frame
from quintet.components.sph_fluid.open_boundaries.crossings import potential_of_crossings
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.ranks.method import Ranks
from quintet.components.sph_fluid.state import Array, State
from quintet.interfaces.component import Fields

if TYPE_CHECKING:
    from quintet.components.sph_fluid.gauges.flow import FlowGauges

FULL = 0.85  # of the room that walls leave: so much is filled where there is but fluid


class Gauges:
    """The gauges of one fluid that are switched on."""

    def __init__(
        self, params: SphFluidParams, symmetry: SymmetryPlanes, ranks: Ranks, frame: Frame
    ) -> None:
        self.params, self.constants, self.ranks = params, constants(params), ranks
        self.frame = frame
        self.reach = SUPPORT * self.constants.smoothing.length  # m
        self.points = np.array(params.gauges.pressure_gauges).reshape(-1, 3)  # (m, 3) m
        self.spots = np.array(params.gauges.level_gauges).reshape(-1, 2)  # (m, 2) m
        if params.dimensions == 2:
            self.points[:, 1] = self.spots[:, 1] = 0.5 * sum(
                corner[1] for corner in params.extents[0]
            )
        # (k m, 3) m: these, and from where images see what these see in them.
        self.image_points = symmetry.all_images(self.points)
        self.levels = Levels(params, symmetry, ranks, self.spots)
        self.flow = _flow_gauges(params, symmetry, ranks)

    def read(self, state: State, lists: Lists) -> Fields:
        """Read all gauges; `lists` are those of this state, if it has any yet."""
        readings: dict[str, Array] = {}
        if len(self.points):
            readings["pressure_gauge.pressure"] = self._pressure(state)
        if len(self.spots):
            readings["level_gauge.height"] = self.levels.heights(state)
        if self.params.gauges.front_gauge is not None:
            readings["front_gauge.position"] = self._front(state, lists)
        if self.params.gauges.motion_gauge:
            readings |= self._motion(state)
        if self.flow:
            readings |= self.flow.read(state)
        return readings

    def _pressure(self, state: State) -> Array:
        sums = np.empty((len(self.image_points), 3))
        weight = self.params.density * self.frame.weight_at(self.image_points)
        position, velocity, split = self.ranks.near(
            state, partial(near_places, self.image_points, self.reach)
        )
        add_around(self.image_points, split, position, velocity, self.constants, weight, sums)
        share, walls, load = sums.reshape(-1, len(self.points), 3).sum(axis=0).T
        least = 0.0 if self.params.boundary.method == "dbc" else FULL * (1.0 - walls)
        filled = np.maximum(share, least)
        pressure = np.divide(load, filled, out=np.zeros(len(load)), where=share > 0.0)
        least = np.where(share < SURFACE * (1.0 - walls), 0.0, self.constants.lowest)
        return np.maximum(pressure, least)

    def _front(self, state: State, lists: Lists) -> Array:
        axis = "xyz".index(str(self.params.gauges.front_gauge))
        coordinates = state.position_density[: state.fluid, axis].copy()
        is_held = state.role > 0  # by buffers of inflows and outflows
        if not is_held.all():
            coordinates[is_held] = -math.inf
        foremost = -math.inf
        if len(state.reference):
            foremost = furthest(
                coordinates, 1.0 / self.levels.lone, state.position_density, lists, self.constants
            )
        # At the start there are no lists, and no spray either.
        foremost, furthest_of_all = self.ranks.greatest(foremost, float(coordinates.max()))
        front = foremost if math.isfinite(foremost) else furthest_of_all
        return np.array([front + 0.5 * self.params.spacing])

    def _motion(self, state: State) -> Fields:
        x, y, z = state.position_density[: state.fluid, :3].T
        u, v, w = state.velocity_pressure[: state.fluid, :3].T
        squares = u * u + v * v + w * w
        count, columns = without_buffers(state, self.ranks.fluid(state), [x, y, z, squares])
        sums = self.ranks.sums(state, columns)
        (fastest,) = self.ranks.greatest(float(columns[3].max()))
        particle_mass = self.constants.mass * self.params.slab_thickness  # kg
        centre, mass = sums[:3] / max(count, 1), particle_mass * count
        deeper = potential_of_crossings(state, self.params, particle_mass)
        return {
            "motion_gauge.speed": np.sqrt([fastest]),
            "motion_gauge.kinetic": 0.5 * particle_mass * sums[3:],
            "motion_gauge.potential": np.array(
                [-mass * float(centre @ self.params.gravity) + deeper]
            ),
            "motion_gauge.centre": centre[np.newaxis],
        }


def _flow_gauges(
    params: SphFluidParams, symmetry: SymmetryPlanes, ranks: Ranks
) -> "FlowGauges | None":
    """Gauges of a flow, if any is switched on."""
    gauges = params.gauges
    if not (gauges.velocity_gauges or gauges.discharge_gauges or gauges.mass_gauge):
        return None
    # Left out of scenes without them.
    from quintet.components.sph_fluid.gauges.flow import FlowGauges

    return FlowGauges(params, symmetry, ranks)
