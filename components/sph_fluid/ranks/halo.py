"""Copies of the rows of other ranks behind a rank's own, then images of all in planes of symmetry.

A rank has copies of all rows within reach of the box around the points that it looks from: other
ranks' parts of space are boxes too, so that these are hardly more than it needs.
"""

from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.domain.exchange import send_rows, share
from quintet.components.shared.domain.extremes import greatest, least
from quintet.components.shared.domain.halo import Halo
from quintet.components.shared.search.cells import Grid, corners, grid_between
from quintet.components.shared.search.neighbours import NeighbourLists, neighbours_among
from quintet.components.shared.symmetry import Plane, SymmetryImages
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.ranks.several import Keys
from quintet.components.sph_fluid.state import Array, State, Whole

WIDER = 1.0 + 1e-9  # times a reach, for what is rounded
NOWHERE = np.inf


class HaloAndImages:
    """Copies and images of one fluid's rows, from one list of neighbours to the next.

    It stands in place of a fluid's planes of symmetry: copies are brought up to date where images
    are.

    Parameters
    ----------
    communicator : mpi4py communicator
    keys : Keys
        Of this rank's rows.
    planes : list of Plane
        Of symmetry.
    """

    def __init__(self, communicator: Any, keys: Keys, planes: list[Plane]) -> None:
        self._communicator, self._keys = communicator, keys
        self._images = SymmetryImages(planes)
        self.all_images = self._images.all_images
        self._copies = 0  # rows that are copies
        self._halos: dict[tuple[int, ...], Halo] = {}  # by widths

    def neighbours(
        self, state: State, reach: float, team: Team, query_points: Array | None,
        buffer: NDArray[np.int32],
    ) -> NeighbourLists:  # fmt: skip
        """Make room for copies and images, and lists of the fluid, then of the boundary."""
        rows, split = state.particles, state.fluid
        own = state.reference[:rows]
        others = own[split:] if query_points is None else query_points
        looking = np.concatenate([own[:split], others])
        near_fluid, near_boundary = self._copy(own, split, looking, reach)
        fluid = np.concatenate([own[:split], near_fluid[:, :3]])
        boundary = np.concatenate([own[split:], near_boundary[:, :3]])
        first = _merged(self._keys.fluid, near_fluid)
        second = _merged(self._keys.boundary, near_boundary)
        # From where they stand in their group to their row: own fluid, own boundary, copies.
        row_of_fluid = np.concatenate([np.arange(split), rows + np.arange(len(near_fluid))])
        before = rows + len(near_fluid)
        row_of_boundary = np.concatenate(
            [np.arange(split, rows), before + np.arange(len(near_boundary))]
        )
        in_order = np.concatenate([row_of_fluid[first], row_of_boundary[second]])
        points = self._images.find(np.concatenate([fluid[first], boundary[second]]), reach)
        group = np.arange(len(points)) < len(first)
        count = len(in_order)
        self._images.write_values(group, count)
        self._images.origin = [_renamed(origin, in_order) for origin in self._images.origin]
        self._copies = count - rows
        state.position_density = self._with_room(state.position_density, rows)
        state.velocity_pressure = self._with_room(state.velocity_pressure, rows)
        self.write_images(state)
        named = np.concatenate([in_order, np.arange(count, len(points))])
        by_row = np.empty_like(points)
        by_row[named] = points
        grid = self._grid(points[group], reach)
        return neighbours_among(
            reach, by_row, named[group], named[~group], looking, split, team, buffer, grid
        )

    def _copy(self, own: Array, split: int, looking: Array, reach: float) -> tuple[Array, Array]:
        """Get copies (k, 4) of places [m] and keys of near fluid, and of near boundary.

        From now on the rows of these follow the own ones, rank by rank.
        """
        boxes = share(self._communicator, np.concatenate([_box(looking), _box(own[:split])]))
        all_near, all_rows = [], []
        for keys, start, which in (
            (self._keys.fluid, 0, slice(0, 6)),
            (self._keys.boundary, split, slice(6, 12)),
        ):
            points = own[start : start + len(keys)]
            rows = [_within(points, box[which], WIDER * reach) for box in boxes]
            rows[self._communicator.rank] = np.zeros(0, np.int64)
            # Keys are whole numbers of up to 62 bits: they travel as the bits of numbers.
            numbers = np.column_stack([points, keys.view(np.float64)])
            all_near.append(send_rows(self._communicator, [numbers[part] for part in rows]))
            all_rows.append([start + part for part in rows])
        sent = [np.concatenate(parts) for parts in zip(*all_rows, strict=True)]
        first = len(own)
        received_fluid, first = _blocks(all_near[0], first)
        received_boundary, _ = _blocks(all_near[1], first)
        pairs = zip(received_fluid, received_boundary, strict=True)
        self._sent, self._received = sent, [np.concatenate(pair) for pair in pairs]
        self._halos = {}
        return np.concatenate(all_near[0]), np.concatenate(all_near[1])

    def _with_room(self, array: Array, rows: int) -> Array:
        """Return the first rows of an array (any, width) with room for copies and images."""
        room = np.zeros((self._copies, *array.shape[1:]))
        with_copies = np.concatenate([array[:rows], room])
        return self._images.with_room(with_copies, rows + self._copies)

    def _grid(self, fluid: Array, reach: float) -> Grid:
        """Cells around the fluid of all ranks and its images."""
        low, high = corners(fluid)
        lowest, highest = least(self._communicator, low), greatest(self._communicator, high)
        return grid_between(lowest, highest, reach)

    def _exchange(self, *arrays: Array) -> None:
        """Bring copies up to date."""
        widths = tuple(array.shape[1] for array in arrays)
        if widths not in self._halos:
            halo = Halo(self._communicator, self._sent, self._received, widths)
            self._halos[widths] = halo
        self._halos[widths].exchange(*arrays)

    def write_images(self, state: State) -> None:
        """Write copies and images of all particles as they are."""
        self._exchange(state.position_density, state.velocity_pressure)
        rows = state.particles + self._copies
        self._images.write_positions(state.position_density, rows)
        self._images.write_vectors(state.velocity_pressure, rows)

    def write_vectors(self, vectors: Array, rows: int) -> None:
        """Write copies and images of vectors (rows + copies + images, 4)."""
        self._exchange(vectors)
        self._images.write_vectors(vectors, rows + self._copies)

    def write_values(self, values: NDArray[np.floating], rows: int) -> None:
        """Write copies and images of values (rows + copies + images,)."""
        column: Array = values.reshape(-1, 1)  # type: ignore[assignment]
        self._exchange(column)
        self._images.write_values(values, rows + self._copies)

    def reflect_crossed(self, state: State) -> None:
        """Let fluid that passed a plane change places with its image."""
        rows = slice(state.fluid)
        vectors = [state.velocity_pressure[rows]]
        vectors += [state.acceleration] if len(state.acceleration) else []
        self._images.reflect_crossed(state.position_density[rows], *vectors)

    def require_before(self, samples: Array) -> None:
        """Refuse samples (samples, 3) m behind a plane."""
        self._images.require_before(samples, "surface: sample")


