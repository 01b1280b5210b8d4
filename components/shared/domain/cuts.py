"""Space shared out by cuts between rows of cells, so that each rank has as much work.

The cuts are those of a recursive bisection (Berger & Bokhari, IEEE Trans. Comput. C-36 (1987) 570)
across the longest extent of what is to be shared, each found from one histogram. A cut runs between
two layers of cells, with a step in it between two rows of one layer. It goes on to infinity:
whatever lies anywhere has an owner.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.domain.extremes import counted, greatest, least
from quintet.interfaces.errors import StepError

Whole = NDArray[np.int64]
FAR = 1 << 40  # layers


class Cut(NamedTuple):
    """Ranks `first` to `last` - 1 part here: those from `second` on own from a row of cells on."""

    first: int
    second: int
    last: int
    axis: int
    layer: int  # along the axis
    beside: int  # the axis along which the layer is parted
    row: int  # along that one


def cut_between_rows(communicator: Any, cells: Whole, weights: Whole) -> list[Cut]:
    """Cut space so that all ranks have about the same weight, and each has a cell or more.

    Parameters
    ----------
    communicator : mpi4py communicator
    cells : (n, 3) int array
        Cell of each row of this rank, on a lattice that is the same on all ranks.
    weights : (n,) int array
        Work of each row; above 0.

    Raises
    ------
    StepError
        If a part of one cell is left for several ranks.
    """
    cuts: list[Cut] = []
    parts = [(0, communicator.size)]
    part_of = np.zeros(len(cells), np.int64)  # first rank of the part that holds each row
    while parts := [part for part in parts if part[1] - part[0] > 1]:
        level = _cut_all(communicator, parts, part_of, cells, weights)
        cuts += level
        part_of = owners(level, cells, part_of)
        parts = [
            half for cut in level for half in ((cut.first, cut.second), (cut.second, cut.last))
        ]
    return cuts


def owners(cuts: list[Cut], cells: Whole, start: Whole | None = None) -> Whole:
    """Rank (n,) that owns what is in each cell (n, 3); `start` (n,): the part that each is in."""
    owner = np.zeros(len(cells), np.int64) if start is None else start.copy()
    for cut in cuts:
        along, beside = cells[:, cut.axis], cells[:, cut.beside]
        beyond = (along > cut.layer) | ((along == cut.layer) & (beside >= cut.row))
        owner[beyond & (owner == cut.first)] = cut.second
    return owner


def _cut_all(
    communicator: Any, parts: list[tuple[int, int]], part_of: Whole, cells: Whole, weights: Whole
) -> list[Cut]:
    """Cut each part, ranks (first, last), once."""
    of_part = [np.flatnonzero(part_of == first) for first, _ in parts]
    low = [cells[rows].min(axis=0, initial=FAR) for rows in of_part]
    high = [cells[rows].max(axis=0, initial=-FAR) for rows in of_part]
    lowest = least(communicator, np.array(low)).tolist()
    highest = greatest(communicator, np.array(high)).tolist()
    axes, histograms = [], []
    for (first, last), rows, lower, upper in zip(parts, of_part, lowest, highest, strict=True):
        extents = [b - a + 1 for a, b in zip(lower, upper, strict=True)]
        if max(extents) == 1:
            raise StepError(
                f"ranks: each must own a cell of fluid or more; there is one cell left for the "
                f"{last - first} ranks from {first} on. Take fewer ranks than {communicator.size}."
            )
        *_, beside, axis = np.argsort(extents, kind="stable").tolist()
        along = cells[rows, axis] - lower[axis]
        place = along * extents[beside] + cells[rows, beside] - lower[beside]
        axes.append((axis, beside, extents[beside]))
        length = extents[axis] * extents[beside]
        histograms.append(np.bincount(place, weights[rows], length).astype(np.int64))
    ends = np.cumsum([len(histogram) for histogram in histograms])[:-1]
    sums = np.split(counted(communicator, np.concatenate(histograms)), ends)
    cuts = []
    for (first, last), (axis, beside, width), lower, histogram in zip(
        parts, axes, lowest, sums, strict=True
    ):
        second = first + (last - first) // 2
        layer, row = divmod(_nearest(histogram, second - first, last - first), width)
        place = lower[axis] + layer, beside, lower[beside] + row
        cuts.append(Cut(first, second, last, axis, *place))
    return cuts


def _nearest(histogram: Whole, few: int, count: int) -> int:
    """How many of the first rows of cells have about few/count of the weight.

    Each side has as many rows that weigh anything as ranks, if there are so many; else one.
    """
    sums = np.concatenate([[0], np.cumsum(histogram)])
    row = int(np.argmin(np.abs(sums - (few / count) * sums[-1])))
    heavy = np.flatnonzero(histogram)
    before, behind = (few, count - few) if len(heavy) >= count else (1, 1)
    return min(max(row, int(heavy[before - 1]) + 1), int(heavy[-behind]))
