"""Rows of bodies as a rank has them: its own and copies that its pairs need, or those of all."""

from typing import Any

import numpy as np

from quintet.components.dem_bodies.ranks.shares import Shares
from quintet.components.dem_bodies.ranks.sparse import SparseArrays
from quintet.components.dem_bodies.state import MOVED, Model, State, Whole
from quintet.components.shared.domain.exchange import send_rows
from quintet.interfaces.component import Array, Fields

OF_ALL = ("body", "row", "report")  # that every rank has whole
# Arrays of the model that the kind of a ball determines, and arrays that only other bodies need.
OF_KINDS = (
    "inverse_mass", "inverse_inertia", "inverse_moment", "bounding_radius", "material", "kind",
    "sphere_radius",
)  # fmt: skip
UNUSED = (
    "inertia", "free", "half_extent", "edge_radius", "body_contact_radius", "half_thickness",
    "sphere_begin", "sphere_row", "sphere_centre", "contact_radius", "edge_begin",
)  # fmt: skip


class RowsOfRank:
    """Model and state of the rows of a rank.

    Parameters
    ----------
    model, state
        Of all rows, in their order at the start.
    kind : (m,) int array
        Kind of each body.
    shares : Shares
    """

    def __init__(self, model: Model, state: State, kind: Whole, shares: Shares) -> None:
        self.shares, self.kind, self.sparse = shares, kind, SparseArrays()
        # Contacts of other bodies are computed on every rank, which then needs all balls.
        self.are_all = len(model.others) > 0 or len(kind) == 1
        _, first = np.unique(kind, return_index=True)
        rows = state.row[first]
        self.of_kinds = {
            name: getattr(model, name)[rows].copy() for name in OF_KINDS if name != "sphere_radius"
        }
        self.of_kinds["sphere_radius"] = self.of_kinds["bounding_radius"]  # of a ball
        self.largest = float(model.bounding_radius[model.ball[:-1]].max())  # m, of the balls
        self.model, self.state = model, state
        if not self.are_all:
            self.model, self.state = self._own_model(model), self._own_state(state)

    @property
    def owned(self) -> slice:
        """Rows of this rank."""
        return self.shares.rows_of(self.shares.rank)

    @property
    def owned_balls(self) -> slice:
        """The balls among them."""
        return slice(
            self.owned.start, max(self.owned.start, min(self.owned.stop, self.shares.balls))
        )

    def _own_model(self, model: Model) -> Model:
        some = {name: self._like(getattr(model, name)) for name in OF_KINDS + UNUSED}
        for name in OF_KINDS:
            some[name][self.owned] = getattr(model, name)[self.owned]
        return model._replace(**some)

    def _own_state(self, state: State) -> State:
        some = {name: self._like(getattr(state, name)) for name in state._fields}
        some |= {name: getattr(state, name) for name in OF_ALL}
        for name in (*MOVED, "centre", "listed_centre"):
            some[name][self.owned] = getattr(state, name)[self.owned]
        # What of a ball is not kept up: axes of the world, and the momentum of the start.
        turning = state.angular_momentum.any(axis=1)
        some["angular_momentum"][turning] = state.angular_momentum[turning]
        return State(**some)

    def _like(self, array: Array) -> Array:
        return self.sparse.zeros(array.shape, array.dtype)

    def move(self, order: Whole, before: Whole) -> None:
        """Put the balls in a new order, and send rows to the ranks that own them now.

        Parameters
        ----------
        order : (b,) int array
            Present rows of the balls, in the new order.
        before : (size + 1,) int array
            Where the present rows of each rank begin and end; the new ones are in `shares`.
        """
        state, shares, rank, balls = self.state, self.shares, self.shares.rank, len(order)
        row = np.empty_like(order)
        row[order] = np.arange(balls)
        ends = np.minimum(before, balls)
        owner = shares.owners(row[ends[rank] : ends[rank + 1]])
        leaving = [ends[rank] + np.flatnonzero(owner == other) for other in range(shares.size)]
        arrays = [getattr(state, name) for name in MOVED]
        packed = [np.concatenate([array[rows] for array in arrays], axis=1) for rows in leaving]
        arrived = send_rows(shares.communicator, packed)
        for other, rows in enumerate(arrived):
            to = row[ends[other] : ends[other + 1]]
            to = to[shares.owners(to) == rank]
            parts = np.split(rows, np.cumsum(list(MOVED.values()))[:-1], axis=1)
            for array, part in zip(arrays, parts, strict=True):
                array[to] = part
        state.body[:balls] = state.body[order]
        state.row[state.body] = np.arange(len(state.body))
        if self.are_all:
            shares.everywhere(state.world_inverse_inertia)

    def exchange_all(self) -> None:
        """Bring the motion of all bodies up to date on every rank."""
        self.shares.everywhere(self.state.motion)
        self.shares.from_last(self.state)
        balls = self.shares.balls
        self.state.centre[:balls] = self.state.motion[:balls, :3]

    def know(self, last: int) -> None:
        """Have numbers of own balls and of those up to row `last` of other ranks."""
        first = 0 if self.are_all else self.owned.start
        last = min(self.shares.balls if self.are_all else last, self.shares.balls)
        kind = self.kind[self.state.body[first:last]]
        for name, of_kinds in self.of_kinds.items():
            getattr(self.model, name)[first:last] = of_kinds[kind]
        self.sparse.keep(first, max(last, self.owned.stop))

    def load(self, saved: Fields) -> None:
        """Restore own rows, or all where they are here, of a saved state."""
        state = self.state
        rows = slice(None) if self.are_all else self.owned
        for name in state._fields:
            array, of_all = getattr(state, name), np.asarray(saved[name])
            if name in OF_ALL:
                array[:] = of_all
            elif name == "angular_momentum":
                turning = of_all.any(axis=1) | array.any(axis=1)
                array[turning] = of_all[turning]
            elif name != "axes" or self.are_all:
                array[rows] = of_all[rows]

    def whole(self, *names: str) -> tuple[Model, State]:
        """Model and some arrays of the state, or all, of all rows on rank 0."""
        model, state, shares = self.model, self.state, self.shares
        fields: dict[str, Any] = {
            name: shares.gathered(getattr(state, name), name in ("centre", "listed_centre"))
            for name in names or state._fields
            if name not in OF_ALL and (self.are_all or name != "axes")
        }
        if shares.rank:
            return model, state
        if not self.are_all:
            fields["axes"] = np.tile(np.eye(3).reshape(9), (shares.rows, 1))  # of balls
            kind, last = self.kind[state.body[: shares.balls]], shares.balls
            of_all: dict[str, Any] = {name: array[kind] for name, array in self.of_kinds.items()}
            for name in ("inverse_mass", "inverse_inertia", "inverse_moment", "material", "kind"):
                ground = getattr(model, name)[last:]
                of_all[name] = np.concatenate([of_all[name], ground])
            model = model._replace(**of_all)
        return model, state._replace(**fields)