def _box(points: Array) -> Array:
    """Lowest and highest corner (6,) m of points (n, 3) m; of none a box that holds nothing."""
    low, high = points.min(axis=0, initial=NOWHERE), points.max(axis=0, initial=-NOWHERE)
    return np.concatenate([low, high])


def _within(points: Array, box: Array, reach: float) -> Whole:
    """Rows of points (n, 3) m that are within reach [m] of a box (6,) m."""
    inside = np.ones(len(points), bool)
    for axis in range(3):
        along = points[:, axis]
        inside &= (along > box[axis] - reach) & (along < box[3 + axis] + reach)
    return np.flatnonzero(inside)


def _merged(keys: Whole, copies: Array) -> Whole:
    """Order by keys of own rows (n,), then copies (k, 4) with their keys behind them."""
    others = np.ascontiguousarray(copies[:, 3]).view(np.int64)
    return np.argsort(np.concatenate([keys, others]), kind="stable")


def _blocks(parts: list[Array], first: int) -> tuple[list[Whole], int]:
    """Rows into which blocks go, one after another from a first row on, and the next row."""
    ends = first + np.cumsum([0, *map(len, parts)])
    return [np.arange(a, b) for a, b in pairwise(ends)], int(ends[-1])


def _renamed(origin: Whole, row: Whole) -> Whole:
    """Rows of what has images; images themselves stand where they stood."""
    count = len(row)
    return np.where(origin < count, row[np.minimum(origin, count - 1)], origin)
