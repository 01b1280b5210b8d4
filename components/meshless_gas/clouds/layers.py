"""Nodes in layers over a surface: neighbours follow from those on the surface.

A row of the arrays is layer x surface node, layer by layer, from the wall outwards; ghosts come
last. Ghosts are nodes turned about the axis of symmetry (x) or shifted by a period.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.clouds.cloud import GHOST, INNER, KINDS, Cloud, Kinds, Whole
from quintet.interfaces.component import Array

NONE = -1


class SurfaceGrid(NamedTuple):
    """Nodes of a surface, and which of them are neighbours.

    A neighbour m + g is ghost g; -1 is none.
    """

    neighbours: Whole  # (m, a)
    ghost_source: Whole  # (g,) node that a ghost copies
    ghost_turn: Array  # (g, 3, 3)
    is_edge: NDArray[np.bool_]  # (m,) whether nothing is beyond it


class Sides(NamedTuple):
    """Boundaries of a cloud by their names."""

    kinds: Mapping[str, str]  # what is there
    patches: Mapping[str, int]  # their numbers


class Bounds(NamedTuple):
    """Boundaries by their numbers, 0 is none, and sizes of the surface."""

    first: Whole  # (m,) of the first layer
    last: Whole  # (m,) of the last
    edge: Whole  # (m,) of what is between them at an edge
    kinds: Kinds  # (p,) what nodes of each boundary are
    normals: Array  # (m, 3) 1, of the first layer, into the gas
    areas: Array  # (layers, m) m2, of each layer; of whole rings where the flow is axisymmetric
    beyond: Array  # (m, 3) m2, of the last layer, into the gas
    sides: Array  # (layers, m, 3) m2, of what is between them at an edge, into the gas; 0 elsewhere
    weight: float  # of the least squares


class LayeredCloud(NamedTuple):
    """A cloud with neighbours of its own."""

    cloud: Cloud
    neighbours: Whole  # (n, K), padded with the node itself
    off_wall: Whole  # (m, 2) rows of the second and third layer above each node of the first


def layered(
    places: Array, surface: SurfaceGrid, bounds: Bounds, is_cross: bool = False
) -> LayeredCloud:
    """Join layers of nodes to a cloud.

    Parameters
    ----------
    places : (layers, m, 3) m
    surface : SurfaceGrid
    bounds : Bounds
    is_cross : bool
        Neighbours on the node's own layer, and the two above and below it, only: in boundary
        layers the mean over three layers, which others take, smears what is thin.

    Returns
    -------
    LayeredCloud
    """
    layers, count = places.shape[:2]
    inner = layers * count
    owner = (np.arange(layers)[:, None] * count + surface.ghost_source).ravel().astype(np.int32)
    turn = np.tile(surface.ghost_turn, (layers, 1, 1))
    flat = places.reshape(-1, 3)
    images = np.einsum("gij,gj->gi", turn, flat[owner])
    positions = np.vstack([flat, images])
    patch, neighbours = _patches(layers, bounds), _neighbours(layers, surface, False)
    kind = bounds.kinds[patch]
    if is_cross:
        neighbours = _without_diagonals(neighbours, _neighbours(layers, surface, True), kind)
    volumes = _volumes(places, bounds.areas)
    normals, areas = _faces(places, surface, bounds)
    whole = len(positions)
    padded = np.repeat(np.arange(whole, dtype=np.int32)[:, None], neighbours.shape[1], 1)
    padded[:inner] = neighbours
    cloud = Cloud(
        positions=positions,
        kind=np.concatenate([kind, np.full(len(owner), GHOST, np.int8)]),
        normals=np.concatenate([normals, np.einsum("gij,gj->gi", turn, normals[owner])]),
        spacing=_spacing(positions, neighbours, owner),
        region=np.zeros(whole, np.int32),
        volumes=np.concatenate([volumes, np.zeros(len(owner))]),
        areas=np.concatenate([areas, np.zeros((len(owner), 3))]),
        patch=np.concatenate([patch, patch[owner]]),
        weight=np.full(whole, bounds.weight),
        owner=owner,
        turn=turn,
    )
    wall = np.arange(count, dtype=np.int32)
    return LayeredCloud(cloud, padded, np.stack([wall + count, wall + 2 * count], axis=1))


def rotations(angle: Array) -> Array:
    """Rotations (n, 3, 3) about x by angles (n,) rad."""
    turn = np.zeros((len(angle), 3, 3))
    turn[:, 0, 0] = 1.0
    turn[:, 1, 1] = turn[:, 2, 2] = np.cos(angle)
    turn[:, 2, 1] = np.sin(angle)
    turn[:, 1, 2] = -turn[:, 2, 1]
    return turn


def kinds_of(sides: Sides) -> Kinds:
    """What nodes of each boundary, by its number, are."""
    kinds = np.zeros(1 + max(sides.patches.values()), np.int8)
    for name, number in sides.patches.items():
        kinds[number] = KINDS[sides.kinds[name]]
    return kinds


def _patches(layers: int, bounds: Bounds) -> Whole:
    patch = np.repeat(bounds.edge[None], layers, axis=0)
    patch[0] = bounds.first
    patch[-1] = np.where(bounds.edge == 0, bounds.last, patch[-1])
    return patch.ravel()


def _neighbours(layers: int, surface: SurfaceGrid, is_cross: bool) -> Whole:
    """Rows (layers · m, K) of neighbours, those that there are first."""
    near = surface.neighbours
    count, ghosts = len(near), len(surface.ghost_source)
    level, node = np.divmod(np.arange(layers * count), count)
    columns = []
    for shift in (0, -1, 1):
        other = level + shift
        is_there = (other >= 0) & (other < layers)
        if shift:
            columns.append(np.where(is_there, other * count + node, NONE)[:, None])
        if shift and is_cross:
            continue
        beside = near[node]
        row = np.where(
            beside < count,
            other[:, None] * count + beside,
            layers * count + other[:, None] * ghosts + beside - count,
        )
        columns.append(np.where(is_there[:, None] & (beside != NONE), row, NONE))
    rows = np.hstack(columns)
    rows = np.take_along_axis(rows, np.argsort(rows == NONE, axis=1, kind="stable"), axis=1)
    rows = rows[:, : int((rows != NONE).sum(axis=1).max())]
    itself = np.arange(len(rows))[:, None]
    return np.where(rows == NONE, itself, rows).astype(np.int32)


def _without_diagonals(full: Whole, cross: Whole, kind: Kinds) -> Whole:
    """Neighbours along lines alone, but where a corner would have none within."""
    inner = np.concatenate([kind == INNER, np.zeros(int(full.max()) + 1 - len(kind), bool)])
    lacks = ~np.any(inner[cross], axis=1)
    within_first = np.argsort(~inner[full], axis=1, kind="stable")[:, : cross.shape[1]]
    return np.where(lacks[:, None], np.take_along_axis(full, within_first, axis=1), cross)


def _spacing(positions: Array, neighbours: Whole, source: Whole) -> Array:
    """Distance (n,) m of each node's nearest neighbour."""
    apart = positions[neighbours] - positions[: len(neighbours), None]
    length = np.sqrt((apart**2).sum(axis=2))
    nearest = np.where(length > 0.0, length, np.inf).min(axis=1)
    return np.concatenate([nearest, nearest[source]])


