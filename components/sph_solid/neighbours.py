"""Which particles are near: Verlet lists of a reach that follows how fast bodies deform."""

import math

import numpy as np

from quintet.components.shared.search.neighbours import Lists, NeighbourLists
from quintet.components.shared.smoothing.cubic_spline import SUPPORT
from quintet.components.shared.symmetry import ODD_OF_SIX, Plane
from quintet.components.shared.threads import Team
from quintet.components.sph_solid.kernels.motion import meets_unlisted
from quintet.components.sph_solid.method import method
from quintet.components.sph_solid.params import SphSolidParams
from quintet.components.sph_solid.ranks.method import Ranks, extremes
from quintet.components.sph_solid.state import Array, Rows, State, Whole

# The cost of a step is least with a skin of about this times the root of what particles approach
# each other by in it, both over the support: a search costs half as much as the sums over pairs.
SKIN = 1.0
LEAST, MOST = 0.01, 0.15  # of the support
# Of the support, what two may approach each other by in a step: more is an unstable step, and lists
# that reach so far hold whole bodies.
MOST_SPREAD = 5.0
FEW = 64  # particles that are worth comparing with all others rather than searching
WIDER = 0.1  # of its radius, that a ring may move


class SolidLists:
    """Neighbours of every particle, among particles and their images."""

    def __init__(self, params: SphSolidParams, team: Team, ranks: Ranks) -> None:
        self.support = SUPPORT * params.length
        self.team = team
        settings = method(params)
        self.are_for_good = settings.total_lagrangian
        self.corrected = settings.kernel_correction or settings.total_lagrangian
        # Of rows of stress: a tensor of six or nine numbers, two densities, an artificial tensor.
        self.width = (
            16 if params.artificial_stress > 0.0 else 12 if settings.kernel_correction else 8
        )
        planes = ranks.images.planes
        self.ranks, self.images = ranks, ranks.images
        axis = [Plane("x-", 0, 0.0, 1.0)] if params.axisymmetric else []
        self.mirrors = [*planes, *axis]  # what moves towards one meets what moves the other way
        self.is_axisymmetric = params.axisymmetric
        self.joined = joined(params)
        self.near = NeighbourLists()
        self.points: Array = np.zeros((0, 3))  # (n + images, 3) m, references

    @property
    def arrays(self) -> Lists:
        """What kernels take."""
        return self.near.arrays

    def spread(self, low: Array, high: Array) -> float:
        """How far [m] two may have come apart or near, if all moved by low to high (3,) m.

        Images move the other way across their planes, and so does the other side of an axis.
        """
        low, high = low.copy(), high.copy()
        for plane in self.mirrors:
            k = plane.axis
            low[k], high[k] = min(low[k], -high[k]), max(high[k], -low[k])
        return float(np.linalg.norm(high - low))

    def may_miss(self, state: State, spread: float, middle: Array, dt: float) -> bool:
        """Whether the lists may lack a pair that acts in a step.

        They lack none if two particles approached by less than the skin, or if only a few moved
        beyond the skin and none of these has new neighbours.

        Parameters
        ----------
        state : State
            With velocities of the step's middle.
        spread : float, m
            By which two particles may have approached.
        middle : (n, 4) float array, m
            Places in the step's middle.
        dt : float, s
        """
        if self.are_for_good or spread <= state.reach - self.support:
            return False
        places = np.ascontiguousarray(middle[:, :3]), state.position + dt * state.velocity
        moved = [place - state.reference for place in places]
        if not self.mirrors:
            columns = [column for shift in moved for column in shift.T]
            mean = self.ranks.sums(state, columns) / self.ranks.particles(state)
            moved = [moved[0] - mean[:3], moved[1] - mean[3:]]
        furthest = np.maximum(*((shift * shift).sum(axis=1) for shift in moved))
        skin = state.reach - self.support
        fast = np.flatnonzero(furthest > 0.25 * skin * skin)
        # The fast ones of all ranks, and then this rank's own particles.
        columns = [place[fast] for place in (*places, state.reference)]
        of_all = self.ranks.all_rows(state.identity[fast], np.concatenate(columns, axis=1))
        if len(of_all) > FEW:
            return True
        for plane in self.mirrors:
            for place in (of_all[:, :3], of_all[:, 3:6]):
                depth = plane.inward * (place[:, plane.axis] - plane.position)
                if (depth < self.support).any():
                    return True
        if self.is_axisymmetric:  # rings have their cuts of the radius that they had
            if (np.abs(moved[1][fast, 0]) > WIDER * state.reference[fast, 0]).any():
                return True
        parts = zip(np.split(of_all, 3, axis=1), (*places, state.reference), strict=True)
        arrays = [np.concatenate(part) for part in parts]
        meets = meets_unlisted(np.arange(len(of_all)), *arrays, self.support, skin)
        return bool(self.ranks.greatest(np.array([float(meets)]))[0])

    def sort(self, state: State, dt: float) -> bool:
        """Sort particles by their places in the middle of a step of dt [s], after reflections.

        False, and nothing is sorted, where no stable step leads to these places.
        """
        self.reflect(state)
        low, high = extremes(self.ranks, state.velocity, state.velocity)
        spread = dt * self.spread(low, high)
        middle = state.position + 0.5 * dt * state.velocity
        wrong = float(self.is_unstable(spread) or not np.isfinite(middle).all())
        if self.ranks.greatest(np.array([wrong]))[0]:
            return False
        self.widen(state, spread)
        self.ranks.sort(state, middle)
        return True

    def is_unstable(self, spread: float) -> bool:
        """Whether no stable step lets two particles approach each other by so much [m]."""
        return not spread < MOST_SPREAD * self.support

    def are_short(self, state: State) -> bool:
        """Whether lists of a state's reach end before the support of pairs, with any skin."""
        return state.reach < (1.0 + 0.5 * LEAST) * self.support

    def widen(self, state: State, spread: float) -> None:
        """Choose how far the next lists reach, by what two approach each other in a step [m]."""
        share = min(max(SKIN * math.sqrt(spread / self.support), LEAST), MOST)
        # Made in a step's middle, they hold to its end at least.
        state.reach = self.support + max(share * self.support, 0.51 * spread)

    def reflect(self, state: State) -> None:
        """Let what has passed a plane of symmetry, or an axis, change places with its image."""
        for plane in self.mirrors:
            k = plane.axis
            out = np.flatnonzero(plane.inward * (state.position[:, k] - plane.position) < 0.0)
            state.position[out, k] = 2.0 * plane.position - state.position[out, k]
            state.velocity[out, k] *= -1.0
            state.acceleration[out, k] *= -1.0
            for odd in ODD_OF_SIX[k]:
                state.deviator[out, odd] *= -1.0

    def make(self, state: State) -> Rows:
        """List what is near, from where all was when it was sorted; make room for pairs."""
        self.points, self.near = self.ranks.neighbours(state, self.team, self.near.list)
        count = state.particles
        if self.are_for_good and self.joined.any():
            self._part(state)
        return Rows.empty(count, len(self.points) - count, self.corrected, self.width)

    def group(self, state: State) -> Whole:
        """Number (n,) of the bodies that are one with that of each particle."""
        return self.joined[state.body]

    def _part(self, state: State) -> None:
        """Let particles of bodies that are not one be no neighbours: each is its own instead."""
        group = np.zeros(len(self.points))
        group[: state.particles] = self.group(state)
        self.images.write_values(group, state.particles)
        counts = self.near.end - self.near.begin
        row = np.repeat(np.arange(len(counts)), counts)
        entry = np.arange(len(row)) + np.repeat(
            self.near.begin - np.cumsum(counts) + counts, counts
        )
        other = group[self.near.list[entry]] != group[row]
        self.near.list[entry[other]] = row[other]


def symmetry_planes(params: SphSolidParams) -> list[Plane]:
    """Planes of symmetry of the bodies."""
    return [
        Plane(plane.axis + ("-" if plane.side == "+" else "+"), "xyz".index(plane.axis),
              plane.position, 1.0 if plane.side == "+" else -1.0)
        for plane in params.symmetry
    ]  # fmt: skip


def joined(params: SphSolidParams) -> Whole:
    """Number (bodies,) of the bodies that move alike at the start: they are one where they meet."""
    motions = [body.motion for body in params.bodies]
    return np.array([motions.index(motion) for motion in motions])
