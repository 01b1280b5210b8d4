"""What gauges read: pressure at points, level above spots, the front, energies.

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
from quintet.components.shared.smoothing.smoothing import kernel
from quintet.components.sph_fluid.boundary.symmetry_planes import SymmetryPlanes
from quintet.components.sph_fluid.constants import constants
from quintet.components.sph_fluid.gauges.kernels import add_around, fill_columns, furthest
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
FINE = 0.25  # spacings between the heights at which the share of volume is looked at
SURFACE = 0.5  # share of the room at the surface
DROP = 2.0  # particles on one spot whose share of volume is not yet a surface
DEEP = 4.0  # spacings, of the share of volume along a column that is no drop


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
        # (k m, 3 or 2) m: these, and from where images see what these see in them.
        self.image_points = symmetry.all_images(self.points)
        self.above = symmetry.all_images(self.spots)
        walls = params.boundary.tank
        boxes = [walls] if walls else params.extents
        self.floor = min(box[0][2] for box in boxes)  # m
        volume = self.constants.mass / self.constants.density
        self.flow = _flow_gauges(params, symmetry, ranks)
        self.lone = volume * float(kernel(0.0, self.constants.smoothing))  # 1, V W(0)

    def read(self, state: State, lists: Lists) -> Fields:
        """Read all gauges; `lists` are those of this state, if it has any yet."""
        readings: dict[str, Array] = {}
        if len(self.points):
            readings["pressure_gauge.pressure"] = self._pressure(state)
        if len(self.spots):
            readings["level_gauge.height"] = self._height(state)
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

    def _height(self, state: State) -> Array:
        z, spacing = state.position_density[: state.fluid, 2], self.params.spacing
        reach, rise = self.reach, FINE * spacing
        highest, depth = self.ranks.greatest(float(z.max()), float(-z.min()))
        bottom = -depth - reach
        count = math.ceil((highest + reach - bottom) / rise) + 1
        share = np.empty((len(self.above), count))
        position, _, split = self.ranks.near(state, partial(near_places, self.above, self.reach))
        fill_columns(self.above, bottom, rise, split, position, self.constants, share)
        whole = share.reshape(-1, len(self.spots), count).sum(axis=0)
        return np.array([self._surface(row, bottom, rise) for row in whole])

    def _surface(self, share: Array, bottom: float, rise: float) -> float:
        most = min(1.0, float(share.max()))
        if most <= DROP * self.lone and not self._is_deep(share, rise):
            return self.floor
        half = SURFACE * most
        k = int(np.flatnonzero(share >= half)[-1])  # never the last: there the share is 0
        part = (share[k] - half) / (share[k] - share[k + 1])
        return float(bottom + (k + part) * rise)

    def _is_deep(self, share: Array, rise: float) -> bool:
        """Whether a column holds water where drops alone fill as much as water does."""
        if DROP * self.lone <= SURFACE:
            return False
        return float(share.sum()) * rise > DEEP * self.params.spacing

    def _front(self, state: State, lists: Lists) -> Array:
        axis = "xyz".index(str(self.params.gauges.front_gauge))
        along = state.position_density[: state.fluid, axis].copy()
        is_held = state.role > 0  # by buffers of inflows and outflows
        if not is_held.all():
            along[is_held] = -math.inf
        ahead = -math.inf
        if len(state.reference):
            ahead = furthest(along, 1.0 / self.lone, state.position_density, lists, self.constants)
        # At the start there are no lists, and no spray either.
        ahead, furthest_of_all = self.ranks.greatest(ahead, float(along.max()))
        front = ahead if math.isfinite(ahead) else furthest_of_all
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
    asked = params.gauges
    if not (asked.velocity_gauges or asked.discharge_gauges or asked.mass_gauge):
        return None
    # Left out of scenes without them.
    from quintet.components.sph_fluid.gauges.flow import FlowGauges

    return FlowGauges(params, symmetry, ranks)
