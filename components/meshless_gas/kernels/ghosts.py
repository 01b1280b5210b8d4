"""Ghost nodes: turned, mirrored or moved images of others, the last rows of a cloud."""

from typing import Any

from numba import njit

from quintet.components.shared.numba_options import EXACT


@njit(**EXACT)
def write_ghost_states(begin: int, end: int, owner: Any, turn: Any, primitive: Any) -> None:
    """Write the states of ghosts: scalars of the owner, its velocity turned.

    Parameters
    ----------
    begin, end : int
        Of the ghosts.
    owner : (g,)
        Nodes that they are images of.
    turn : (g, 3, 3) 1
        Rotation or reflection from the owner to its image.
    """
    first = primitive.shape[0] - owner.shape[0]
    for g in range(begin, end):
        i, o = first + g, owner[g]
        primitive[i, 0], primitive[i, 4] = primitive[o, 0], primitive[o, 4]
        u, v, w = primitive[o, 1], primitive[o, 2], primitive[o, 3]
        for a in range(3):
            primitive[i, 1 + a] = turn[g, a, 0] * u + turn[g, a, 1] * v + turn[g, a, 2] * w


@njit(**EXACT)
def write_ghost_gradients(
    begin: int, end: int, owner: Any, turn: Any, gradients: Any, lowest: Any, rows: Any = None
) -> None:
    """Write the gradients of ghosts: of scalars T g, of the velocity T G Tᵀ.

    Parameters
    ----------
    rows : (r,) int array or None
        Which ghosts, counted from the first; None: all.
    """
    first = lowest.shape[0] - owner.shape[0]
    for row in range(begin, end):
        g = row if rows is None else rows[row]
        i, o = first + g, owner[g]
        lowest[i] = lowest[o]
        for q in range(gradients.shape[1]):
            x, y, z = gradients[o, q, 0], gradients[o, q, 1], gradients[o, q, 2]
            for a in range(3):
                along = turn[g, a, 0] * x + turn[g, a, 1] * y + turn[g, a, 2] * z
                gradients[i, q, a] = along
        for a in range(3):
            u, v, w = gradients[i, 1, a], gradients[i, 2, a], gradients[i, 3, a]
            for b in range(3):
                along = turn[g, b, 0] * u + turn[g, b, 1] * v + turn[g, b, 2] * w
                gradients[i, 1 + b, a] = along