def _volumes(places: Array, areas: Array) -> Array:
    """Volume (n,) m3 of each node: to the middle of the layers beside it."""
    gap = np.sqrt((np.diff(places, axis=0) ** 2).sum(axis=2))
    middle = 0.5 * (areas[1:] + areas[:-1])
    volumes = np.zeros(places.shape[:2])
    volumes[:-1] += 0.25 * gap * (areas[:-1] + middle)
    volumes[1:] += 0.25 * gap * (areas[1:] + middle)
    return volumes.ravel()


def heights(places: Array) -> Array:
    """Height (layers, m) m of each node's part of its ray: to the middles of the gaps beside it."""
    gap = np.sqrt((np.diff(places, axis=0) ** 2).sum(axis=2))
    volumes = np.zeros(places.shape[:2])
    volumes[:-1] += 0.5 * gap
    volumes[1:] += 0.5 * gap
    return volumes


def _faces(places: Array, surface: SurfaceGrid, bounds: Bounds) -> tuple[Array, Array]:
    """Normals (n, 3) into the gas and areas (n, 3) m2 along them, of boundary nodes."""
    layers, count = places.shape[:2]
    normals, areas = np.zeros((layers, count, 3)), bounds.sides.copy()
    normals[0] = bounds.normals
    normals[-1] = _unit(bounds.beyond)
    areas[0] += bounds.normals * bounds.areas[0][:, None]
    areas[-1] += bounds.beyond
    edge = np.flatnonzero(surface.is_edge)
    normals[1:, edge] = _unit(bounds.sides[1:, edge])
    return normals.reshape(-1, 3), areas.reshape(-1, 3)


def _unit(vectors: Array) -> Array:
    return np.asarray(vectors / np.sqrt((vectors**2).sum(axis=-1))[..., None])
