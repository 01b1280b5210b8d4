"""What a cloud of nodes is, and joining several."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.interfaces.component import Array

Kinds = NDArray[np.int8]
Whole = NDArray[np.int32]

# What a node is.
INNER, SLIP, NO_SLIP_ISOTHERMAL, NO_SLIP_ADIABATIC, INFLOW, OUTFLOW, SYMMETRY, GHOST = range(8)
NO_SLIP_KINDS = (NO_SLIP_ISOTHERMAL, NO_SLIP_ADIABATIC)
KINDS = {
    "slip": SLIP,
    "isothermal": NO_SLIP_ISOTHERMAL,
    "adiabatic": NO_SLIP_ADIABATIC,
    "inflow": INFLOW,
    "outflow": OUTFLOW,
}
WALLS = (SLIP, NO_SLIP_ISOTHERMAL, NO_SLIP_ADIABATIC, SYMMETRY)
GAUSSIAN = 0.0  # in `weight`: of the paper; else the power p of 1/dᵖ


class Cloud(NamedTuple):
    """Nodes, and behind them their ghosts."""

    positions: Array  # (n, 3) m
    kind: Kinds  # (n,)
    normals: Array  # (n, 3) 1, into the gas; 0 within
    spacing: Array  # (n,) m
    region: Whole  # (n,) 0 of the background, 1 + b of the cloud of body b
    volumes: Array  # (n,) m3; in two dimensions of 1 m of depth; 0 of ghosts
    areas: Array  # (n, 3) m2, of the boundary at boundary nodes, along normals into the gas
    patch: Whole  # (n,) number of the boundary that it belongs to; 0 within
    weight: Array  # (n,) 1, of its least squares: GAUSSIAN, or the power of 1/d
    owner: Whole  # (g,) nodes that ghosts, the last rows, are images of
    turn: Array  # (g, 3, 3) 1, rotation or reflection from owner to image

    @property
    def nodes(self) -> int:
        """Number of nodes that are no ghosts."""
        return len(self.positions) - len(self.owner)


def own_areas(cloud: Cloud, rows: NDArray[Any]) -> Array:
    """Areas (w, 3) m2 of boundary nodes on their own face alone, across their normals."""
    normals = cloud.normals[rows]
    return np.asarray((cloud.areas[rows] * normals).sum(axis=1)[:, None] * normals)


def joined(clouds: list[Cloud]) -> Cloud:
    """One cloud of several: their nodes in order, then all ghosts."""
    count = np.cumsum([0, *(cloud.nodes for cloud in clouds)])

    def rows(name: str) -> Array:
        """Nodes of all, then ghosts of all."""
        parts = [getattr(cloud, name) for cloud in clouds]
        heads = [part[: cloud.nodes] for part, cloud in zip(parts, clouds, strict=True)]
        tails = [part[cloud.nodes :] for part, cloud in zip(parts, clouds, strict=True)]
        return np.concatenate([*heads, *tails])

    owner = [cloud.owner + first for cloud, first in zip(clouds, count[:-1], strict=True)]
    turn = np.concatenate([cloud.turn for cloud in clouds])
    nodes = [rows(name) for name in Cloud._fields[:-2]]
    return Cloud(*nodes, np.concatenate(owner).astype(np.int32), turn)  # type: ignore[call-arg]


def with_ghosts(cloud: Cloud, owner: Array, positions: Array, turn: Array) -> Cloud:
    """Add images of some nodes of a cloud.

    Parameters
    ----------
    cloud : Cloud
    owner : (g,)
        Nodes that they are images of; ghosts too.
    positions : (g, 3) m
    turn : (g, 3, 3) 1
        From what they are images of.
    """
    first = cloud.owner if len(cloud.owner) else np.zeros(0, np.int32)
    behind = owner >= cloud.nodes  # an image of an image
    root, whole = owner.copy(), turn.copy()
    root[behind] = first[owner[behind] - cloud.nodes]
    whole[behind] = turn[behind] @ cloud.turn[owner[behind] - cloud.nodes]
    added = Cloud(
        positions=positions,
        kind=np.full(len(owner), GHOST, np.int8),
        normals=np.einsum("gab,gb->ga", turn, cloud.normals[owner]),
        spacing=cloud.spacing[owner],
        region=cloud.region[owner],
        volumes=np.zeros(len(owner)),
        areas=np.zeros((len(owner), 3)),
        patch=cloud.patch[owner],
        weight=cloud.weight[owner],
        owner=root.astype(np.int32),
        turn=whole,
    )
    rows = [np.concatenate([a, b]) for a, b in zip(cloud, added, strict=True)]
    return Cloud(*rows)


def is_mirrored(kind: Array) -> Array:
    """Whether nodes are those of walls of symmetry."""
    return np.asarray(kind == SYMMETRY)


def is_advanced(kind: Array) -> Array:
    """Whether nodes are advanced: those within, and those of walls of symmetry."""
    return np.asarray((kind == INNER) | (kind == SYMMETRY))
