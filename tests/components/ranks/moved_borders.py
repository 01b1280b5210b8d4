"""Other borders between ranks than they would have: results must be the same."""

import numpy as np
from mpi4py import MPI

from quintet.components.shared.domain import bisection
from quintet.components.shared.domain.work import Work


def move():
    """Let later ranks, or later cells, weigh more than they do: all borders move."""
    weights, cut = Work.weights, bisection._cut
    bisection._cut = lambda cells, few, count: cut(
        cells * np.linspace(1.0, 2.0, len(cells)), few, count
    )
    Work.weights = lambda work, rows: weights(work, rows) * (1 + MPI.COMM_WORLD.rank)
