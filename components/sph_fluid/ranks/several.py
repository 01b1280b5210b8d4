"""A fluid shared out among several ranks."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.domain.collection import collect
from quintet.components.shared.domain.cuts import owners
from quintet.components.shared.domain.exchange import share
from quintet.components.shared.domain.extremes import added, counted, greatest
from quintet.components.shared.domain.migration import migrate
from quintet.components.shared.domain.owner import owner_of
from quintet.components.shared.domain.sorting import cells_around, grid_of_all, sort_by_cell
from quintet.components.shared.domain.work import Work
from quintet.components.shared.exact_sums import bounds, sum_parts, total
from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.sph_fluid.mass_balance.losses import (
    book,
    first_of,
    lost_by_face,
    note_exits,
)
from quintet.components.sph_fluid.ranks.boundary_order import BoundaryOrder
from quintet.components.sph_fluid.ranks.groups import (
    boundary_columns,
    fluid_columns,
    put,
    taken,
)
from quintet.components.sph_fluid.ranks.method import NearRows, places, refuse_none
from quintet.components.sph_fluid.state import Array, State, Whole
from quintet.interfaces.component import Fields
from quintet.interfaces.errors import SceneError
from quintet.interfaces.ports import RANK


def _no_keys() -> Whole:
    return np.zeros(0, np.int64)


@dataclass(slots=True)
class Keys:
    """Numbers that rise in the order in which one rank would have the rows of this one."""

    fluid: Whole = field(default_factory=_no_keys)
    boundary: Whole = field(default_factory=_no_keys)


class SeveralRanks:
    """A fluid of which each rank has all until it is sorted for the first time, then its part.

    Parameters
    ----------
    communicator : mpi4py communicator
    keys : Keys
        Written.
    """

    def __init__(self, communicator: Any, keys: Keys) -> None:
        self._communicator, self._keys = communicator, keys
        self.rank, self._work = communicator.rank, Work()
        self._shared = False  # whether each rank has its part alone
        self._fluid = 0  # of all ranks
        self._number: Whole = _no_keys()  # (boundary,) of this rank's rows, in `BoundaryOrder`

    def begin_step(self) -> None:
        """Begin to measure how long this rank computes."""
        self._work.begin()

    def end_step(self) -> None:
        """Stop measuring."""
        self._work.end()

    def sort(self, state: State, reach: float, walls: Bounds | None) -> None:
        """Bring rows to the ranks that own their cells, and near ones into near rows."""
        if not self._shared:
            self._share_out(state)
        fluid, boundary = fluid_columns(state), boundary_columns(state, self._mirrored)
        is_lost = note_exits(state, walls)
        inside = np.flatnonzero(~is_lost)
        (count,) = self.count(len(inside))
        refuse_none(count)
        if count < self._fluid:
            first = np.concatenate(share(self._communicator, first_of(state, is_lost).ravel()))
            book(state, self.count(*lost_by_face(state, is_lost)), first.reshape(-1, 5))
        self._fluid = count
        keys = self._keys.fluid[inside]
        fluid = taken(fluid, inside)
        grid = grid_of_all(self._communicator, fluid["position_density"], reach)
        weights = self._work.weights(len(keys))
        self._keys.fluid, columns, cuts = sort_by_cell(
            self._communicator, grid, fluid["position_density"], keys, weights, [*fluid.values()]
        )
        fluid = dict(zip(fluid, columns, strict=True))
        place = self._order.sort(grid)
        looking = boundary["mirror_point" if self._mirrored else "position_density"]
        owner = owners(cuts, cells_around(looking, grid))
        self._keys.boundary, (self._number, *boundary_arrays) = migrate(
            self._communicator, owner, place[self._number], (self._number, *boundary.values())
        )
        put(state, fluid, dict(zip(boundary, boundary_arrays, strict=True)))
        state.reference, state.moved = places(state), 0.0

    def _share_out(self, state: State) -> None:
        """Keep but a part of a state of which every rank has all."""
        rank, size = self._communicator.rank, self._communicator.size
        fluid, boundary = state.fluid, state.particles - state.fluid
        self._fluid, self._mirrored = fluid, len(state.mirror_point) > 0
        self._order = BoundaryOrder(state.position_density[fluid:], state.sample)
        keys = self._keys
        keys.fluid = np.arange(rank * fluid // size, (rank + 1) * fluid // size)
        keys.boundary = np.arange(rank * boundary // size, (rank + 1) * boundary // size)
        self._number = keys.boundary.copy()
        if len(state.reference):
            mirrors = fluid + boundary + keys.boundary[: len(state.mirror_point)]
            rows = np.concatenate([keys.fluid, fluid + keys.boundary, mirrors])
            state.reference = state.reference.take(rows, axis=0)
        columns = boundary_columns(state, self._mirrored)
        put(state, taken(fluid_columns(state), keys.fluid), taken(columns, keys.boundary))
        self._shared = True

    def join(self, static: Fields) -> None:
        """Refuse samples under the contact potential, whose stiffness is that of whole bodies."""
        if np.any(static.get("surface.contact", 0.0)):
            raise SceneError(
                "links: the contact potential must be chosen for no samples of a fluid on "
                f"{self._communicator.size} ranks; a link chooses it. Leave it out, or take one "
                "rank."
            )

    def follow_samples(self, fields: Fields, first: int = 0) -> None:
        """Note where the samples from the first one on were placed."""
        if self._shared:
            self._order.follow(fields["surface.position"], first)

    def load(self, state: State) -> None:
        """Keep a part of a state of all rows, if it has lists; else all until they are made."""
        self._shared = False
        if len(state.reference):
            self._share_out(state)

    def fluid(self, state: State) -> int:
        """Number of fluid particles of all ranks."""
        return self._fluid if self._shared else state.fluid

    def boundary(self, state: State) -> int:
        """Number of wall and sample particles of all ranks."""
        return len(self._order) if self._shared else state.particles - state.fluid

    def greatest(self, *numbers: float) -> tuple[float, ...]:
        """Largest of all ranks of each number."""
        return tuple(greatest(self._communicator, np.array(numbers, float)).tolist())

    def count(self, *numbers: int) -> tuple[int, ...]:
        """Sum over all ranks of each number of rows."""
        if not self._shared:
            return numbers
        return tuple(counted(self._communicator, np.array(numbers)).tolist())

    def sums(self, state: State, columns: Sequence[Array]) -> Array:
        """Sums (k,) of columns (fluid,) over the fluid of all ranks; they have no order."""
        largest = greatest(self._communicator, bounds(columns))
        parts = sum_parts(columns, largest, self.fluid(state))
        return total(added(self._communicator, parts) if self._shared else parts)

    def gather_forces(self, state: State, number: Whole) -> None:
        """Bring the forces on all samples to rank 0; `number` (k,) are those of this rank."""
        force = collect(self._communicator, state.force.take(number, axis=0))
        numbers = collect(self._communicator, number)
        if self._communicator.rank == 0:
            state.force[numbers] = force

    def boundary_keys(self, state: State) -> Whole:
        """Numbers (boundary,) that rise in the order in which one rank would have its rows."""
        return self._keys.boundary

    def all_rows(self, keys: Whole, rows: Array) -> Array:
        """Rows of all ranks on every rank, in the order of their keys; own ones (k, ...)."""
        if not self._shared:
            return rows
        order = np.argsort(np.concatenate(share(self._communicator, keys)))
        of_all = np.concatenate(share(self._communicator, rows.reshape(-1)))
        return of_all.reshape(-1, *rows.shape[1:])[order]

    def whole(self, state: State) -> State:
        """All rows on rank 0; on others their own."""
        if not self._shared:
            return state
        fluid, boundary = fluid_columns(state), boundary_columns(state, self._mirrored)
        split, end = state.fluid, state.particles
        reference = state.reference
        fluid["reference"], boundary["reference"] = reference[:split], reference[split:end]
        if self._mirrored:
            boundary["mirror_reference"] = reference[end:]
        fluid, boundary = self._collected(fluid, boundary)
        if self._communicator.rank:
            return state
        parts = [columns.pop("reference") for columns in (fluid, boundary)]
        parts += [boundary.pop("mirror_reference")] if self._mirrored else []
        whole = State.load(state.save())
        put(whole, fluid, boundary)
        whole.reference = np.concatenate(parts)
        return whole

    def _collected(self, *groups: dict[str, Array]) -> list[dict[str, Array]]:
        """Columns of the fluid and of the boundary of all ranks on rank 0, in order."""
        of_all = []
        for keys, columns in zip((self._keys.fluid, self._keys.boundary), groups, strict=True):
            order = np.argsort(collect(self._communicator, keys), kind="stable")
            parts = {name: collect(self._communicator, part) for name, part in columns.items()}
            of_all.append({name: part.take(order, axis=0) for name, part in parts.items()})
        return of_all

    def owners(self, state: State) -> Fields:
        """Rank of each particle, in the order of birth; 0 before they are shared out."""
        ranks = np.full(state.fluid, float(self.rank if self._shared else 0))
        return {RANK.name: self.all_rows(state.identity, ranks)}

    def owner(self, state: State, identity: int) -> str:
        """Name the rank that owns a particle, which rank 0 chooses; "" before they are shared."""
        return (
            owner_of(self._communicator, state.identity[: state.fluid], identity)
            if self._shared
            else ""
        )

    def near(self, state: State, is_near: Callable[[Array], NDArray[np.bool_]]) -> NearRows:
        """Rows of all ranks that are near, on rank 0; on others none."""
        rows = np.flatnonzero(is_near(state.position_density[: state.particles]))
        position = state.position_density.take(rows, 0)
        velocity = state.velocity_pressure.take(rows, 0)
        if not self._shared:
            return NearRows(position, velocity, int((rows < state.fluid).sum()))
        keys = np.concatenate([self._keys.fluid, self._keys.boundary])[rows]
        keys += np.where(rows < state.fluid, np.int64(-1) << 62, 0)  # the fluid first
        keys = collect(self._communicator, keys)
        position, velocity = (collect(self._communicator, part) for part in (position, velocity))
        order = np.argsort(keys, kind="stable")
        return NearRows(position[order], velocity[order], int((keys < 0).sum()))
