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


def needed(domain: Domain, nodes: Rows) -> tuple[Rows, Rows]:
    """Nodes and ghosts whose gradients the fluxes of some nodes need: these, and all neighbours.

    A ghost has the gradient of the node that it is an image of.
    """
    cloud = domain.cloud
    is_needed = np.zeros(len(cloud.positions), bool)
    is_needed[nodes] = True
    is_needed[domain.stencils.neighbours[nodes]] = True
    ghosts = np.flatnonzero(is_needed[cloud.nodes :])
    is_needed[cloud.owner[ghosts]] = True
    return domain.every[is_needed[domain.every]], ghosts.astype(np.int32)


def _part(array: NDArray[Any], rows: NDArray[Any]) -> NDArray[Any]:
    """Some rows of an array in their places; the others are 0 and take no memory."""
    part = unwritten(array.shape, array.dtype)
    part[rows] = array[rows]
    return part


def unwritten(shape: tuple[int, ...], dtype: Any) -> NDArray[Any]:
    """Zeros that take memory where they are written: the system gives it page by page.

    Memory from `numpy.zeros` may have been in use before; all of it is then written with zeros.
    """
    count = math.prod(shape)
    size = max(count * np.dtype(dtype).itemsize, 1)
    pages = mmap.mmap(-1, size, flags=mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS)
    return np.frombuffer(pages, dtype, count).reshape(shape)
