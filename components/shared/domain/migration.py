"""Rows that move to the rank that owns them now."""

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
    columns = [_bits(ids), *(_bits(array) for array in arrays)]
    packed = np.concatenate(columns, axis=1)
    rows_of = [np.flatnonzero(owner == rank) for rank in range(communicator.size)]
    received = np.concatenate(send_rows(communicator, [packed[rows] for rows in rows_of]))
    received = received[np.argsort(received[:, 0])]
    cuts = np.cumsum([column.shape[1] for column in columns])[:-1]
    first, *others = np.split(received, cuts, axis=1)
    parts = zip(others, arrays, strict=True)
    moved = tuple(_numbers(part, array) for part, array in parts)
    return first[:, 0].copy(), moved


def _bits(array: Array) -> Whole:
    """Numbers as integers of the same bits (k, width)."""
    flat = np.ascontiguousarray(array).reshape(len(array), int(np.prod(array.shape[1:])))
    return flat.view(np.int64)


def _numbers(part: Whole, like: Array) -> Array:
    """Numbers with the dtype and shape of others, from integers of the same bits."""
    shape = (len(part), *like.shape[1:])
    return np.ascontiguousarray(part).view(like.dtype).reshape(shape)
