"""Nodes of walls that are planes of symmetry."""

from typing import Any

from numba import njit

from quintet.components.meshless_gas.laws.boundaries import held_along
from quintet.components.shared.numba_options import EXACT


@njit(**EXACT)
def hold_along(rows: Any, normals: Any, conservative: Any, primitive: Any) -> None:
    """Take the velocity through walls from nodes on them; density and pressure stay."""
    for row in range(rows.shape[0]):
        i = rows[row]
        state, conserved = held_along(
            (primitive[i, 0], primitive[i, 1], primitive[i, 2], primitive[i, 3], primitive[i, 4]),
            (
                conservative[i, 0], conservative[i, 1], conservative[i, 2], conservative[i, 3],
                conservative[i, 4],
            ),
            (normals[i, 0], normals[i, 1], normals[i, 2]),
        )  # fmt: skip
        for q in range(5):
            primitive[i, q], conservative[i, q] = state[q], conserved[q]
