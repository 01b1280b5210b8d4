"""Nodes that come back when bodies have moved on, and their states."""

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.clouds.cloud import Cloud
from quintet.components.meshless_gas.moving.kernels.fresh_nodes import (
    write_fresh,
    write_fresh_in_space,
)
from quintet.components.meshless_gas.moving.layout import CloudLayout
from quintet.components.shared.search.nearest import nearest
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array

KNOWN = 8  # nodes from which the state of a fresh one is interpolated; in space twice as many


def fill_fresh_nodes(
    fresh: NDArray[np.int64],
    active: NDArray[np.bool_],
    centre: Array,
    cloud: Cloud,
    layout: CloudLayout,
    team: Team,
    primitive: Array,
) -> None:
    """Write the states of fresh nodes (m,) from the active nodes around them.

    Parameters
    ----------
    fresh : (m,)
    active : (n,)
        Whether nodes are in use, fresh ones included.
    centre : (b, 3) m
        Of bodies.
    cloud : Cloud
    layout : CloudLayout
    team : Team
    primitive : (n, 5)
        Rows of fresh nodes are written.
    """
    known = active[: cloud.nodes].copy()
    known[fresh] = False
    heights = layout.heights_of(cloud.positions[: cloud.nodes], centre)
    close = (heights < (layout.thickness + 4.0 * layout.spacing)[:, None]).any(axis=0)
    among = np.flatnonzero(known & close)
    many, write = (KNOWN, write_fresh) if layout.planar else (2 * KNOWN, write_fresh_in_space)
    near, _ = nearest(cloud.positions, among, cloud.positions[fresh], many, team)
    write(fresh, near, cloud.positions, cloud.spacing, centre, layout.radii, primitive)
