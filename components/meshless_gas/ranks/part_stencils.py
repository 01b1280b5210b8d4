"""Stencils of some nodes in arrays that take memory for these alone."""

import math
import mmap
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.build import Domain, Rows
from quintet.components.meshless_gas.clouds.cloud import INNER, NO_SLIP_KINDS
from quintet.components.meshless_gas.stencils import Stencils


def part_stencils(domain: Domain, computed: Rows) -> Stencils:
    """Stencils that a rank needs, in the rows that they have in all.

    Every rank writes the states at all boundaries, from neighbours; walls along which a gas slips
    need coefficients, too.

    Parameters
    ----------
    domain : Domain
        With all stencils.
    computed : (m,) int
        Nodes whose gradients this rank computes, in a step or for a view.
    """
    kind, (neighbours, coefficients) = domain.cloud.kind[: domain.cloud.nodes], domain.stencils
    walls = np.flatnonzero(np.isin(kind, NO_SLIP_KINDS))
    boundary = np.flatnonzero(kind != INNER)
    return Stencils(
        _part(neighbours, np.union1d(computed, boundary)),
        _part(coefficients, np.union1d(computed, walls)),
    )


def _part(array: NDArray[Any], rows: NDArray[Any]) -> NDArray[Any]:
    """Some rows of an array in their places; the others are 0 and take no memory.

    The system gives memory to pages that are written. Of an array that numpy makes, all may be.
    """
    size = max(array.nbytes, 1)
    pages = mmap.mmap(-1, size, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS)
    part = np.frombuffer(pages, array.dtype, math.prod(array.shape)).reshape(array.shape)
    part[rows] = array[rows]
    return part
