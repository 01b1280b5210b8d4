"""Which points are whose, from the start to the end of a run."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from quintet.components.particle_dynamics.ranks.layout import Layout
from quintet.components.particle_dynamics.state import (
    BATHED,
    NO_DRIVE,
    POINTS,
    Driven,
    Model,
    Whole,
)
from quintet.components.shared.domain.bisection import bisect
from quintet.components.shared.domain.collection import Collection
from quintet.components.shared.domain.waiting import wait_for_all
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import SceneError


class Shares:
    """The points of this rank, and all points of all ranks on rank 0.

    Parameters
    ----------
    communicator : mpi4py communicator
    model : Model
        Of all points.
    bonds : (b, 2) int array
        All pairs of nearest points.
    cells : (n, 3) int array
        Places of the points on their lattice.

    Raises
    ------
    SceneError
        If there are fewer points than ranks.
    """

    def __init__(self, communicator: Any, model: Model, bonds: Whole, cells: Whole) -> None:
        self._communicator, self._model, self.count = communicator, model, len(cells)
        owner, rank = owners(cells, model.driven, communicator.size), communicator.rank
        self.ids = np.flatnonzero(owner == rank)
        self.bathed = np.flatnonzero(owner[model.bathed.point] == rank)
        self.bonds = bonds[owner[bonds[:, 0]] == rank].astype(np.int32)  # half the memory
        self._drives = int(owner[max(model.driven.first, 0)])  # the rank that owns the driven pair
        self._points = Collection(communicator, self.ids)
        self._baths = Collection(communicator, self.bathed)

    def owned(self, state: Fields) -> dict[str, Array]:
        """Rows of this rank, of arrays of all points or of what `saved` returned here."""
        if len(state["position"]) != self.count:
            return dict(state)
        owned = dict(state)
        owned |= {name: state[name][self.ids] for name in POINTS if len(state[name])}
        return owned | {name: state[name][self.bathed] for name in BATHED}

    def gather(self, name: str, rows: Array) -> Array:
        """All rows of an array of the state on rank 0, zeros on others; not to be changed."""
        whole = self.saved(name, rows)
        if self._communicator.rank == 0 or name not in (*POINTS, *BATHED):
            return whole
        count = self.count if name in POINTS else len(self._model.bathed.point)
        return np.broadcast_to(np.zeros((), rows.dtype), (count, *rows.shape[1:]))

    def give(self, rows: Sequence[Array]) -> Sequence[Array]:
        """Rows of all points on rank 0, of arrays (k, *shape) of the points of each rank."""
        return self._points.give(rows)

    def saved(self, name: str, rows: Array) -> Array:
        """All rows of an array of the state on rank 0, those of this rank on others."""
        if name in POINTS:  # those of a damping that is absent have no rows
            return self._points.gather(rows) if len(rows) else rows
        if name in BATHED:
            return self._baths.gather(rows)
        if name == "energies":
            rows = rows.copy()
            wait_for_all(self._communicator.Ibcast(rows, self._drives))
        return rows

    def model_of(self, layout: Layout) -> Model:
        """Model of a rank's rows: copies of others' points are held as if they were frozen."""
        model, bathed, driven = self._model, self._model.bathed, self._model.driven
        here, count = self.bathed, len(bathed.point)
        frozen = layout.rows(np.intersect1d(model.frozen, self.ids))
        if self._drives == self._communicator.rank and driven.first >= 0:
            first, second = layout.rows(np.array([driven.first, driven.second])).tolist()
            driven = driven._replace(first=first, second=second)
        else:
            driven = NO_DRIVE
        return model._replace(
            frozen=np.concatenate([frozen, layout.copies]),
            driven=driven,
            bathed=bathed._replace(
                point=layout.rows(bathed.point[here]),
                bath=bathed.bath[here],
                rate=bathed.rate[here],
                tether=bathed.tether[here],
                rest=bathed.rest[here],
                passed=np.diff(np.concatenate([[-1], here, [count]])) - 1,
            ),
        )


def owners(cells: Whole, driven: Driven, ranks: int) -> Whole:
    """Rank (n,) of each point: as many for each, near each other; a driven pair is on one."""
    owner = bisect(cells, np.ones(len(cells)), ranks)
    if driven.first >= 0:
        owner[driven.second] = owner[driven.first]
    if len(np.unique(owner)) < ranks:
        raise SceneError(
            f"ranks: each must have a point; {ranks} ranks are too many for {len(cells)} points. "
            "Take fewer."
        )
    return owner
