"""All points on one rank."""

from collections.abc import Sequence

import numpy as np

from quintet.components.particle_dynamics.build import Built
from quintet.components.particle_dynamics.kernels.forces import (
    Pairs,
    count_intact,
    count_near,
    write_energies,
)
from quintet.components.particle_dynamics.kernels.motion import advance, begin
from quintet.components.particle_dynamics.neighbours import Neighbours
from quintet.components.particle_dynamics.ranks.terms import Terms
from quintet.components.particle_dynamics.state import Model, State, Whole
from quintet.interfaces.component import Array, Fields


class OneRank:
    """Steps all points, and answers what holds for all of them.

    Parameters
    ----------
    state : State
        As it starts.
    model : Model
    terms : Terms
    """

    def __init__(self, state: State, model: Model, terms: Terms) -> None:
        self.state, self.model, self.terms = state, model, terms
        self.ids: Whole = np.arange(len(state.position))  # points of this rank
        self.owned: Whole | slice = slice(None)  # their rows
        self.bathed: Whole = np.arange(len(state.heat))  # whose baths are computed here
        self.copies: Whole = np.zeros(0, np.int64)  # rows of other ranks' points
        self.lists = Neighbours(terms.law.cutoff2, terms.lowest, terms.period)
        self.skin = self.lists.skin  # m
        self.lists.rebuild(state.listed)
        begin(model, state, self.lists.pairs, terms.law, terms.damping, terms.period)

    @property
    def pairs(self) -> Pairs:
        """Listed pairs, by rows."""
        return self.lists.pairs

    def read(self, *names: str) -> State:
        """State with some arrays as they are now, by default all."""
        return self.state

    def reduced(self, built: Built) -> Built:
        """What the lattice was built of, as far as this rank needs it."""
        return built

    def advance(self, steps: int, dt: float) -> int:
        """Advance until all steps are done or lists must be made; -1 if points moved too far."""
        terms = self.terms
        return int(
            advance(
                steps, dt, self.skin, terms.averaged_from, terms.boltzmann, self.model, self.state,
                self.lists.pairs, terms.law, terms.damping, terms.period,
            )
        )  # fmt: skip

    def average_from(self, time: float) -> None:
        """Average kinetic energies from a time [s] on."""
        self.terms = self.terms._replace(averaged_from=time)

    def needs_lists(self) -> bool:
        """Whether points that are not listed may interact soon."""
        return self.lists.needs_rebuild(self.state.position, self.state.listed)

    def make_lists(self) -> None:
        """List the pairs of the points where they are now."""
        self.state.listed[:] = self.state.position
        self.lists.rebuild(self.state.listed)

    def all(self, name: str) -> Array:
        """Rows of all ranks of an array of the state; not to be changed."""
        array: Array = getattr(self.state, name)
        return array

    def give(self, *names: str) -> Sequence[Array]:
        """Copies of some arrays of the state."""
        return [self.all(name).copy() for name in names]

    def pair_energies(self) -> Array:
        """Potential energy (n,) J of the pairs that are listed for each point."""
        energies, terms = np.empty(len(self.state.position)), self.terms
        position = self.state.position
        write_energies(position, self.lists.pairs, terms.law, terms.period, energies)
        return energies

    def tether_energies(self) -> Array:
        """Twice the potential energy (b,) J of the tether of each bathed point."""
        bathed = self.model.bathed
        away = ((self.state.position[bathed.point] - bathed.rest) ** 2).sum(axis=1)
        return np.asarray(bathed.tether * away)

    def least_near(self) -> tuple[int, int]:
        """Fewest points within the cut-off of a point, and the first point that has so few."""
        terms, near = self.terms, np.empty(len(self.state.position), np.int64)
        count_near(self.state.position, self.lists.pairs, terms.law.cutoff2, terms.period, near)
        return int(near.min()), int(np.argmin(near))

    def intact(self) -> float:
        """Share of the bonds between nearest points that have 0.8 to 1.2 spacings."""
        terms = self.terms
        count = count_intact(self.state.position, terms.bonds, terms.spacing, terms.period)
        return float(count / max(len(terms.bonds), 1))

    def furthest(self) -> int:
        """The point that has moved furthest since lists were made, or is nowhere."""
        moved = ((self.state.position - self.state.listed) ** 2).sum(axis=1)
        return int(np.argmax(np.where(np.isfinite(moved), moved, np.inf)))

    def save(self) -> dict[str, Array]:
        """Copy out all arrays of the state."""
        return {name: array.copy() for name, array in self.state._asdict().items()}

    def load(self, state: Fields) -> None:
        """Restore what was saved."""
        for name, array in self.state._asdict().items():
            array[:] = state[name]
        self.lists.rebuild(self.state.listed)
