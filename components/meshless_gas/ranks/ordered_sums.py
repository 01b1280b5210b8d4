"""Sums over rows of several ranks in the order in which numpy sums those of one.

Numpy halves a long row of numbers until blocks are short, and adds the sums of halves (Higham, SIAM
J. Sci. Comput. 14 (1993) 783). A rank sums what lies within its rows; numbers of a block that
lies on several ranks are sent.
"""

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from quintet.components.shared.domain.exchange import share
from quintet.interfaces.component import Array

BLOCK = 128  # numbers that are no longer halved
UNROLLED = 8  # a half is a multiple of it


class Piece(NamedTuple):
    """Rows that are summed at once: on one rank, or a block of several."""

    begin: int
    end: int
    is_of_one: bool


def ordered_sums(communicator: Any, columns: Sequence[Array], counts: Sequence[int]) -> Array:
    """Sums (w,) over the rows of all ranks, on every rank: each as numpy's of one array.

    Parameters
    ----------
    communicator : mpi4py communicator
    columns : sequence of w (m,) float arrays
        Numbers of this rank.
    counts : sequence of int
        Rows of each rank, one rank after another.
    """
    cuts = [0, *np.cumsum(counts).tolist()]
    pieces = list(_pieces(0, cuts[-1], cuts))
    first, last = cuts[communicator.rank : communicator.rank + 2]
    touched = [piece for piece in pieces if piece.begin < last and piece.end > first]
    sent = [_numbers(column, piece, first) for column in columns for piece in touched]
    received = [iter(part) for part in share(communicator, np.concatenate([np.zeros(0), *sent]))]
    return np.array([_total(0, cuts[-1], cuts, received) for _ in columns])


def _numbers(column: Array, piece: Piece, first: int) -> Array:
    """What a rank sends of a piece: its sum, or its numbers."""
    numbers = column[max(piece.begin - first, 0) : piece.end - first]
    return np.array([numbers.sum()]) if piece.is_of_one else numbers


def _pieces(begin: int, end: int, cuts: Sequence[int]) -> Iterator[Piece]:
    """Pieces of a range of rows, in order."""
    is_of_one = end <= cuts[bisect_right(cuts, begin)]
    if is_of_one or end - begin <= BLOCK:
        yield Piece(begin, end, is_of_one)
        return
    middle = _middle(begin, end)
    yield from _pieces(begin, middle, cuts)
    yield from _pieces(middle, end, cuts)


def _middle(begin: int, end: int) -> int:
    """Where numpy halves a range of rows."""
    half = (end - begin) // 2
    return begin + half - half % UNROLLED


def _total(begin: int, end: int, cuts: Sequence[int], received: Sequence[Iterator[float]]) -> float:
    """Sum over a range of rows, from what each rank has sent."""
    after = bisect_right(cuts, begin)
    if end <= cuts[after]:
        return float(next(received[after - 1]))
    if end - begin > BLOCK:
        middle = _middle(begin, end)
        return _total(begin, middle, cuts, received) + _total(middle, end, cuts, received)
    owners = (bisect_right(cuts, row) - 1 for row in range(begin, end))
    return float(np.array([next(received[rank]) for rank in owners]).sum())
