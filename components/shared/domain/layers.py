"""Space shared out by cuts between layers of cells, so that each rank has as much work.

The cuts are those of a recursive bisection (Berger & Bokhari, IEEE Trans. Comput. C-36 (1987) 570)
across the longest extent of what is to be shared, each found from one histogram over the layers.
They go on to infinity: whatever lies anywhere has an owner.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.domain.extremes import counted, greatest, least
from quintet.interfaces.errors import StepError

Whole = NDArray[np.int64]
FAR = 1 << 40  # layers


class Cut(NamedTuple):
    """Ranks `first` to `last` - 1 part here: those from `second` on own from a layer on."""

    first: int
    second: int
    last: int
    axis: int
    layer: int


def cut_between_layers(communicator: Any, cells: Whole, weights: Whole) -> list[Cut]:
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
        made = _cut_all(communicator, parts, part_of, cells, weights)
        cuts += made
        part_of = owners(made, cells, part_of)
        parts = [half for cut in made for half in ((cut.first, cut.second), (cut.second, cut.last))]
    return cuts


def owners(cuts: list[Cut], cells: Whole, start: Whole | None = None) -> Whole:
    """Rank (n,) that owns what is in each cell (n, 3); `start` (n,): the part that each is in."""
    owner = np.zeros(len(cells), np.int64) if start is None else start.copy()
    for cut in cuts:
        beyond = (owner == cut.first) & (cells[:, cut.axis] >= cut.layer)
        owner[beyond] = cut.second
    return owner


def _cut_all(
    communicator: Any, parts: list[tuple[int, int]], part_of: Whole, cells: Whole, weights: Whole
) -> list[Cut]:
    """Cut each part, ranks (first, last), once."""
    of_part = [part_of == first for first, _ in parts]
    low = [cells[rows].min(axis=0, initial=FAR) for rows in of_part]
    high = [cells[rows].max(axis=0, initial=-FAR) for rows in of_part]
    lowest = least(communicator, np.array(low)).tolist()
    highest = greatest(communicator, np.array(high)).tolist()
    axes, histograms = [], []
    for (first, last), rows, lower, upper in zip(parts, of_part, lowest, highest, strict=True):
        extents = [b - a for a, b in zip(lower, upper, strict=True)]
        axis = extents.index(max(extents))
        if extents[axis] < 1:
            raise StepError(
                f"ranks: each must own a cell of fluid or more; there is one cell left for the "
                f"{last - first} ranks from {first} on. Take fewer ranks than {communicator.size}."
            )
        layers = cells[rows, axis] - lower[axis]
        axes.append(axis)
        histograms.append(np.bincount(layers, weights[rows], extents[axis] + 1).astype(np.int64))
    ends = np.cumsum([len(histogram) for histogram in histograms])[:-1]
    sums = np.split(counted(communicator, np.concatenate(histograms)), ends)
    cuts = []
    for (first, last), axis, lower, histogram in zip(parts, axes, lowest, sums, strict=True):
        second = first + (last - first) // 2
        layer = _nearest(histogram, (second - first) / (last - first))
        cuts.append(Cut(first, second, last, axis, lower[axis] + layer))
    return cuts


def _nearest(histogram: Whole, share: float) -> int:
    """How many of the first layers have about a share of the weight; neither all nor none."""
    sums = np.concatenate([[0], np.cumsum(histogram)])
    layer = int(np.argmin(np.abs(sums - share * sums[-1])))
    return min(max(layer, 1), len(histogram) - 1)
