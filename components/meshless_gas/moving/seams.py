"""Neighbours across the seams of clouds, and states of nodes that are uncovered."""

import math
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from quintet.components.meshless_gas.clouds.cloud import INNER as INNER_NODE
from quintet.components.meshless_gas.clouds.cloud import Cloud
from quintet.components.meshless_gas.clouds.nearest import nearest
from quintet.components.shared.numba_options import EXACT, INNER
from quintet.components.shared.threads import Team

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
    row: int, i: int, found: Any, positions: Any, spacing: Any, centres: Any, radii: Any, kept: int,
    sides: int, neighbours: Any,
) -> None:  # fmt: skip
    """Let a node have neighbours on all sides where there are some in sight."""
    for side in range(sides):
        has = False
        for k in range(kept):
            has = has or is_towards(positions, i, neighbours[i, k], side)
        if has:
            continue
        for k in range(found.shape[1]):
            j = found[row, k]
            sag = SAG * min(spacing[i], spacing[j])
            if (
                j != i
                and is_towards(positions, i, j, side)
                and is_seen(positions, i, j, centres, radii, sag)
            ):
                slot = spare(i, positions, kept, sides, neighbours)
                if slot >= 0:
                    neighbours[i, slot] = j
                break


@njit(**INNER)
def spare(i: int, positions: Any, kept: int, sides: int, neighbours: Any) -> int:
    """The last neighbour of a node that is not the only one on a side; -1 if each is."""
    for slot in range(kept - 1, -1, -1):
        needed = False
        for side in range(sides):
            if not is_towards(positions, i, neighbours[i, slot], side):
                continue
            others = False
            for k in range(kept):
                others = others or (k != slot and is_towards(positions, i, neighbours[i, k], side))
            needed = needed or not others
        if not needed:
            return slot
    return -1


def around(
    rows: NDArray[np.int64],
    among: NDArray[np.int64],
    cloud: Cloud,
    many: int,
    planar: bool,
    team: Team,
) -> NDArray[np.int64]:
    """Nodes (m, many) near to each of some, the nearest first.

    In space a node at a face of the box finds those within alone: the nearest all lie in the face,
    and span none.

    Parameters
    ----------
    rows : (m,)
        Nodes.
    among : (c,)
        Which may be found.
    cloud : Cloud
    many : int
        At most.
    planar : bool
    team : Team
        Threads.
    """
    many = min(many, len(among))
    found, _ = nearest(cloud.positions, among, cloud.positions[rows], many, team)
    face = cloud.kind[rows] != INNER_NODE
    if not planar and face.any():
        within = among[cloud.kind[among] == INNER_NODE]
        found[face], _ = nearest(cloud.positions, within, cloud.positions[rows[face]], many, team)
    return found


@njit(**EXACT)
def choose(
    rows: Any,
    found: Any,
    positions: Any,
    spacing: Any,
    centres: Any,
    radii: Any,
    kept: int,
    sides: int,
    neighbours: Any,
) -> int:
    """Write the nearest nodes in sight as neighbours; return the row of a node with too few, or -1.

    Where clouds of unlike spacings meet, the nearest lie on one side; the farthest of them then
    make room for nodes of the sides that have none.

    Parameters
    ----------
    rows : (m,)
        Nodes.
    found : (m, c)
        What is near to each, the nearest first.
    positions : (n, 3) m
    spacing : (n,) m
    centres : (b, 3) m
    radii : (b,) m
    kept : int
        How many neighbours a node has.
    sides : int
        On which it should have some: 4 in the plane, 6 in space.
    neighbours : (n, K)
        Written; padded with the node itself.
    """
    lacks = -1
    for row in range(rows.shape[0]):
        i, have = rows[row], 0
        for k in range(found.shape[1]):
            j = found[row, k]
            sag = SAG * min(spacing[i], spacing[j])
            if j != i and is_seen(positions, i, j, centres, radii, sag):
                neighbours[i, have] = j
                have += 1
                if have == kept:
                    break
        if have < kept:
            lacks = i
        else:
            surround(row, i, found, positions, spacing, centres, radii, kept, sides, neighbours)
        for k in range(have, neighbours.shape[1]):
            neighbours[i, k] = i
    return lacks


