"""Nodes of walls that are planes of symmetry."""

from typing import Any

from numba import njit

from quintet.components.shared.numba_options import EXACT


@njit(**EXACT)
def hold_along(rows: Any, normals: Any, conservative: Any, primitive: Any) -> None:
    """Take the velocity through walls from nodes on them; density and pressure stay."""
    for row in range(rows.shape[0]):
        i = rows[row]
        out = 0.0
        for d in range(3):
            out += primitive[i, 1 + d] * normals[i, d]
        density = primitive[i, 0]
        conservative[i, 4] -= 0.5 * density * out * out
        for d in range(3):
            primitive[i, 1 + d] -= out * normals[i, d]
            conservative[i, 1 + d] -= density * out * normals[i, d]
