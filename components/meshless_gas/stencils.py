"""Neighbours of nodes, and the coefficients of their least squares."""

import math
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from quintet.components.meshless_gas.clouds.cloud import Cloud, Whole
from quintet.components.meshless_gas.clouds.nearest import nearest
from quintet.components.shared.numba_options import EXACT, INNER
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError

FOURTH = math.exp(-4.0)
SOUND = 1e-3  # least determinant of M over the product of its diagonal
BLOCK = 1 << 16  # nodes whose neighbours are ordered at a time, by what they need of memory


class Stencils(NamedTuple):
    """What derivatives at a node are sums over."""

    neighbours: Whole  # (n, K), padded with the node itself; rows of ghosts are their own
    coefficients: Array  # (n, K, 3) 1/m, c_ij; 0 where padded


def nearest_neighbours(
    cloud: Cloud, count: int, team: Team, rows: NDArray[np.int64] | None = None
) -> Whole:
    """Nearest neighbours (n, count) of nodes, ghosts among them; of `rows` (m, count) alone.

    A boundary node looks within, and at other boundary nodes.
    """
    targets = np.arange(cloud.nodes) if rows is None else rows
    among = np.arange(len(cloud.positions))
    if len(among) <= count:
        raise SceneError(
            f"neighbours must be below the number of nodes, {len(among)}; found {count}. "
            "Make the spacing smaller, or neighbours fewer."
        )
    found, _ = nearest(cloud.positions, among, cloud.positions[targets], count + 1, team)
    own = found == targets[:, None]
    own[~own.any(axis=1), -1] = True  # nodes at one place: the last is left out
    kept = found[~own].reshape(len(targets), count).astype(np.int32)
    if rows is not None:
        return kept
    return _and_ghosts(cloud, kept)


def _and_ghosts(cloud: Cloud, kept: Whole) -> Whole:
    """Neighbours of nodes, and behind them those of ghosts, themselves."""
    itself = np.arange(cloud.nodes, len(cloud.positions), dtype=np.int32)
    return np.concatenate([kept, np.repeat(itself[:, None], kept.shape[1], axis=1)])


def graded_neighbours(
    cloud: Cloud, count: int, team: Team, rows: NDArray[np.int64] | None = None
) -> Whole:
    """Neighbours (n, count) of nodes where spacings double: the nearest in the pair's mean spacing.

    By the distance alone a node beside finer ones would have them for neighbours, on one side.
    With `rows` (m,) those of these nodes alone, (m, count).
    """
    targets = np.arange(cloud.nodes) if rows is None else rows
    axes = int((np.ptp(cloud.positions, axis=0) > 0.0).sum())
    more = min(count * 2**axes, len(cloud.positions) - 1)  # as finer ones crowd out what is beyond
    kept = np.empty((len(targets), count), np.int32)
    for first in range(0, len(targets), BLOCK):
        block = targets[first : first + BLOCK]
        near = nearest_neighbours(cloud, more, team, block)
        arms = cloud.positions[near] - cloud.positions[block, None]
        mean = 0.5 * (cloud.spacing[near] + cloud.spacing[block, None])
        away = np.round(np.sqrt((arms**2).sum(axis=2)) / mean, 9)  # equal ones by distance
        order = np.argsort(away, axis=1, kind="stable")[:, :count]
        kept[first : first + len(block)] = np.take_along_axis(near, order, axis=1)
    return kept if rows is not None else _and_ghosts(cloud, kept)


def stencils(cloud: Cloud, neighbours: Whole, planar: bool, team: Team) -> Stencils:
    """Coefficients of all nodes; refuses clouds whose neighbours do not span the space."""
    coefficients = np.zeros((*neighbours.shape, 3))
    quality = np.ones(len(neighbours))
    rows = np.arange(cloud.nodes)
    team.run(
        write_coefficients, len(rows), rows, cloud.positions, neighbours, cloud.weight,
        planar, coefficients, quality,
    )  # fmt: skip
    check_quality(cloud, quality, neighbours.shape[1], SOUND)
    return Stencils(neighbours, coefficients)