@njit(**EXACT)
def write_uncovered(
    rows: Any, found: Any, positions: Any, spacing: Any, centres: Any, radii: Any, primitive: Any
) -> None:
    """Write the states of nodes that come back: a plane by least squares, within those around.

    Weights are 1/d². The second order matters: a mean over the nearest is of first.

    Parameters
    ----------
    rows : (m,)
        Nodes.
    found : (m, c)
        Nodes near each whose states are known.
    positions : (n, 3) m
    spacing : (n,) m
    centres : (b, 3) m
    radii : (b,) m
    primitive : (n, 5)
    """
    low, high, sums = np.empty(5), np.empty(5), np.empty((3, 5))
    for row in range(rows.shape[0]):
        i = rows[row]
        low[:], high[:], sums[:] = math.inf, -math.inf, 0.0
        s = sx = sz = xx = xz = zz = 0.0
        for k in range(found.shape[1]):
            j = found[row, k]
            sag = SAG * min(spacing[i], spacing[j])
            if not is_seen(positions, i, j, centres, radii, sag):
                continue
            x = (positions[j, 0] - positions[i, 0]) / spacing[i]
            z = (positions[j, 2] - positions[i, 2]) / spacing[i]
            w = 1.0 / (x * x + z * z + 1e-9)
            s, sx, sz = s + w, sx + w * x, sz + w * z
            xx, xz, zz = xx + w * x * x, xz + w * x * z, zz + w * z * z
            for q in range(5):
                low[q], high[q] = min(low[q], primitive[j, q]), max(high[q], primitive[j, q])
                sums[0, q] += w * primitive[j, q]
                sums[1, q] += w * x * primitive[j, q]
                sums[2, q] += w * z * primitive[j, q]
        # The plane's value here: first row of the inverse of its normal equations.
        a, b, c = xx * zz - xz * xz, sz * xz - sx * zz, sx * xz - sz * xx
        determinant = s * a + sx * b + sz * c
        for q in range(5):
            value = sums[0, q] / s
            if determinant > 1e-6 * s * xx * zz:
                value = (a * sums[0, q] + b * sums[1, q] + c * sums[2, q]) / determinant
            primitive[i, q] = min(max(value, low[q]), high[q])


@njit(**EXACT)
def write_uncovered_in_space(
    rows: Any, found: Any, positions: Any, spacing: Any, centres: Any, radii: Any, primitive: Any
) -> None:
    """Write the states of nodes that come back, as `write_uncovered` does, in three dimensions.

    Fitted about the mean place of the nodes around, where the fit is their mean.
    """
    low, high, mean, middle = np.empty(5), np.empty(5), np.empty(5), np.empty(3)
    weight, arm, sums = np.empty(found.shape[1]), np.empty((found.shape[1], 3)), np.empty((3, 5))
    for row in range(rows.shape[0]):
        i = rows[row]
        low[:], high[:], mean[:], middle[:], sums[:] = math.inf, -math.inf, 0.0, 0.0, 0.0
        whole = 0.0
        for k in range(found.shape[1]):
            j = found[row, k]
            weight[k], square = 0.0, 1e-9
            for d in range(3):
                arm[k, d] = (positions[j, d] - positions[i, d]) / spacing[i]
                square += arm[k, d] ** 2
            sag = SAG * min(spacing[i], spacing[j])
            if is_seen(positions, i, j, centres, radii, sag):
                weight[k] = 1.0 / square
            whole += weight[k]
        xx = xy = xz = yy = yz = zz = 0.0
        for k in range(found.shape[1]):
            for d in range(3):
                middle[d] += weight[k] / whole * arm[k, d]
            for q in range(5):
                mean[q] += weight[k] / whole * primitive[found[row, k], q]
        for k in range(found.shape[1]):
            if weight[k] == 0.0:
                continue
            x, y, z = arm[k, 0] - middle[0], arm[k, 1] - middle[1], arm[k, 2] - middle[2]
            w = weight[k]
            xx, xy, xz = xx + w * x * x, xy + w * x * y, xz + w * x * z
            yy, yz, zz = yy + w * y * y, yz + w * y * z, zz + w * z * z
            for q in range(5):
                value = primitive[found[row, k], q]
                low[q], high[q] = min(low[q], value), max(high[q], value)
                sums[0, q] += w * x * (value - mean[q])
                sums[1, q] += w * y * (value - mean[q])
                sums[2, q] += w * z * (value - mean[q])
        a, b, c = yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy
        e, f, g = xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy
        determinant = xx * a + xy * b + xz * c
        u, v, w = middle[0], middle[1], middle[2]
        for q in range(5):
            value = mean[q]
            if determinant > 1e-6 * xx * yy * zz:
                along = (a * u + b * v + c * w) * sums[0, q] + (b * u + e * v + f * w) * sums[1, q]
                value -= (along + (c * u + f * v + g * w) * sums[2, q]) / determinant
            primitive[i, q] = min(max(value, low[q]), high[q])
