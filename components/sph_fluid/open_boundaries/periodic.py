"""A fluid that repeats along axes of its tank; imported only by a scene that asks.

What is near one of two opposite faces acts from behind the other too: each row nearer to a face
than pairs act has an image a period away. Images stand behind all other rows, are found with the
neighbour lists and written before each loop over pairs, as those in planes of symmetry; near an
edge between two axes images have images. A particle that passed a face goes on from the opposite
one when lists are made again; until then its images act for it.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.search.neighbours import Around, NeighbourLists, neighbours_among
from quintet.components.shared.symmetry import around_images
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import Array, State, Whole
from quintet.interfaces.component import Fields

# Lists' reaches from a face within which rows have images, where query points of bodies and
# obstacles may lie behind a face: they are at most two kernels away from their particles.
FURTHER = 3.0


class Period(NamedTuple):
    """An axis along which the tank repeats."""

    axis: int
    low: float  # m
    length: float  # m


class Shift(NamedTuple):
    """Images of some rows, a period away."""

    axis: int
    distance: float  # m
    origin: Whole  # (k,) rows that have images
    images: slice  # where these stand


def periods(params: SphFluidParams) -> list[Period]:
    """Axes along which a fluid repeats."""
    if params.boundary.tank is None:
        return []
    low, high = params.boundary.tank
    axes = sorted("xyz".index(axis) for axis in set(params.boundary.periodic))
    return [Period(axis, low[axis], high[axis] - low[axis]) for axis in axes]


class PeriodicImages:
    """The images of one fluid's rows, from one list of neighbours to the next."""

    def __init__(self, params: SphFluidParams) -> None:
        self.periods = periods(params)
        self.has_obstacles = bool(params.boundary.obstacles)
        self.shifts: list[Shift] = []

    def neighbours(
        self, state: State, reach: float, team: Team, query_points: Array | None,
        buffer: NDArray[np.int32],
    ) -> NeighbourLists:  # fmt: skip
        """Make room for images, and lists of the fluid, then of the boundary or query points."""
        points, first, second, looking, grid = self.around(state, reach, query_points)
        arguments = (looking, state.fluid, team, buffer, grid)
        return neighbours_among(reach, points, first, second, *arguments)

    def around(self, state: State, reach: float, query_points: Array | None) -> Around:
        """Make room for images, and find all that rows may have as neighbours."""
        rows = state.particles
        has_bodies = self.has_obstacles or bool((state.sample >= 0).any())
        points = self._find(state.reference[:rows], reach * (FURTHER if has_bodies else 1.0))
        is_fluid = np.arange(len(points)) < state.fluid
        self.write_values(is_fluid, rows)
        state.position_density = _with_room(state.position_density, rows, len(points))
        state.velocity_pressure = _with_room(state.velocity_pressure, rows, len(points))
        self.write_images(state)
        return around_images(points, is_fluid, state.fluid, rows, reach, query_points)

    def _find(self, points: Array, reach: float) -> Array:
        """Find rows with images, nearer to a face than `reach` [m]; points (n + images, 3) m."""
        self.shifts = []
        for axis, low, length in self.periods:
            coordinates, first = points[:, axis], len(points)
            ends = [
                (coordinates < low + reach, length),
                (coordinates >= low + length - reach, -length),
            ]
            for is_near, distance in ends:
                origin = np.flatnonzero(is_near)
                shift = Shift(axis, distance, origin, slice(first, first + len(origin)))
                first += len(origin)
                self.shifts.append(shift)
                points = np.concatenate([points, _shifted(points[origin], axis, distance)])
        return points

    def write_images(self, state: State) -> None:
        """Write the images of all particles as they are."""
        for axis, distance, origin, images in self.shifts:
            state.position_density[images] = state.position_density[origin]
            state.position_density[images, axis] += distance
            state.velocity_pressure[images] = state.velocity_pressure[origin]

    def write_vectors(self, vectors: Array, rows: int) -> None:
        """Write the images of vectors (rows + images, 4)."""
        self.write_values(vectors, rows)

    def write_values(self, values: NDArray[np.generic], rows: int) -> None:
        """Write the images of values (rows + images, ...)."""
        for _, _, origin, images in self.shifts:
            values[images] = values[origin]

    def reflect_crossed(self, state: State) -> None:
        """Nothing to do: what passed a face has images until lists are made again."""

    def wrap(self, state: State) -> None:
        """Bring fluid that passed a face back by a period, before lists are made."""
        for axis, low, length in self.periods:
            coordinates = state.position_density[: state.fluid, axis]
            period_count = np.floor((coordinates - low) / length)
            coordinates -= length * period_count
            state.crossings[axis] += int(period_count.sum())

    def wrapped_samples(self, fields: Fields) -> Fields:
        """Samples of bodies where they are in the tank, with their mirror points."""
        wrapped = dict(fields)
        places = [name for name in ("surface.position", "surface.mirror") if name in fields]
        for name in places:
            wrapped[name] = np.array(fields[name])
        for axis, low, length in self.periods:
            coordinates = fields["surface.position"][:, axis]
            distance = length * np.floor((coordinates - low) / length)
            for name in places:
                wrapped[name][:, axis] -= distance
        return wrapped

    def require_before(self, samples: Array) -> None:
        """Nothing to refuse: samples may be anywhere."""

    def all_images(self, points: Array) -> Array:
        """Points (m, 2 or 3) m, then these a period away along each axis, and at edges."""
        for axis, _, length in self.periods:
            if axis < points.shape[1]:
                sides = [_shifted(points, axis, distance) for distance in (length, -length)]
                points = np.concatenate([points, *sides])
        return points


def _shifted(points: Array, axis: int, distance: float) -> Array:
    images = points.copy()
    images[:, axis] += distance
    return images


def _with_room(array: Array, rows: int, count: int) -> Array:
    """Return the first rows of an array (≥ rows, width), and room for others: (count, width)."""
    return np.concatenate([array[:rows], np.zeros((count - rows, array.shape[1]))])
