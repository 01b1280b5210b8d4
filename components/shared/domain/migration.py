"""Rows that move to the rank that owns them now."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.domain.exchange import send_rows
from quintet.interfaces.component import Array

Whole = NDArray[np.int64]


def migrate(
    communicator: Any, owner: Whole, ids: Whole, arrays: tuple[Array, ...]
) -> tuple[Whole, tuple[Array, ...]]:
    """Send rows to their owners; return the ids and the arrays of what this rank owns.

    Parameters
    ----------
    communicator : mpi4py communicator
    owner : (k,) int array
        Rank that owns each row from now on.
    ids : (k,) int array
        Persistent ids of the rows.
    arrays : tuple of (k, *shape) arrays
        Of 8-byte numbers, float64, int64 or uint64; the same ones on every rank.

    Returns
    -------
    (m,) int array
        Ids, rising.
    tuple of (m, *shape) arrays
        In the same order, bit for bit.
    """
    first, *others = move(communicator, owner, (ids, *arrays))
    order = np.argsort(first, kind="stable")  # two sorted runs where ids rose
    return first[order], tuple(array.take(order, axis=0) for array in others)


def move(communicator: Any, owner: Whole, arrays: Sequence[NDArray[Any]]) -> list[NDArray[Any]]:
    """Send rows to their owners; return those that stay here, then those that arrived.

    Parameters
    ----------
    communicator : mpi4py communicator
    owner : (k,) int array
        Rank that owns each row from now on.
    arrays : sequence of (k, *shape) arrays
        Of 8-byte numbers, float64, int64 or uint64; the same ones on every rank.
    """
    here = owner == communicator.rank
    columns = [_bits(array) for array in arrays]
    ends = np.cumsum([column.shape[1] for column in columns])[:-1]
    leaving = [np.flatnonzero((owner == rank) & ~here) for rank in range(communicator.size)]
    packed = [np.concatenate([c[rows] for c in columns], axis=1) for rows in leaving]
    arrived = np.concatenate(send_rows(communicator, packed))
    parts = np.split(arrived, ends, axis=1)
    return [
        np.concatenate([array[here], _numbers(part, array)])
        for array, part in zip(arrays, parts, strict=True)
    ]


def _bits(array: Array) -> Whole:
    """Numbers as integers of the same bits (k, width)."""
    flat = np.ascontiguousarray(array).reshape(len(array), int(np.prod(array.shape[1:])))
    return flat.view(np.int64)


def _numbers(part: Whole, like: Array) -> Array:
    """Numbers with the dtype and shape of others, from integers of the same bits."""
    shape = (len(part), *like.shape[1:])
    return np.ascontiguousarray(part).view(like.dtype).reshape(shape)
