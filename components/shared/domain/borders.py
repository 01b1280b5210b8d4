"""Which rows lie near those of other ranks, by cells that are anchored to the world."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.domain.exchange import share
from quintet.components.shared.search.cells import LAYER, ROW

Whole = NDArray[np.int64]
# From a cell's key to the keys of it and the 26 around it.
AROUND = np.array(
    [x + ROW * y + LAYER * z for z in (-1, 0, 1) for y in (-1, 0, 1) for x in (-1, 0, 1)]
)


def around(keys: Whole) -> Whole:
    """Keys of some cells and of all beside them, sorted, each once."""
    return np.unique(np.unique(keys)[:, None] + AROUND)


def rows_near_others(communicator: Any, keys: Whole, near: Whole) -> list[Whole]:
    """For each rank, the rows of this one that lie in cells near its rows; of itself none.

    What is nearer to a row than the width of a cell lies in its cell or beside it.

    Parameters
    ----------
    communicator : mpi4py communicator
    keys : (n,) int array
        Cells of the rows of this rank (`shared.search.cells.keys_of`).
    near : (k,) int array
        Cells near its rows, sorted, each once: `around` the cells of its rows, and of their images
        across periodic sides.

    Returns
    -------
    list of (m,) int array
        Rows, rising.
    """
    all_near = share(communicator, near)
    nobody = np.zeros(0, np.int64)
    return [
        nobody if rank == communicator.rank else np.flatnonzero(_among(keys, cells))
        for rank, cells in enumerate(all_near)
    ]


def _among(keys: Whole, cells: Whole) -> NDArray[np.bool_]:
    """Whether each key (n,) stands in sorted cells (k,)."""
    if not len(cells):
        return np.zeros(len(keys), bool)
    place = np.minimum(np.searchsorted(cells, keys), len(cells) - 1)
    return cells[place] == keys
