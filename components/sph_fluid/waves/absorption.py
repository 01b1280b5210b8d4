"""Pistons that make waves and take in those that come back; imported only by a scene with some.

A piston's velocity is corrected by that of long waves whose surface is the difference between the
level in front of it, η, and the one that theory foresees there, η_I (Schäffer & Klopman, J.
Waterway Port Coast. Ocean Eng. 126 (2000) 88, in shallow water; Altomare et al., Coast. Eng. 127
(2017) 37, who call it AWAS):

    dX/dt = dX_I/dt - √(g/h) (η - η_I)

Levels are read at the begin of each step, two smoothing lengths in front of the paddle's face,
where the kernel no longer feels it. They are means over spots across the paddle; their difference
from theory counts up to the (significant) height of the waves.
"""

import itertools
import math

import numpy as np

from quintet.components.sph_fluid.boundary.symmetry_planes import SymmetryPlanes
from quintet.components.sph_fluid.constants import constants
from quintet.components.sph_fluid.gauges.levels import Levels
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.ranks.method import Ranks
from quintet.components.sph_fluid.setup.geometry import ROUNDING
from quintet.components.sph_fluid.setup.paddle_motion import ForeseenSurface
from quintet.components.sph_fluid.setup.piston_checks import part_corners
from quintet.components.sph_fluid.state import Array, State
from quintet.interfaces.errors import StepError

ACROSS = 4.0  # smoothing lengths from spot to spot across the paddle
AHEAD = 2.0  # smoothing lengths from the face to the spots


class Absorber:
    """The correction of one piston."""

    def __init__(
        self, params: SphFluidParams, symmetry: SymmetryPlanes, ranks: Ranks, number: int
    ) -> None:
        waves = params.boundary.pistons[number].waves
        assert waves is not None
        distance = AHEAD * constants(params).smoothing.length
        self.forward, self.level = waves.forward, waves.level  # (3,) 1; m
        self.highest = waves.significant  # m
        self.gain = math.sqrt(waves.gravity / waves.depth)  # 1/s
        self.foreseen = ForeseenSurface(waves.trajectory, waves.water, distance, waves.height)
        self.part, self.room = params.boundary.pistons[number].part, _room(params, number)  # m
        self.spots = _spots(params, number, distance)  # (m, 2) m, at no displacement
        self.ranks, self.levels = ranks, Levels(params, symmetry, ranks, self.spots)

    def velocity(self, state: State, time: float, displacement: float) -> float:
        """Velocity [m/s] that is added at a time [s], of a paddle displaced so far [m].

        Raises
        ------
        StepError
            Where the paddle has left its tank, or there is no water in front of it.
        """
        if not self.room[0] <= displacement <= self.room[1]:
            raise StepError(
                f"boundary.pistons: {self.part} must stay in the tank; it absorbed waves until it "
                f"was displaced by {displacement:.3g} m, with room from {self.room[0]:.3g} to "
                f"{self.room[1]:.3g} m. Move the walls, or lower the waves."
            )
        self.levels.place(self.spots + displacement * self.forward[:2])
        levels = self._of_first_rank(self.levels.heights(state))
        if (levels <= self.levels.floor).any():
            x, y = self.levels.spots[int(np.argmin(levels))].tolist()
            raise StepError(
                f"boundary.pistons: {self.part} absorbs waves by the water in front of it; found "
                f"none at x = {x:.4g} m, y = {y:.4g} m. Lower the waves, or leave absorption out."
            )
        foreseen = self.foreseen.at(time, displacement)
        difference = float(levels.mean()) - self.level - foreseen
        return -self.gain * min(max(difference, -self.highest), self.highest)

    def _of_first_rank(self, levels: Array) -> Array:
        """Levels (m,) m that rank 0 reads, which has all that is near."""
        numbers = levels if self.ranks.rank == 0 else np.full(len(levels), -math.inf)
        return np.array(self.ranks.greatest(*numbers.tolist()))


def _spots(params: SphFluidParams, number: int, distance: float) -> Array:
    """Spots (m, 2) m in a row, a distance [m] in front of a paddle's face, in the water."""
    piston = params.boundary.pistons[number]
    assert piston.waves is not None
    forward = piston.waves.forward[:2]
    direction = np.array([-forward[1], forward[0]])
    corners = part_corners(piston, params.boundary)
    lows, highs = zip(*params.extents, strict=True)
    water = np.array([np.min(lows, axis=0)[:2], np.max(highs, axis=0)[:2]])
    face = float((corners[:, 0] * forward[0] + corners[:, 1] * forward[1]).max()) + distance
    if params.dimensions == 2:
        middle = float(water[:, 1].mean())
        return np.array([[face * float(forward[0]), middle]])
    water_corners = np.array([[x, y] for x in water[:, 0] for y in water[:, 1]])
    sides = [
        points[:, 0] * direction[0] + points[:, 1] * direction[1]
        for points in (corners, water_corners)
    ]
    low, high = max(s.min() for s in sides), min(s.max() for s in sides)
    spacing = ACROSS * constants(params).smoothing.length
    count = max(1, round((high - low) / spacing))
    places = low + (high - low) * (np.arange(count) + 0.5) / count
    return np.asarray(face * forward + places[:, np.newaxis] * direction)


def _room(params: SphFluidParams, number: int) -> tuple[float, float]:
    """Least and greatest displacement [m] of a paddle between walls and obstacles that stand."""
    piston, boundary = params.boundary.pistons[number], params.boundary
    assert piston.waves is not None
    corners, room = part_corners(piston, params.boundary), [-math.inf, math.inf]
    for face in params.closed_faces if boundary.tank else ():
        axis, is_upper = "xyz".index(face[0]), face[1] == "+"
        part = float(piston.waves.forward[axis])
        if part == 0.0:
            continue
        assert boundary.tank is not None
        side = corners[:, axis].max() if is_upper else corners[:, axis].min()
        distance = (boundary.tank[int(is_upper)][axis] - float(side)) / part
        end = int(is_upper == (part > 0.0))
        room[end] = min(room[end], distance) if end else max(room[end], distance)
    sideways = np.array([-piston.waves.forward[1], piston.waves.forward[0], 0.0])
    axes = np.stack([piston.waves.forward, sideways, np.array([0.0, 0.0, 1.0])], axis=1)
    moving_numbers = [paddle.number("obstacles") for paddle in boundary.pistons]
    low, high = (corners @ axes).min(axis=0), (corners @ axes).max(axis=0)
    tolerance = ROUNDING * params.spacing
    across = [2] if params.dimensions == 2 else [1, 2]
    for solid, box in enumerate(boundary.solids):
        ends = np.array(list(itertools.product(*zip(*box, strict=True)))) @ axes
        least, greatest = ends.min(axis=0), ends.max(axis=0)
        beside = np.minimum(high, greatest) - np.maximum(low, least) <= tolerance
        if solid in moving_numbers or beside[across].any() or not beside[0]:
            continue
        if least[0] >= high[0] - tolerance:
            room[1] = min(room[1], float(least[0] - high[0]))
        else:
            room[0] = max(room[0], float(greatest[0] - low[0]))
    return room[0], room[1]
