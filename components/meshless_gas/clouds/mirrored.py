"""Walls as planes of symmetry: images of the nodes above them, beyond their tangent planes.

A node of such a wall is advanced as those above it are, with whole stencils; its velocity is held
along the wall. What is extrapolated from above, as at other slip walls, has no balance of its own.
"""

from collections.abc import Mapping

import numpy as np

from quintet.components.meshless_gas.clouds.cloud import (
    INNER,
    SLIP,
    SYMMETRY,
    with_ghosts,
)
from quintet.components.meshless_gas.clouds.layers import LayeredCloud


def mirrored(layers: LayeredCloud, wall: int) -> LayeredCloud:
    """Mirror the second layer of a cloud in the first where that is of patch `wall`, a slip wall.

    Nodes of the wall from which gas leaves sideways keep their kind.
    """
    cloud, neighbours = layers.cloud, layers.neighbours
    count, nodes = len(layers.off_wall), cloud.nodes
    rows = np.arange(count)
    per_layer = len(cloud.owner) // (nodes // count)
    # The second layer's nodes and ghosts, and those of the wall below each.
    above = np.concatenate([rows + count, nodes + per_layer + np.arange(per_layer)])
    below = np.concatenate([rows, nodes + np.arange(per_layer)])
    normal = cloud.normals[below]
    arm = cloud.positions[above] - cloud.positions[below]
    out = (arm * normal).sum(axis=1)
    image = cloud.positions[above] - 2.0 * out[:, None] * normal
    turn = np.eye(3) - 2.0 * normal[:, :, None] * normal[:, None, :]
    first = len(cloud.positions)
    ghosted = with_ghosts(cloud, above, image, turn)
    number = np.full(first, -1, np.int64)
    number[above] = first + np.arange(len(above))
    kind = ghosted.kind.copy()
    padded = np.arange(len(ghosted.positions), dtype=np.int32)[:, None]
    padded = np.repeat(padded, neighbours.shape[1], axis=1)
    padded[:first] = neighbours
    for row in rows:
        near = neighbours[row][neighbours[row] != row]
        images = number[near[number[near] >= 0]]
        is_within = cloud.kind[row + count] == INNER  # and not where gas leaves sideways
        if cloud.kind[row] == SLIP and cloud.patch[row] == wall and is_within:
            kind[row] = SYMMETRY
            padded[row, : len(near)] = near
            padded[row, len(near) : len(near) + len(images)] = images
    return LayeredCloud(ghosted._replace(kind=kind), padded, layers.off_wall)


def as_slip(faces: Mapping[str, str]) -> dict[str, str]:
    """What is at each boundary, walls of symmetry as slip walls."""
    return {name: "slip" if kind == "symmetry" else kind for name, kind in faces.items()}
