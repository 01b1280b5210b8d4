"""Volumes of nodes where clouds lie over each other: each place is counted once.

A place belongs to the body it is nearest to as far as that body's cloud reaches, else to the
background. Cells that the border cuts are shared by how far it is from their node.
"""

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.clouds.cloud import Cloud
from quintet.components.meshless_gas.moving.layout import CloudLayout
from quintet.components.shared.search.nearest import nearest
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array


def partitioned(
    layout: CloudLayout, cloud: Cloud, active: NDArray[np.bool_], away: Array, team: Team
) -> Array:
    """Volumes (n,) m3 of nodes.

    What lies beyond a cloud's rim at nodes that are left out is that of the nodes next to them.

    Parameters
    ----------
    layout : CloudLayout
    cloud : Cloud
    active : (n,)
        Nodes that are not left out.
    away : (b, n) m
        Heights of nodes above bodies.
    team : Team
        Threads.
    """
    count = cloud.nodes
    region, width = cloud.region[:count], cloud.spacing[:count]
    volumes = layout.volumes.copy()
    near = np.zeros(count, bool)
    for b, heights in enumerate(away):
        beyond = (heights - layout.thickness[b]) / width
        # Nearer to the own body than to this one; the background has none, its height is ∞.
        nearer = 0.5 * (heights - layout.height) / width
        share = np.clip(np.maximum(beyond, nearer) + 0.5, 0.0, 1.0)
        volumes *= np.where(region == b + 1, 1.0, share)
        near |= heights < layout.thickness[b] + 3.0 * layout.spacing[b]
    omitted = np.flatnonzero(~active & (volumes > 0.0))
    receiving = np.flatnonzero(active & near)
    if len(omitted) and len(receiving):
        receivers, _ = nearest(cloud.positions, receiving, cloud.positions[omitted], 1, team)
        np.add.at(volumes, receivers[:, 0], volumes[omitted])
    return np.where(active, volumes, 0.0)
