"""Boxes: lattices of nodes, moved at random where told, with images beyond some of their faces."""

import math
from collections.abc import Mapping, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.clouds.cloud import (
    INFLOW,
    INNER,
    KINDS,
    OUTFLOW,
    Cloud,
    with_ghosts,
)
from quintet.components.meshless_gas.clouds.refinement import FinePart, halved
from quintet.interfaces.component import Array

AXES = ("x", "y", "z")
PERIODIC, MIRROR = "periodic", "symmetry"  # faces without nodes of their own
IMAGED = (PERIODIC, MIRROR)
FACES = tuple(axis + side for axis in AXES for side in "-+")


class Lattice(NamedTuple):
    """Nodes of a box along one axis."""

    places: Array  # (m,) m
    widths: Array  # (m,) m, of their cells
    has_ends: tuple[bool, bool]  # whether the first and the last lie on a face


def along(low: float, high: float, spacing: float, ends: tuple[str, str]) -> Lattice:
    """Nodes of an edge: on a face, or half a spacing before one that has images beyond."""
    lie = (ends[0] not in IMAGED, ends[1] not in IMAGED)
    before = 0.0 if lie[0] else 0.5
    half = 0.5 * (2 - sum(lie))  # spacings that nodes leave before imaged faces
    count = max(1, round((high - low) / spacing - half + 1e-9))  # spacings between nodes
    step = (high - low) / (count + half)
    places = low + step * (before + np.arange(count + 1))
    widths = np.full(count + 1, step)
    widths[0] *= 0.5 if lie[0] else 1.0
    widths[-1] *= 0.5 if lie[1] else 1.0
    return Lattice(places, widths, lie)


def count_along(low: float, high: float, spacing: float, ends: tuple[str, str]) -> int:
    """How many nodes `along` makes."""
    half = 0.5 * sum(end in IMAGED for end in ends)
    return max(1, round((high - low) / spacing - half + 1e-9)) + 1


def reach_of(neighbours: int, dimensions: int, jitter: float) -> float:
    """Spacings within which all neighbours of a node lie."""
    count = neighbours + 1
    full = math.sqrt(count / math.pi) if dimensions == 2 else (0.2387 * count) ** (1.0 / 3.0)
    return full + 1.0 + 2.0 * jitter


def box(
    lowest: tuple[float, float, float],
    highest: tuple[float, float, float],
    spacing: float,
    faces: Mapping[str, str],
    patches: Mapping[str, int],
    jitter: float = 0.0,
    seed: int = 0,
    weight: float = 0.0,
    neighbours: int = 9,
    planar: bool = True,
    parts: Sequence[FinePart] = (),
) -> Cloud:
    """Make a box.

    Parameters
    ----------
    lowest, highest : m
    spacing : m
        Changed to fit into the box.
    faces
        What is at each face, ``x-`` to ``z+``: "periodic", "symmetry", or a key of `KINDS`.
    patches
        Number of the boundary of faces that have nodes.
    jitter : 1
        Width of the random moves of nodes within, over the spacing.
    seed
    weight : 1
        Of the least squares.
    neighbours, planar
        For how far images are needed; whether y is left out.
    parts
        Where nodes are finer.
    """
    axes = (0, 2) if planar else (0, 1, 2)
    ends = [(faces.get(axis + "-", PERIODIC), faces.get(axis + "+", PERIODIC)) for axis in AXES]
    lattices = [
        along(lowest[d], highest[d], spacing, ends[d])
        if d in axes
        else Lattice(np.zeros(1), np.ones(1), (False, False))
        for d in range(3)
    ]
    positions = _crossed([lattice.places for lattice in lattices])
    widths = _crossed([lattice.widths for lattice in lattices])
    kind, patch, normals, areas = _faces(lattices, widths, axes, faces, patches)
    step = np.array([lattice.widths.max() for lattice in lattices])
    spacing = max(step[d] for d in axes)
    cells = halved(positions, widths, kind == INNER, spacing, parts, axes)
    count, rows, finer = len(cells.positions), cells.origin, 0.5**cells.level
    if jitter > 0.0:
        moves = _moves(seed, jitter, step, finer)
        cells.positions[:, axes] += np.where(kind[rows, None] == INNER, moves, 0.0)[:, axes]
    cloud = Cloud(
        positions=cells.positions,
        kind=kind[rows],
        normals=normals[rows],
        spacing=spacing * finer,
        region=np.zeros(count, np.int32),
        volumes=cells.widths.prod(axis=1),
        areas=areas[rows],
        patch=patch[rows],
        weight=np.full(count, weight),
        owner=np.zeros(0, np.int32),
        turn=np.zeros((0, 3, 3)),
    )
    reach = reach_of(neighbours, len(axes), jitter)
    for d in axes:
        cloud = with_images(cloud, d, (lowest[d], highest[d]), ends[d], reach * step[d])
    return cloud


