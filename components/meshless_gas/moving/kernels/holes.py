"""Which nodes are left out where clouds lie over each other."""

import math
from typing import Any

from numba import njit

from quintet.components.shared.numba_options import EXACT


@njit(**EXACT)
def cut(
    positions: Any,
    region: Any,
    height: Any,
    centres: Any,
    radii: Any,
    depths: Any,
    margins: Any,
    was: Any,
    active: Any,
) -> int:
    """Write which nodes are left out by bodies and their clouds; return the row of a wall, or -1.

    A node lies in the cloud of another body if it is nearer to that body's surface than to that of
    its own body, and within the depth that the cloud keeps for itself.

    Parameters
    ----------
    region : (n,)
        0 of the background, 1 + b of the cloud of body b.
    height : (n,) m
        Above the own body; ∞ of the background.
    radii, depths : (b,) m
        Of bodies, and how far above them no node of others is left.
    margins : (b,) m
        By how much more a node that was left out must be away to come back.
    was : (n,)
        Whether nodes were active.
    active : (n,)
        Written.

    Returns
    -------
    int
        A node of a wall, of height 0, that another body covers; -1 if there is none.
    """
    covered = -1
    for i in range(region.shape[0]):
        active[i] = True
        for b in range(radii.shape[0]):
            if region[i] == b + 1:
                continue
            square = 0.0
            for d in range(3):
                square += (positions[i, d] - centres[b, d]) ** 2
            away = math.sqrt(square) - radii[b]
            more = 0.0 if was[i] else margins[b]
            if away <= 0.0 or (away < depths[b] + more and away < height[i] + more):
                active[i] = False
                if height[i] == 0.0:
                    covered = i
    return covered


@njit(**EXACT)
def part(rows: Any, squares: Any, least: float, more: float, was: Any, active: Any) -> None:
    """Leave out nodes whose nearest node of a cloud is too near.

    Parameters
    ----------
    rows : (m,)
        Nodes near the rim of the cloud.
    squares : (m, 1) m2
        Of their distances from it.
    least, more : float, m
        Distance that they keep, and by how much more to come back.
    was, active : (n,)
        Before, and now (written).
    """
    for row in range(rows.shape[0]):
        i = rows[row]
        keep = least if was[i] else least + more
        if squares[row, 0] < keep * keep:
            active[i] = False
