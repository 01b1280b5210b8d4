"""Borders between ranks are moved: results must be the same."""

import numpy as np
from mpi4py import MPI

from quintet.components.meshless_gas.ranks import divided_nodes, several, whole_cloud
from quintet.components.shared.domain import bisection
from quintet.components.shared.domain.work import Work


def move():
    """Weigh later ranks, cells or nodes more, so that all borders move."""
    weights, cut = Work.weights, bisection._cut
    bisection._cut = lambda cells, few, count: cut(
        cells * np.linspace(1.0, 2.0, len(cells)), few, count
    )
    Work.weights = lambda work, rows: weights(work, rows) * (1 + MPI.COMM_WORLD.rank)
    for module in (several, divided_nodes, whole_cloud):
        module.part_of = smaller_parts


def smaller_parts(count, rank, size, grain=1):
    """First and last place of a rank's nodes, more on the first ranks than on later ones."""
    first, last = (
        int(count * (number / size) ** 0.8) // grain * grain if number < size else count
        for number in (rank, rank + 1)
    )
    return first, last