def _crossed(numbers: Sequence[Array]) -> Array:
    """Numbers (n, 3) of all nodes of a lattice from those along each axis."""
    return np.stack([grid.ravel() for grid in np.meshgrid(*numbers, indexing="ij")], axis=1)


def _moves(seed: int, jitter: float, step: Array, finer: Array) -> Array:
    """Random moves (n, 3) m over a share of the widths of cells (3,) m, times a share (n,)."""
    moves = np.random.default_rng(seed).uniform(-0.5, 0.5, (len(finer), 3)) * jitter * step
    return np.asarray(moves * finer[:, None])


def _faces(
    lattices: Sequence[Lattice],
    widths: Array,
    axes: tuple[int, ...],
    faces: Mapping[str, str],
    patches: Mapping[str, int],
) -> tuple[NDArray[np.int8], NDArray[np.int32], Array, Array]:
    """Kinds (n,), numbers of boundaries (n,), normals and areas (n, 3) m2 of the nodes of a box."""
    place = np.indices([len(lattice.places) for lattice in lattices]).reshape(3, -1).T
    count = len(widths)
    kind = np.zeros(count, np.int8)
    patch = np.zeros(count, np.int32)
    normals, areas = np.zeros((count, 3)), np.zeros((count, 3))
    rank = {INFLOW: 2, OUTFLOW: 0}  # at edges inflows come before walls, and outflows after them
    ranks = np.array([rank.get(kind, 1) if kind != INNER else -1 for kind in range(8)])
    for d, side in product(axes, (0, 1)):
        if not lattices[d].has_ends[side]:
            continue
        face = AXES[d] + "-+"[side]
        sign, face_kind = (1.0, -1.0)[side], KINDS[faces[face]]
        on = place[:, d] == (0, len(lattices[d].places) - 1)[side]
        areas[on, d] += sign * widths[on].prod(axis=1) / widths[on, d]
        first = on & (ranks[kind] < ranks[face_kind])
        kind[first], patch[first], normals[first] = face_kind, patches[face], 0.0
        normals[first, d] = sign
    return kind, patch, normals, areas


def with_images(
    cloud: Cloud, d: int, span: tuple[float, float], ends: tuple[str, str], reach: float
) -> Cloud:
    """Add images of all that is within reach [m] beyond both ends of an axis."""
    low, high = span
    x = cloud.positions[:, d]
    owner, positions, turns = [], [], []

    def add(rows: Array, places: Array, sign: float) -> None:
        image, turn = cloud.positions[rows], np.eye(3)
        image[:, d], turn[d, d] = places, sign
        owner.append(rows)
        positions.append(image)
        turns.append(np.repeat(turn[None], len(rows), axis=0))

    if PERIODIC in ends:
        length = high - low
        for shift in range(1, math.ceil(reach / length) + 1):
            for sign in (-1, 1):
                moved = x + sign * shift * length
                near = (moved > low - reach) & (moved < high + reach)
                rows = np.flatnonzero(near)
                add(rows, moved[rows], 1.0)
    for end, name in zip(span, ends, strict=True):
        if name == MIRROR:
            rows = np.flatnonzero(np.abs(x - end) < reach)
            add(rows, 2.0 * end - x[rows], -1.0)
    if not owner:
        return cloud
    return with_ghosts(
        cloud, np.concatenate(owner), np.concatenate(positions), np.concatenate(turns)
    )
