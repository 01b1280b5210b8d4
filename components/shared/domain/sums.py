"""Sums over all ranks, in an order that does not depend on them: within cells, then over cells."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.domain.exchange import send_rows
from quintet.components.shared.domain.waiting import wait_for_all
from quintet.interfaces.component import Array

Whole = NDArray[np.int64]


def sum_cells(keys: Whole, rows: Array) -> tuple[Whole, Array]:
    """Keys (c,) of the cells of some rows, rising, and the sums (c, w) of the rows of each.

    Parameters
    ----------
    keys : (n,) int array
        Cell, or block of ids, of each row. All rows of a cell are on one rank.
    rows : (n, w) float array
        In the order of the persistent ids.
    """
    order = np.argsort(keys, kind="stable")
    cells, place = np.unique(keys[order], return_inverse=True)
    columns = [np.bincount(place, column, len(cells)) for column in rows[order].T]
    return cells, np.stack(columns, 1) if columns else np.empty((len(cells), 0))


def sum_of_all(communicator: Any, cells: Whole, sums: Array) -> Array:
    """Sum (w,) of the cells of all ranks, in the order of their keys, on every rank.

    Parameters
    ----------
    communicator : mpi4py communicator, or None of one rank
    cells, sums : (c,) int and (c, w) float array
        As of `sum_cells`; each cell is on one rank.
    """
    if communicator is None:
        return in_order(cells, sums)
    nothing = range(1, communicator.size)
    all_cells = np.concatenate(send_rows(communicator, [cells, *(cells[:0] for _ in nothing)]))
    all_sums = np.concatenate(send_rows(communicator, [sums, *(sums[:0] for _ in nothing)]))
    total = in_order(all_cells, all_sums)
    wait_for_all(communicator.Ibcast(total, 0))
    return total


def in_order(cells: Whole, sums: Array) -> Array:
    """Sum (w,) of cells (c, w), one after another, in the order of their keys (c,)."""
    if not len(cells):
        return np.zeros(sums.shape[1])
    return np.asarray(np.cumsum(sums[np.argsort(cells)], axis=0)[-1])
