"""The k nearest points, by a tree that halves them along the axis of their widest spread.

Spacings differ by a thousand within a cloud, so cells of one width do not serve.
Ties go to the smaller number: which points are found does not depend on the tree.
"""

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.clouds.kernels import build, search
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array


def nearest(
    points: Array, among: NDArray[np.int64], targets: Array, count: int, team: Team
) -> tuple[NDArray[np.int64], Array]:
    """Find the nearest points of some targets; a point at the very place of a target is one too.

    Parameters
    ----------
    points : (n, 3) m
    among : (m,)
        Rows that may be found; at least `count`.
    targets : (t, 3) m
    count : int
    team : Team
        Threads.

    Returns
    -------
    (t, count) : rows, the nearest first
    (t, count) m2 : squares of the distances
    """
    order = among.astype(np.int64)
    axis, parted = np.zeros(len(order), np.int8), np.zeros(len(order))
    build(points, order, axis, parted)
    near = np.empty((len(targets), count), np.int64)
    squares = np.empty((len(targets), count))
    team.run(search, len(targets), points, order, axis, parted, targets, near, squares)
    return near, squares
