"""All nodes on one rank, and what a gas asks of its ranks, be it one or several."""

from typing import Protocol

import numpy as np

from quintet.components.meshless_gas.build import Domain, Rows
from quintet.interfaces.component import Array


class Ranks(Protocol):
    """The ranks of one gas; of several, each calls every method, in the same order."""

    def share(self, domain: Domain) -> Domain:
        """Return a domain of which `inner` and `every` are the nodes that this rank computes.

        Of gradients these are its own nodes and all that their fluxes need.
        """

    def room(self, shape: tuple[int, ...]) -> Array:
        """Zeros of a shape, of which this rank may write a part alone."""

    def divide(self, domain: Domain) -> Domain:
        """Return the domain with only the stencils that this rank needs."""

    def shown(self, domain: Domain) -> Rows:
        """Nodes, of `every`, for which this rank computes what a view shows."""

    def gather_shown(self, domain: Domain, array: Array) -> None:
        """Bring rows of an array (n, width), from the ranks that compute them for a view."""

    def gather(self, domain: Domain, *arrays: Array) -> None:
        """Bring rows of nodes that are advanced, of arrays (n, 5), from the rank that did it."""

    def gather_values(self, domain: Domain, values: Array) -> None:
        """Bring values (m,) of the nodes that are advanced, those of this rank in their places."""

    def first(self, domain: Domain) -> int:
        """Place of this rank's first node among those that are advanced."""

    def least(self, number: float) -> float:
        """Smallest number of all ranks."""

    def greatest(self, number: float) -> float:
        """Largest number of all ranks."""


class OneRank:
    """A gas whose nodes are all computed here."""

    def share(self, domain: Domain) -> Domain:
        """Return the domain."""
        return domain

    def room(self, shape: tuple[int, ...]) -> Array:
        """Zeros of a shape."""
        return np.zeros(shape)

    def divide(self, domain: Domain) -> Domain:
        """Return the domain."""
        return domain

    def shown(self, domain: Domain) -> Rows:
        """Return all."""
        return domain.every

    def gather_shown(self, domain: Domain, array: Array) -> None:
        """Nothing to do: all rows are here."""

    def gather(self, domain: Domain, *arrays: Array) -> None:
        """Nothing to do: all rows are here."""

    def gather_values(self, domain: Domain, values: Array) -> None:
        """Nothing to do: all values are here."""

    def first(self, domain: Domain) -> int:
        """Return the first of all."""
        return 0

    def least(self, number: float) -> float:
        """Return the number."""
        return number

    def greatest(self, number: float) -> float:
        """Return the number."""
        return number
