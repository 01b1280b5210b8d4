"""Height of the surface above spots; `gauges/gauges.py` defines levels."""

import math
from functools import partial

import numpy as np

from quintet.components.shared.smoothing.cubic_spline import SUPPORT
from quintet.components.shared.smoothing.smoothing import kernel
from quintet.components.sph_fluid.boundary.symmetry_planes import SymmetryPlanes
from quintet.components.sph_fluid.constants import constants
from quintet.components.sph_fluid.gauges.kernels import fill_columns
from quintet.components.sph_fluid.gauges.nearness import near_places
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.ranks.method import Ranks
from quintet.components.sph_fluid.state import Array, State

FINE = 0.25  # spacings between the heights at which the share of volume is looked at
SURFACE = 0.5  # share of the room at the surface
DROP = 2.0  # particles on one spot whose share of volume is not yet a surface
DEEP = 4.0  # spacings, of the share of volume along a column that is no drop


class Levels:
    """Levels above spots (m, 2) m of one fluid."""

    def __init__(
        self, params: SphFluidParams, symmetry: SymmetryPlanes, ranks: Ranks, spots: Array
    ) -> None:
        self.params, self.constants, self.ranks = params, constants(params), ranks
        self.symmetry = symmetry
        self.reach = SUPPORT * self.constants.smoothing.length  # m
        walls = params.boundary.tank
        boxes = [walls] if walls else params.extents
        self.floor = min(box[0][2] for box in boxes)  # m
        volume = self.constants.mass / self.constants.density
        self.lone = volume * float(kernel(0.0, self.constants.smoothing))  # 1, V W(0)
        self.place(spots)

    def place(self, spots: Array) -> None:
        """Look above other spots (m, 2) m."""
        self.spots = spots
        # (k m, 2) m: these, and from where images see what these see in them.
        self.image_spots = self.symmetry.all_images(spots)

    def heights(self, state: State) -> Array:
        """Levels (m,) m."""
        z, spacing = state.position_density[: state.fluid, 2], self.params.spacing
        reach, rise = self.reach, FINE * spacing
        highest, depth = self.ranks.greatest(float(z.max()), float(-z.min()))
        bottom = -depth - reach
        count = math.ceil((highest + reach - bottom) / rise) + 1
        share = np.empty((len(self.image_spots), count))
        position, _, split = self.ranks.near(
            state, partial(near_places, self.image_spots, self.reach)
        )
        fill_columns(self.image_spots, bottom, rise, split, position, self.constants, share)
        total_share = share.reshape(-1, len(self.spots), count).sum(axis=0)
        return np.array([self._surface(row, bottom, rise) for row in total_share])

    def _surface(self, share: Array, bottom: float, rise: float) -> float:
        largest = min(1.0, float(share.max()))
        if largest <= DROP * self.lone and not self._is_deep(share, rise):
            return self.floor
        half = SURFACE * largest
        k = int(np.flatnonzero(share >= half)[-1])  # never the last: there the share is 0
        part = (share[k] - half) / (share[k] - share[k + 1])
        return float(bottom + (k + part) * rise)

    def _is_deep(self, share: Array, rise: float) -> bool:
        """Whether a column holds water where drops alone fill as much as water does."""
        if DROP * self.lone <= SURFACE:
            return False
        return float(share.sum()) * rise > DEEP * self.params.spacing
