"""What several ranks do alike, however they share nodes out."""

from abc import ABC, abstractmethod
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from quintet.components.meshless_gas.build import Domain, Rows
from quintet.components.meshless_gas.ranks.one import OneRank
from quintet.components.meshless_gas.ranks.part_stencils import unwritten
from quintet.components.shared.domain.collection import collect
from quintet.components.shared.domain.exchange import share
from quintet.components.shared.domain.extremes import greatest, least
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError


class Exchanged(NamedTuple):
    """Rows of one rank whose states are exchanged."""

    sent: Rows  # (k,) that others need
    received: Rows  # (m,) that others compute


class SeveralRanks(OneRank, ABC):
    """Ranks that own about as many of the nodes that are advanced, one after another.

    Parameters
    ----------
    communicator : mpi4py communicator
    grain : int
        Ranks own whole multiples of so many of these nodes, but for the last of them.
    """

    def __init__(self, communicator: Any, grain: int = 1) -> None:
        self._communicator, self._grain = communicator, grain

    @abstractmethod
    def exchanged(self, domain: Domain) -> Exchanged:
        """Rows that `exchange` brings."""

    @abstractmethod
    def exchanged_boundaries(self) -> Exchanged:
        """Rows that `exchange_boundaries` brings."""

    def room(self, shape: tuple[int, ...]) -> Array:
        """Zeros of a shape, of which rows that are not written take no memory."""
        return unwritten(shape, np.float64)

    def collect_shown(self, values: Array) -> Array:
        """Collect rows for a view on rank 0; each rank passes the rows that it computed."""
        return collect(self._communicator, values)

    def from_owner(self, values: Array) -> Array:
        """Values (k,) that one rank gives to all; others give none."""
        return np.concatenate(share(self._communicator, values))

    def least(self, number: float) -> float:
        """Smallest number of all ranks."""
        return float(least(self._communicator, np.array([number]))[0])

    def greatest(self, number: float) -> float:
        """Largest number of all ranks."""
        return float(greatest(self._communicator, np.array([number]))[0])


def part_of(count: int, rank: int, size: int, grain: int = 1) -> tuple[int, int]:
    """First and last place of a rank's nodes among as many as are advanced; see `SeveralRanks`.

    Raises
    ------
    SceneError
        If there are fewer nodes than ranks.
    """
    if count < size * grain:
        owned = "a node that is" if grain == 1 else f"{grain} nodes that are"
        raise SceneError(
            f"ranks: each must own {owned} advanced; there are {count} for {size} ranks. "
            "Take fewer ranks."
        )
    first, last = (
        number * count // size // grain * grain if number < size else count
        for number in (rank, rank + 1)
    )
    return first, last


def shown_parts(domain: Domain, size: int, grain: int = 1) -> list[tuple[int, int]]:
    """First and last place of each rank's nodes among all; boundary nodes go with others."""
    begins = [part_of(len(domain.inner), rank, size, grain)[0] for rank in range(1, size)]
    starts: Rows = np.append(domain.inner, len(domain.cloud.positions))[begins]
    cuts = [0, *np.searchsorted(domain.every, starts).tolist(), len(domain.every)]
    return list(pairwise(cuts))
