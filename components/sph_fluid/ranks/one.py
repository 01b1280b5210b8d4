"""All of a fluid on one rank."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.exact_sums import bounds, sum_parts, total
from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.shared.search.cells import grid_around, sorted_into
from quintet.components.sph_fluid.mass_balance.losses import (
    book,
    first_of,
    lost_by_face,
    note_exits,
)
from quintet.components.sph_fluid.ranks.method import NearRows, places, refuse_none
from quintet.components.sph_fluid.state import Array, State, Whole
from quintet.interfaces.component import Fields


class OneRank:
    """A fluid whose state is all there is."""

    rank = 0

    def begin_step(self) -> None:
        """Nothing to do: nobody shares the work."""

    def end_step(self) -> None:
        """Nothing to do: nobody shares the work."""

    def sort(self, state: State, reach: float, walls: Bounds | None) -> None:
        """Bring particles that are near into near rows; drop those that left the domain."""
        split = state.fluid
        is_lost = note_exits(state, walls)
        inside = np.flatnonzero(~is_lost)
        refuse_none(len(inside))
        if len(inside) < split:
            book(state, lost_by_face(state, is_lost), first_of(state, is_lost))
        fluid = state.position_density.take(inside, axis=0)
        boundary = state.position_density[split : state.particles]
        grid = grid_around(fluid, reach)
        state.keep(inside[sorted_into(fluid, grid)[2]], sorted_into(boundary, grid)[2])
        state.reference, state.moved = places(state), 0.0

    def join(self, static: Fields) -> None:
        """Nothing to refuse."""

    def follow_samples(self, fields: Fields, first: int = 0) -> None:
        """Nothing to do: they stand in the state."""

    def load(self, state: State) -> None:
        """Nothing to do: the state is all."""

    def fluid(self, state: State) -> int:
        """Those of the state."""
        return state.fluid

    def boundary(self, state: State) -> int:
        """Those of the state."""
        return state.particles - state.fluid

    def greatest(self, *numbers: float) -> tuple[float, ...]:
        """Return the numbers."""
        return numbers

    def count(self, *numbers: int) -> tuple[int, ...]:
        """Return the numbers."""
        return numbers

    def sums(self, state: State, columns: Sequence[Array]) -> Array:
        """Sum the columns."""
        return total(sum_parts(columns, bounds(columns), state.fluid))

    def gather_forces(self, state: State, number: Whole) -> None:
        """Nothing to do: all are here."""

    def boundary_keys(self, state: State) -> Whole:
        """Its rows."""
        return np.arange(state.particles - state.fluid)

    def all_rows(self, keys: Whole, rows: Array) -> Array:
        """Return the rows."""
        return rows

    def whole(self, state: State) -> State:
        """Return the state."""
        return state

    def owners(self, state: State) -> Fields:
        """Nothing to tell."""
        return {}

    def owner(self, state: State, identity: int) -> str:
        """Nobody else could."""
        return ""

    def near(self, state: State, is_near: Callable[[Array], NDArray[np.bool_]]) -> NearRows:
        """Return all rows: what is far adds nothing to a sum."""
        rows = slice(state.particles)
        return NearRows(state.position_density[rows], state.velocity_pressure[rows], state.fluid)
