"""Gauges of a flow: velocity at points, discharge through sections, masses that came and went.

A velocity is that of a plane fitted to the particles around a point by moving least squares, which
meets linear profiles exactly, also beside walls; it is 0 where there is no fluid. A discharge is
Σ V u φ(x) over the particles near a section, φ a hat two kernels wide whose integral over x is 1.
"""

from functools import partial

import numpy as np

from quintet.components.shared.smoothing.cubic_spline import SUPPORT
from quintet.components.sph_fluid.boundary.symmetry_planes import SymmetryPlanes
from quintet.components.sph_fluid.constants import constants
from quintet.components.sph_fluid.gauges.nearness import near_places
from quintet.components.sph_fluid.mass_balance.sums import without_buffers
from quintet.components.sph_fluid.open_boundaries.kernels import fit_fields, near_rows
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.ranks.method import Ranks
from quintet.components.sph_fluid.state import Array, State
from quintet.interfaces.component import Fields


class FlowGauges:
    """Those of one fluid that are switched on."""

    def __init__(self, params: SphFluidParams, symmetry: SymmetryPlanes, ranks: Ranks) -> None:
        self.params, self.constants, self.ranks = params, constants(params), ranks
        points = np.array(params.gauges.velocity_gauges).reshape(-1, 3)
        if params.dimensions == 2:
            points[:, 1] = 0.5 * sum(corner[1] for corner in params.extents[0])
        # In planes of symmetry velocities are mirrored too; there one side does.
        sides = symmetry.all_images(points) if params.boundary.periodic else points
        images = sides.reshape(len(sides) // max(len(points), 1), len(points), 3)
        self.points = np.ascontiguousarray(images.transpose(1, 0, 2))  # (m, images, 3) m
        self.sections = np.array(params.gauges.discharge_gauges)  # (k,) m
        self.reach = SUPPORT * self.constants.smoothing.length  # m

    def read(self, state: State) -> dict[str, Array]:
        """Read all of them."""
        readings: dict[str, Array] = {}
        if len(self.points):
            readings["velocity_gauge.velocity"] = self._velocity(state)
        if len(self.sections):
            readings["discharge_gauge.discharge"] = self._discharge(state)
        if self.params.gauges.mass_gauge:
            readings |= self._masses(state)
        return readings

    def _velocity(self, state: State) -> Array:
        is_near = partial(near_places, self.points.reshape(-1, 3), self.reach)
        position, velocity, split = self.ranks.near(state, is_near)
        fields = np.empty((len(self.points), 5))
        fluid = position[:split], velocity[:split]
        near_lists = near_rows(self.points, position[:split], self.reach)
        fit_fields(self.points, *near_lists, *fluid, self.constants, fields)
        return fields[:, :3].copy()

    def _discharge(self, state: State) -> Array:
        rows = slice(state.fluid)
        x, density = state.position_density[rows, 0], state.position_density[rows, 3]
        flow = self.constants.mass * self.params.slab_thickness * state.velocity_pressure[rows, 0]
        columns = []
        for section in self.sections:
            distance = x - section
            if "x" in self.params.boundary.periodic and self.params.boundary.tank is not None:
                length = self.params.boundary.tank[1][0] - self.params.boundary.tank[0][0]
                distance -= length * np.round(distance / length)
            hat = np.maximum(1.0 - np.abs(distance) / self.reach, 0.0) / self.reach  # 1/m
            columns.append(flow / density * hat)
        return self.ranks.sums(state, columns)

    def _masses(self, state: State) -> Fields:
        particle = self.constants.mass * self.params.slab_thickness  # kg
        count, _ = without_buffers(state, self.ranks.fluid(state), [])
        entrances = len(self.params.boundary.inflow)
        entered = int(state.passed[:entrances].sum())
        left = int(state.passed[entrances:].sum()) + state.returned
        lost = state.lost + state.removed
        numbers = {
            "mass": count,
            "entered": entered,
            "left": left,
            "lost": lost,
            "imbalance": count - (state.at_start + entered - left - lost),
        }
        return {f"mass_gauge.{name}": np.array([particle * n]) for name, n in numbers.items()}
