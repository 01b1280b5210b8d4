"""All nodes on one rank, and what a gas asks of its ranks, be it one or several."""

from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np

from quintet.components.meshless_gas.build import Domain, Rows
from quintet.components.meshless_gas.parts import NodeMotion, Part
from quintet.components.meshless_gas.state import State, conserved
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array


class Ranks(Protocol):
    """The ranks of one gas; of several, each calls every method, in the same order.

    A rank answers for a range of the nodes: it shows them, and sums go over them. It advances
    those of them that are advanced.
    """

    def divide(self, motion: NodeMotion, parts: Sequence[Part], state: State) -> None:
        """Keep only what this rank needs of the domain, of the parts and of the state."""

    def share(self, domain: Domain) -> Domain:
        """Return a domain of which `inner` and `every` are the nodes that this rank computes.

        Of gradients these are its own nodes and all that their fluxes need.
        """

    def room(self, shape: tuple[int, ...]) -> Array:
        """Zeros of a shape, of which this rank may write a part alone."""

    def answered(self, domain: Domain) -> slice:
        """Rows of the nodes that this rank answers for."""

    def shown(self, domain: Domain) -> Rows:
        """Nodes, of `every`, for which this rank computes what a view shows."""

    def around_shown(self, domain: Domain) -> tuple[Rows, Rows | None]:
        """Nodes and ghosts whose gradients a view needs; None: all ghosts."""

    def collect_shown(self, values: Array) -> Array:
        """Collect rows for a view on rank 0; each rank passes the rows that it computed."""

    def collect(self, domain: Domain, array: Array) -> Array:
        """Rows of all nodes, on rank 0, of an array (nodes, *shape); others get their own."""

    def collect_answered(self, values: Array) -> Array:
        """Collect rows of one kind of node on rank 0; each rank passes those of its own nodes."""

    def rows_of(self, array: Array) -> Array:
        """Rows that this rank holds, of an array (n, *shape) of all nodes."""

    def exchange(self, domain: Domain, primitive: Array) -> None:
        """Bring the states (n, 5) that other ranks advanced, where this rank needs them."""

    def exchange_conserved(self, domain: Domain, conservative: Array) -> None:
        """Bring conserved states (n, 5) where this rank needs those of nodes of others."""

    def exchange_boundaries(self, primitive: Array) -> None:
        """Bring the states (n, 5) of boundary nodes that other ranks computed."""

    def conserved(self, domain: Domain, conservative: Array, team: Team) -> Array:
        """Mass, momentum and energy (5,) kg, N s, J of all nodes."""

    def mean(self, domain: Domain, values: Array) -> float:
        """Mean over all nodes that are advanced; each rank gives values (m,) of its own."""

    def total(self, values: Array) -> float:
        """Sum over all nodes that ranks answer for, or over some; each gives values (m,)."""

    def in_turn(self, add: Callable[[Array], None], sums: Array) -> None:
        """Let one rank after another add to sums (k,), of which rank 0 then has the last."""

    def advanced(self, domain: Domain) -> int:
        """How many nodes all ranks advance."""

    def first(self, domain: Domain) -> int:
        """Index of this rank's first node in the list of all nodes that are advanced."""

    def from_owner(self, values: Array) -> Array:
        """Values (k,) that one rank gives to all; others give none."""

    def least(self, number: float) -> float:
        """Smallest number of all ranks."""

    def greatest(self, number: float) -> float:
        """Largest number of all ranks."""


class OneRank:
    """A gas whose nodes are all computed here."""

    def divide(self, motion: NodeMotion, parts: Sequence[Part], state: State) -> None:
        """Keep all."""

    def share(self, domain: Domain) -> Domain:
        """Return the domain."""
        return domain

    def room(self, shape: tuple[int, ...]) -> Array:
        """Zeros of a shape."""
        return np.zeros(shape)

    def answered(self, domain: Domain) -> slice:
        """Return all."""
        return slice(0, domain.cloud.nodes)

    def shown(self, domain: Domain) -> Rows:
        """Return all."""
        return domain.every

    def around_shown(self, domain: Domain) -> tuple[Rows, Rows | None]:
        """Return all."""
        return domain.every, None

    def collect_shown(self, values: Array) -> Array:
        """Return them."""
        return values

    def collect(self, domain: Domain, array: Array) -> Array:
        """Return the array."""
        return array

    def collect_answered(self, values: Array) -> Array:
        """Return them."""
        return values

    def rows_of(self, array: Array) -> Array:
        """Return the array."""
        return array

    def exchange(self, domain: Domain, primitive: Array) -> None:
        """Nothing to do: all states are here."""

    def exchange_conserved(self, domain: Domain, conservative: Array) -> None:
        """Nothing to do: all states are here."""

    def exchange_boundaries(self, primitive: Array) -> None:
        """Nothing to do: all states are computed here."""

    def conserved(self, domain: Domain, conservative: Array, team: Team) -> Array:
        """Mass, momentum and energy (5,) kg, N s, J of all nodes."""
        return conserved(conservative, domain.cloud.volumes, team)

    def mean(self, domain: Domain, values: Array) -> float:
        """Mean of values (m,)."""
        return float(values.mean())

    def total(self, values: Array) -> float:
        """Sum of values (m,)."""
        return float(values.sum())

    def in_turn(self, add: Callable[[Array], None], sums: Array) -> None:
        """Add to sums (k,)."""
        add(sums)

    def advanced(self, domain: Domain) -> int:
        """How many nodes are advanced."""
        return len(domain.inner)

    def first(self, domain: Domain) -> int:
        """Return the first of all."""
        return 0

    def from_owner(self, values: Array) -> Array:
        """Return the values."""
        return values

    def least(self, number: float) -> float:
        """Return the number."""
        return number

    def greatest(self, number: float) -> float:
        """Return the number."""
        return number
