"""Points shared out among several ranks."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from quintet.components.particle_dynamics.build import Built
from quintet.components.particle_dynamics.kernels.forces import (
    Pairs,
    count_intact,
    count_near,
    write_energies,
)
from quintet.components.particle_dynamics.kernels.motion import (
    EARLY,
    close_stage,
    collide_once,
    open_stage,
    place,
)
from quintet.components.particle_dynamics.kernels.shares import (
    accelerate_now,
    depart,
    hold_pair,
    measure,
)
from quintet.components.particle_dynamics.neighbours import SKIN
from quintet.components.particle_dynamics.ranks.layout import Layout, lay_out
from quintet.components.particle_dynamics.ranks.shares import Shares
from quintet.components.particle_dynamics.ranks.terms import Terms
from quintet.components.particle_dynamics.state import POINTS, TIME, Model, State, Whole
from quintet.components.shared.domain.extremes import counted, greatest, least
from quintet.components.shared.domain.halo import Halo
from quintet.components.shared.domain.replication import Replication
from quintet.components.shared.search.verlet_list import furthest, slack
from quintet.interfaces.component import Array, Fields


class SeveralRanks:
    """Steps the points of this rank; every method is called on all ranks in the same order.

    Parameters
    ----------
    communicator : mpi4py communicator
    state : State
        Of all points, as it starts.
    model : Model
    terms : Terms
    cells : (n, 3) int array
        Places of the points on their lattice.
    """

    def __init__(
        self, communicator: Any, state: State, model: Model, terms: Terms, cells: Whole
    ) -> None:
        self._communicator = communicator
        self._shares = Shares(communicator, model, terms.bonds, cells)
        self._bonds_of_all = len(terms.bonds)
        self.terms = terms = terms._replace(bonds=self._shares.bonds)
        self.bathed, self.ids = self._shares.bathed, self._shares.ids
        self._all = Replication(communicator, self._shares.ids, 3) if model.collision_rate else None
        cutoff = math.sqrt(terms.law.cutoff2)
        self.skin = SKIN * cutoff  # m
        self._reach = cutoff + self.skin  # m
        self._lay_out(self._shares.owned(state._asdict()))
        hold_pair(self.model, self.state)
        self._predicted[:] = self.state.velocity
        self._halo.exchange(*self._copied)
        law, damping, period = terms.law, terms.damping, terms.period
        pairs = self._layout.pairs
        accelerate_now(self.model, self.state, self._predicted, pairs, law, damping, period)

    def _lay_out(self, owned: Fields) -> None:
        """Make lists and halo around this rank's points, from its rows of the state."""
        terms, ids = self.terms, self._shares.ids
        self._layout: Layout = lay_out(
            self._communicator, ids, owned["listed"], self._reach, terms.lowest, terms.period
        )
        rows = {name: self._layout.spread(owned[name]) for name in POINTS if len(owned[name])}
        rows["listed"] = self._layout.listed
        self.state = State(**{**{name: array.copy() for name, array in owned.items()}, **rows})
        self.model = self._shares.model_of(self._layout)
        # Copies keep no velocity of their own, so damped velocities have arrays apart.
        velocity = self.state.velocity
        self._predicted = velocity if terms.damping is None else np.zeros_like(velocity)
        self._copied = (self.state.position, self._predicted)[: 1 + (terms.damping is not None)]
        widths = [3 for _ in self._copied]
        self._halo = Halo(self._communicator, self._layout.sent, self._layout.received, widths)
        self._moved = self._greatest(furthest(owned["position"], owned["listed"]))

    def _rows_of_bonds(self) -> Whole:
        """Rows (b, 2) of the bonds of this rank; those whose second point is far are broken."""
        bonds, ids = self.terms.bonds, self._layout.ids
        second = np.minimum(np.searchsorted(ids, bonds[:, 1]), len(ids) - 1)
        rows = np.column_stack([self._layout.rows(bonds[:, 0]), second])
        return rows[ids[second] == bonds[:, 1]]

    def _own(self, name: str) -> Array:
        """Rows of this rank's points, or what the state has of it."""
        array: Array = getattr(self.state, name)
        return array[self._layout.owned] if name in POINTS and len(array) else array

    @property
    def owned(self) -> Whole | slice:
        """Rows of this rank's points."""
        return self._layout.owned

    @property
    def copies(self) -> Whole:
        """Rows of copies of other ranks' points."""
        return self._layout.copies

    @property
    def pairs(self) -> Pairs:
        """Listed pairs, by rows."""
        return self._layout.pairs

    @property
    def exchanged(self) -> tuple[list[Whole], list[Whole]]:
        """For each rank, the rows that it gets, and those that it fills."""
        return self._layout.sent, self._layout.received

    def read(self, *names: str) -> State:
        """State of this rank's points with some arrays as they are now, by default all."""
        return self.state

    def reduced(self, built: Built) -> Built:
        """What the lattice was built of, as far as this rank needs it."""
        nothing = built.start[:0].copy()
        return built._replace(start=nothing, bonds=self.terms.bonds)

    def advance(self, steps: int, dt: float) -> int:
        """Advance until all steps are done or lists must be made; -1 if points moved too far."""
        terms, stages = self.terms, (self.model.stages * dt).tolist()
        for step in range(steps):
            for h in stages:
                self._make_stage(h)
            weight = dt if self.state.energies[TIME] > terms.averaged_from else 0.0
            mass, owned = self.model.mass, self._layout.owned
            squares, moved = measure(weight, mass, owned, self.state)
            self._moved = self._greatest(math.sqrt(moved) if math.isfinite(squares) else math.inf)
            if not slack(self.skin, self._moved) > 0.0:
                return -1
            if self.needs_lists():
                return step + 1
        return steps

    def _greatest(self, number: float) -> float:
        return float(greatest(self._communicator, np.array([number]))[0])

    def _make_stage(self, h: float) -> None:
        terms, model, state, predicted = self.terms, self.model, self.state, self._predicted
        is_damped = terms.damping is not None
        if self._all is None:
            depart(h, terms.boltzmann, model, state, predicted, is_damped)
        else:
            open_stage(h, terms.boltzmann, model, state)
            # Each collision changes what the next one turns: every rank computes all of them.
            velocity = self._all.gather(state.velocity[self._layout.owned])
            collide_once(h, model, velocity, state.generator)
            state.velocity[self._layout.owned] = velocity[self._shares.ids]
            place(h, model, state, predicted, is_damped)
        self._halo.exchange(*self._copied)
        pairs = self._layout.pairs
        close_stage(h, model, state, predicted, pairs, terms.law, terms.damping, terms.period)

    def average_from(self, time: float) -> None:
        """Average kinetic energies from a time [s] on."""
        self.terms = self.terms._replace(averaged_from=time)

    def needs_lists(self) -> bool:
        """Whether points that are not listed may interact soon."""
        return slack(EARLY * self.skin, self._moved) < 0.0

    def make_lists(self) -> None:
        """List the pairs of the points where they are now."""
        owned = {name: self._own(name) for name in State._fields}
        self._lay_out(owned | {"listed": owned["position"]})

    def all(self, name: str) -> Array:
        """Rows of all ranks of an array of the state, on rank 0; not to be changed."""
        return self._shares.gather(name, self._own(name))

    def give(self, *names: str) -> Sequence[Array]:
        """Copies of the rows of all points, on rank 0, of some arrays of the state."""
        return self._shares.give([self._own(name) for name in names])

    def _refresh(self) -> None:
        """Bring copies to where their points are: those of a driven pair are set after forces."""
        self._halo.exchange(*self._copied)

    def pair_energies(self) -> Array:
        """Potential energy (n,) J of the pairs that are listed for each point, on rank 0."""
        self._refresh()
        position, terms = self.state.position, self.terms
        energies = np.empty(len(position))
        write_energies(position, self._layout.pairs, terms.law, terms.period, energies)
        return self._shares.gather("kinetic", energies[self._layout.owned])

    def tether_energies(self) -> Array:
        """Twice the potential energy (b,) J of the tether of each bathed point, on rank 0."""
        bathed = self.model.bathed
        away = ((self.state.position[bathed.point] - bathed.rest) ** 2).sum(axis=1)
        return self._shares.gather("heat", bathed.tether * away)

    def least_near(self) -> tuple[int, int]:
        """Fewest points within the cut-off of a point, and the first point that has so few."""
        self._refresh()
        terms, near = self.terms, np.empty(len(self.state.position), np.int64)
        pairs = self._layout.pairs
        count_near(self.state.position, pairs, terms.law.cutoff2, terms.period, near)
        fewest, point = self._first_least(near[self._layout.owned])
        return int(fewest), point

    def _first_least(self, values: Array) -> tuple[float, int]:
        """Least value (k,) of this rank's points and of all others, and the first such point."""
        smallest = least(self._communicator, values.min(keepdims=True))
        points = self._shares.ids[values == smallest]
        first = np.append(points, self._shares.count)[:1]
        return float(smallest[0]), int(least(self._communicator, first)[0])

    def intact(self) -> float:
        """Share of the bonds between nearest points that have 0.8 to 1.2 spacings."""
        self._refresh()
        terms, position = self.terms, self.state.position
        here = count_intact(position, self._rows_of_bonds(), terms.spacing, terms.period)
        count = counted(self._communicator, np.array([here]))[0]
        return float(count / max(self._bonds_of_all, 1))

    def furthest(self) -> int:
        """The point that has moved furthest since lists were made, or is nowhere."""
        moved = ((self._own("position") - self._own("listed")) ** 2).sum(axis=1)
        return self._first_least(-np.where(np.isfinite(moved), moved, np.inf))[1]

    def save(self) -> dict[str, Array]:
        """Copy out all arrays of the state: of all points on rank 0, of its own on others."""
        return {name: self._shares.saved(name, self._own(name)).copy() for name in State._fields}

    def load(self, state: Fields) -> None:
        """Restore what was saved, by as many ranks or others."""
        self._lay_out(self._shares.owned({name: state[name] for name in State._fields}))
