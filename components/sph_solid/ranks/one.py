"""All particles on one rank."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.exact_sums import bounds, sum_parts, total
from quintet.components.shared.search.cells import grid_around, sorted_into
from quintet.components.shared.search.neighbours import NeighbourLists, neighbours_within
from quintet.components.shared.symmetry import Plane, SymmetryImages, neighbours_and_images
from quintet.components.shared.threads import Team
from quintet.components.sph_solid.state import Array, State, Whole, chosen
from quintet.interfaces.component import Fields


class NoCopies:
    """Particles that may touch, where all are own."""

    def find(self, places: Array, reach: float) -> tuple[Array, Whole]:
        """Return the places, and their rows."""
        return places, np.arange(len(places))

    def extend(self, *arrays: Array) -> list[Array]:
        """Return the arrays."""
        return list(arrays)


class OneRank:
    """A solid whose state is all there is, with planes of symmetry."""

    rank = 0

    def __init__(self, planes: list[Plane]) -> None:
        self.images = SymmetryImages(planes)

    def begin_step(self) -> None:
        """Nothing to do: nobody shares the work."""

    def end_step(self) -> None:
        """Nothing to do: nobody shares the work."""

    def sort(self, state: State, places: Array) -> None:
        """Bring particles that are near, by places (n, 3 or more) m, into near rows."""
        order = sorted_into(places, grid_around(places, state.reach))[2]
        state.reference = np.ascontiguousarray(places[:, :3])
        state.reorder(order)

    def neighbours(
        self, state: State, team: Team, buffer: NDArray[np.int32]
    ) -> tuple[Array, NeighbourLists]:
        """Places of particles and their images, and the lists of particles."""
        points, count = self.images.find(state.reference, state.reach), state.particles
        if len(points) == count:
            return points, neighbours_within(state.reach, points, count, team, None, buffer)
        all_alike: NDArray[np.bool_] = np.ones(len(points), bool)
        return points, neighbours_and_images(
            points, all_alike, count, count, state.reach, team, None, buffer
        )

    def contact(self) -> NoCopies:
        """All particles."""
        return NoCopies()

    def load(self, state: State) -> None:
        """Nothing to do: the state is all."""

    def particles(self, state: State) -> int:
        """Those of the state."""
        return state.particles

    def greatest(self, numbers: Array) -> Array:
        """Return the numbers."""
        return numbers

    def sums(self, state: State, columns: Sequence[Array]) -> Array:
        """Sum the columns."""
        return total(sum_parts(columns, bounds(columns), state.particles))

    def all_rows(self, keys: Whole, rows: Array) -> Array:
        """Return the rows."""
        return rows

    def whole(self, state: State, names: Sequence[str] = ()) -> State:
        """Return the state."""
        return state

    def agree(self, numbers: Array) -> None:
        """Nothing to do: this is rank 0."""

    def owners(self, state: State) -> Fields:
        """Nothing to tell."""
        return {}

    def owner(self, state: State, identity: int) -> str:
        """Nobody else could."""
        return ""

    def rows_of(self, state: State, identities: Whole) -> State:
        """Particles that were born with some numbers, in that order."""
        row = np.empty(state.particles, np.int64)
        row[state.identity] = np.arange(state.particles)
        return chosen(state, row[identities])
