"""Nodes that come back when bodies have moved on, and the states that they get."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.clouds.nearest import nearest
from quintet.components.meshless_gas.kernels.motion import write_conservative
from quintet.components.meshless_gas.moving.seams import write_uncovered, write_uncovered_in_space
from quintet.interfaces.component import Array

if TYPE_CHECKING:
    from quintet.components.meshless_gas.moving.clouds import MovingClouds

KNOWN = 8  # nodes that tell the state of one that is uncovered; in space twice as many


def uncover(
    moving: "MovingClouds", fresh: NDArray[np.int64], primitive: Array, conservative: Array
) -> None:
    """Give nodes that came back the state of what is around them."""
    if not len(fresh):
        return
    cloud = moving.domain.cloud
    known = moving.active[: cloud.nodes].copy()
    known[fresh] = False
    near = moving.heights(cloud.positions[: cloud.nodes])
    close = (near < (moving.thickness + 4.0 * moving.spacing)[:, None]).any(axis=0)
    among = np.flatnonzero(known & close)
    planar = moving.layout.planar
    many, write = (KNOWN, write_uncovered) if planar else (2 * KNOWN, write_uncovered_in_space)
    found, _ = nearest(cloud.positions, among, cloud.positions[fresh], many, moving.team)
    write(fresh, found, cloud.positions, cloud.spacing, moving.pose.centre, moving.radii, primitive)
    part_of = np.empty((len(fresh), 5))
    write_conservative(primitive[fresh], moving.gamma, part_of)
    conservative[fresh] = part_of