def check_quality(cloud: Cloud, quality: Array, count: int, least: float) -> None:
    """Refuse neighbours that lie on a line or in a plane."""
    worst = int(np.argmin(quality))
    if not quality[worst] > least:
        place = np.array2string(cloud.positions[worst], precision=4)
        raise SceneError(
            f"neighbours must surround each node; the {count} of node {worst} at {place} m lie "
            f"nearly in one line or plane (determinant {quality[worst]:.2g}, at least {least:g}). "
            "Raise neighbours, or add nodes there."
        )


@njit(**EXACT)
def write_coefficients(
    first: int,
    last: int,
    rows: Any,
    positions: Any,
    neighbours: Any,
    weight: Any,
    planar: bool,
    coefficients: Any,
    quality: Any,
) -> None:
    """Write c_ij = M⁻¹ ω_ij r_ij, M = Σ ω r rᵀ, and the determinant of M over its diagonal.

    M is made of arms over their greatest reach along each axis: rows of boundary layers are
    flat. ω = (exp(-(d/d_max)²) - e⁻⁴)/((1 - e⁻⁴) d), or 1/dᵖ.

    Parameters
    ----------
    first, last : int
        Of `rows`.
    rows : (m,)
    positions : (n, 3) m
    neighbours : (n, K)
    weight : (n,) 1
    planar : bool
        Whether y is left out.
    coefficients : (n, K, 3) 1/m
        Written.
    quality : (n,) 1
        Written: 1 where arms are evenly spread, 0 where they span no space.
    """
    arm, omega, reach = (
        np.zeros((neighbours.shape[1], 3)),
        np.zeros(neighbours.shape[1]),
        np.ones(3),
    )
    for row in range(first, last):
        i = rows[row]
        weigh_arms(i, positions, neighbours[i], weight[i], arm, omega, reach)
        xx, xy, xz, yy, yz, zz = moments(arm, omega)
        if planar:
            yy = 1.0
        a, b, c = yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy
        e, f, g = xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy
        determinant = xx * a + xy * b + xz * c
        diagonal = xx * yy * zz
        quality[i] = determinant / diagonal if diagonal > 0.0 else 0.0
        per = 1.0 / determinant if determinant > 0.0 else 0.0
        for k in range(neighbours.shape[1]):
            x, y, z = omega[k] * arm[k, 0], omega[k] * arm[k, 1], omega[k] * arm[k, 2]
            coefficients[i, k, 0] = (a * x + b * y + c * z) * per / reach[0]
            coefficients[i, k, 1] = (b * x + e * y + f * z) * per / reach[1]
            coefficients[i, k, 2] = (c * x + f * y + g * z) * per / reach[2]
        if planar:
            coefficients[i, :, 1] = 0.0


@njit(**INNER)
def weigh_arms(
    i: int, positions: Any, near: Any, weight: float, arm: Any, omega: Any, reach: Any
) -> None:
    """Write a node's arms (K, 3) 1, their weights (K,) and their greatest reach (3,) m."""
    farthest = 0.0
    reach[:] = 0.0
    for k in range(near.shape[0]):
        square = 0.0
        for d in range(3):
            arm[k, d] = positions[near[k], d] - positions[i, d]
            square += arm[k, d] * arm[k, d]
            reach[d] = max(reach[d], abs(arm[k, d]))
        omega[k] = math.sqrt(square)
        farthest = max(farthest, omega[k])
    for d in range(3):
        if reach[d] == 0.0:
            reach[d] = 1.0
    for k in range(near.shape[0]):
        distance = omega[k]
        if distance == 0.0:
            continue
        if weight > 0.0:
            omega[k] = (farthest / distance) ** weight
        else:
            part = math.exp(-((distance / farthest) ** 2)) - FOURTH
            omega[k] = part / (1.0 - FOURTH) * farthest / distance
        for d in range(3):
            arm[k, d] /= reach[d]


@njit(**INNER)
def moments(arm: Any, omega: Any) -> tuple[float, float, float, float, float, float]:
    """Σ ω r rᵀ: xx xy xz yy yz zz."""
    xx = xy = xz = yy = yz = zz = 0.0
    for k in range(omega.shape[0]):
        x, y, z = arm[k, 0], arm[k, 1], arm[k, 2]
        xx, xy, xz = xx + omega[k] * x * x, xy + omega[k] * x * y, xz + omega[k] * x * z
        yy, yz, zz = yy + omega[k] * y * y, yz + omega[k] * y * z, zz + omega[k] * z * z
    return xx, xy, xz, yy, yz, zz
