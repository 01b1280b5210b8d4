"""Neighbours across the overlaps of clouds, and states of fresh nodes."""

import math
from typing import Any

from numba import njit

from quintet.components.shared.numba_options import EXACT, INNER

SAG = 0.3  # of the shorter spacing: how far an arm may dip into a wall that is curved


@njit(**INNER)
def is_seen(positions: Any, i: int, j: int, centres: Any, radii: Any, sag: float) -> bool:
    """Whether no body lies between two nodes."""
    x, z = positions[j, 0] - positions[i, 0], positions[j, 2] - positions[i, 2]
    y = positions[j, 1] - positions[i, 1]
    square = x * x + y * y + z * z
    for b in range(radii.shape[0]):
        a, c = centres[b, 0] - positions[i, 0], centres[b, 2] - positions[i, 2]
        e = centres[b, 1] - positions[i, 1]
        share = min(max((a * x + e * y + c * z) / square, 0.0), 1.0) if square > 0.0 else 0.0
        u, v, w = a - share * x, e - share * y, c - share * z
        if math.sqrt(u * u + v * v + w * w) < radii[b] - sag:
            return False
    return True


@njit(**INNER)
def is_towards(positions: Any, i: int, j: int, side: int) -> bool:
    """Whether a node lies on a side of another, within 60 degrees: +x, +z, -x, -z, +y, -y."""
    x, z = positions[j, 0] - positions[i, 0], positions[j, 2] - positions[i, 2]
    y = positions[j, 1] - positions[i, 1]
    along = x if side % 2 == 0 else z
    if side > 3:
        along = y
    if side in (2, 3, 5):
        along = -along
    return bool(along > 0.0 and 4.0 * along * along >= x * x + y * y + z * z)


@njit(**INNER)
def surround(
    row: int, i: int, near: Any, positions: Any, spacing: Any, centres: Any, radii: Any, count: int,
    sides: int, neighbours: Any,
) -> None:  # fmt: skip
    """Let a node have neighbours on all sides where there are some in sight."""
    for side in range(sides):
        has = False
        for k in range(count):
            has = has or is_towards(positions, i, neighbours[i, k], side)
        if has:
            continue
        for k in range(near.shape[1]):
            j = near[row, k]
            sag = SAG * min(spacing[i], spacing[j])
            if (
                j != i
                and is_towards(positions, i, j, side)
                and is_seen(positions, i, j, centres, radii, sag)
            ):
                slot = spare(i, positions, count, sides, neighbours)
                if slot >= 0:
                    neighbours[i, slot] = j
                break


@njit(**INNER)
def spare(i: int, positions: Any, count: int, sides: int, neighbours: Any) -> int:
    """The last neighbour of a node that is not the only one on a side; -1 if each is."""
    for slot in range(count - 1, -1, -1):
        needed = False
        for side in range(sides):
            if not is_towards(positions, i, neighbours[i, slot], side):
                continue
            others = False
            for k in range(count):
                others = others or (k != slot and is_towards(positions, i, neighbours[i, k], side))
            needed = needed or not others
        if not needed:
            return slot
    return -1


@njit(**EXACT)
def choose(
    rows: Any,
    near: Any,
    positions: Any,
    spacing: Any,
    centres: Any,
    radii: Any,
    count: int,
    sides: int,
    neighbours: Any,
) -> int:
    """Write the nearest nodes in sight as neighbours; return the row of a node with too few, or -1.

    Where clouds of unlike spacings meet, the nearest lie on one side; the farthest of them then
    make room for nodes of the sides that have none.

    Parameters
    ----------
    near : (m, c)
        What is near to each, the nearest first.
    count : int
        How many neighbours a node has.
    sides : int
        On which it should have some: 4 in the plane, 6 in space.
    neighbours : (n, K)
        Written; padded with the node itself.
    """
    lacks = -1
    for row in range(rows.shape[0]):
        i, have = rows[row], 0
        for k in range(near.shape[1]):
            j = near[row, k]
            sag = SAG * min(spacing[i], spacing[j])
            if j != i and is_seen(positions, i, j, centres, radii, sag):
                neighbours[i, have] = j
                have += 1
                if have == count:
                    break
        if have < count:
            lacks = i
        else:
            surround(row, i, near, positions, spacing, centres, radii, count, sides, neighbours)
        for k in range(have, neighbours.shape[1]):
            neighbours[i, k] = i
    return lacks
