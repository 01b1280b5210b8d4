"""Nodes that come back when bodies have moved on, and the states that they get."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.clouds.nearest import nearest
from quintet.components.meshless_gas.kernels.motion import write_conservative
from quintet.components.meshless_gas.moving.kernels.fresh_nodes import (
    write_fresh,
    write_fresh_in_space,
)
from quintet.interfaces.component import Array

if TYPE_CHECKING:
    from quintet.components.meshless_gas.moving.clouds import MovingClouds

KNOWN = 8  # nodes that tell the state of one that is uncovered; in space twice as many


def fill_fresh_nodes(
    moving: "MovingClouds", fresh: NDArray[np.int64], primitive: Array, conservative: Array
) -> None:
    """Give nodes that came back the state of what is around them."""
    if not len(fresh):
        return
    cloud, own, centre = moving.domain.cloud, moving.layout, moving.pose.centre
    known = moving.holes.active[: cloud.nodes].copy()
    known[fresh] = False
    near = own.heights_of(cloud.positions[: cloud.nodes], centre)
    close = (near < (own.thickness + 4.0 * own.spacing)[:, None]).any(axis=0)
    among = np.flatnonzero(known & close)
    many, write = (KNOWN, write_fresh) if own.planar else (2 * KNOWN, write_fresh_in_space)
    found, _ = nearest(cloud.positions, among, cloud.positions[fresh], many, moving.team)
    write(fresh, found, cloud.positions, cloud.spacing, centre, own.radii, primitive)
    part_of = np.empty((len(fresh), 5))
    write_conservative(primitive[fresh], moving.gamma, part_of)
    conservative[fresh] = part_of
