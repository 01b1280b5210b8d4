"""Extremes and sums without rounding over all ranks: the same, whatever the number of ranks."""

from typing import Any

import numpy as np
from mpi4py import MPI

from quintet.components.shared.domain.waiting import wait_for_all
from quintet.interfaces.component import Array


def greatest(communicator: Any, numbers: Array) -> Array:
    """Largest of all ranks of each number (k,), on every rank; ints or floats, none NaN."""
    return _reduced(communicator, numbers, MPI.MAX)


def least(communicator: Any, numbers: Array) -> Array:
    """Smallest of all ranks of each number (k,), on every rank; ints or floats, none NaN."""
    return _reduced(communicator, numbers, MPI.MIN)


def counted(communicator: Any, numbers: Array) -> Array:
    """Sums over all ranks of whole numbers (k,), on every rank."""
    return _reduced(communicator, np.asarray(numbers, np.int64), MPI.SUM)


def added(communicator: Any, numbers: Array) -> Array:
    """Sums over all ranks of floats whose sums are exact (`shared.exact_sums`), on every rank."""
    return _reduced(communicator, np.asarray(numbers, np.float64), MPI.SUM)


def _reduced(communicator: Any, numbers: Array, operation: Any) -> Array:
    result = np.empty_like(numbers)
    wait_for_all(communicator.Iallreduce(np.ascontiguousarray(numbers), result, operation))
    return result
