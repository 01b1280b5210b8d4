"""Neighbours of nodes, and the coefficients of their least squares."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.clouds.cloud import Cloud, Whole
from quintet.components.meshless_gas.kernels.stencils import write_coefficients
from quintet.components.shared.search.nearest import nearest
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError

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
    near, _ = nearest(cloud.positions, among, cloud.positions[targets], count + 1, team)
    itself = near == targets[:, None]
    itself[~itself.any(axis=1), -1] = True  # nodes at one place: the last is left out
    chosen = near[~itself].reshape(len(targets), count).astype(np.int32)
    if rows is not None:
        return chosen
    return _and_ghosts(cloud, chosen)


def _and_ghosts(cloud: Cloud, chosen: Whole) -> Whole:
    """Neighbours of nodes, and behind them those of ghosts, themselves."""
    itself = np.arange(cloud.nodes, len(cloud.positions), dtype=np.int32)
    return np.concatenate([chosen, np.repeat(itself[:, None], chosen.shape[1], axis=1)])


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
    chosen = np.empty((len(targets), count), np.int32)
    for first in range(0, len(targets), BLOCK):
        block = targets[first : first + BLOCK]
        near = nearest_neighbours(cloud, more, team, block)
        arms = cloud.positions[near] - cloud.positions[block, None]
        mean = 0.5 * (cloud.spacing[near] + cloud.spacing[block, None])
        away = np.round(np.sqrt((arms**2).sum(axis=2)) / mean, 9)  # equal ones by distance
        order = np.argsort(away, axis=1, kind="stable")[:, :count]
        chosen[first : first + len(block)] = np.take_along_axis(near, order, axis=1)
    return chosen if rows is not None else _and_ghosts(cloud, chosen)


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
