"""Sums over a fluid without the particles that buffers of inflows and outflows hold."""

import numpy as np

from quintet.components.sph_fluid.state import Array, State


def without_buffers(state: State, count: int, columns: list[Array]) -> tuple[int, list[Array]]:
    """Number of particles, of `count` with those of buffers, and columns (fluid,), 0 for these."""
    if not len(state.role):
        return count, columns
    is_free = state.role == 0
    return int(is_free.sum()), [np.where(is_free, column, 0.0) for column in columns]
