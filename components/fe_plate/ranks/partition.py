"""Which rank steps which blocks of elements, and its part of a structure."""

from collections.abc import Callable
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.fe_plate.build import Structure, targets
from quintet.components.fe_plate.meshes.mesh import Mesh
from quintet.components.fe_plate.state import LANES, Array, Index, Places, Span, Whole
from quintet.components.shared.domain.bisection import bisect
from quintet.interfaces.errors import SceneError


class Owners(NamedTuple):
    """Ranks that own each node and each block; a block's owner owns the first corner of it."""

    node: Whole  # (n,)
    block: Whole  # (b,)


class Part(NamedTuple):
    """What a rank computes, by numbers of the whole structure."""

    node: Whole  # (n,) nodes that it owns, rising, then the other corners of its blocks
    moving: int  # of them it owns
    block: Whole  # (b,) blocks that it steps, rising
    element: Whole  # (e,) elements whose block it owns, rising
    own_blocks: Whole  # (o,) rows of the blocks that it owns among these


def owners(built: Structure, ranks: int) -> Owners:
    """Share blocks out by bisection of space, and nodes to a rank with a block there.

    Of the nodes that two ranks share each owns half: both step about as many blocks of the other.
    Every rank computes the same.

    Raises
    ------
    SceneError
        If a rank would own no node.
    """
    model, blocks = built.model, len(built.model.filled)
    corner = model.corner.reshape(blocks, -1)
    place, inverse, weights = _cells(built)
    of_block = bisect(place, weights, ranks)[inverse]
    of_node = _node_owners(corner, of_block, len(built.mesh.node))
    fewest = int(np.bincount(of_node, minlength=ranks).min())
    if not fewest:
        raise SceneError(
            f"ranks: each must own a node of the mesh; of {ranks} ranks one owns none, for "
            f"{len(built.mesh.corner)} elements are only {blocks} blocks. Take fewer ranks."
        )
    return Owners(of_node, of_node[corner[:, 0]])


def _node_owners(corner: Index, of_block: Whole, nodes: int) -> Whole:
    """Ranks (nodes,) that own the nodes at the corners (b, k) of blocks with some owners (b,)."""
    lowest, highest = np.zeros((2, nodes), np.int64)
    ranks = range(int(of_block.max()) + 1)
    for rank in ranks:
        highest[corner[of_block == rank]] = rank
    for rank in reversed(ranks):
        lowest[corner[of_block == rank]] = rank
    shared = np.flatnonzero(lowest < highest)
    for pair in np.unique(np.stack([lowest[shared], highest[shared]], axis=1), axis=0):
        at = shared[(lowest[shared] == pair[0]) & (highest[shared] == pair[1])]
        lowest[at[len(at) // 2 :]] = pair[1]
    return lowest


def _cells(built: Structure) -> tuple[Whole, Whole, Array]:
    """Cells (c, 3) as large as most blocks are, the cell of each block, and elements in each.

    Axes stand in the order in which blocks are numbered, fastest first: of extents that are alike
    the last is cut, and a rank's blocks and nodes stand one after another.
    """
    model, blocks = built.model, len(built.model.filled)
    # Opposite corners of the elements of a block; all four of tetrahedra.
    opposite = [0, 1, 2, 3] if built.mesh.has_tetrahedra else [0, 6]
    ends = built.mesh.node[model.corner[:, opposite]].reshape(blocks, -1, 3)
    low, high = ends.min(axis=1), ends.max(axis=1)
    size = np.median(high - low, axis=0)
    size[size == 0.0] = 1.0
    cell = np.floor(0.5 * (low + high) / size).astype(np.int64)
    steps = np.count_nonzero(np.diff(cell, axis=0), axis=0)
    cell = cell[:, np.argsort(-steps, kind="stable")]
    place, inverse = np.unique(cell, axis=0, return_inverse=True)
    inverse = inverse.reshape(-1)
    weights = np.bincount(inverse, model.filled, len(place)).astype(np.float64)
    return place, inverse.astype(np.int64), weights


def part_of(built: Structure, owner: Owners, rank: int) -> tuple[Part, list[Span], list[Span]]:
    """What a rank computes, and the spans of its blocks: those stepped before copies come, others.

    The first are the longest run of blocks without copies: they stand one after another in memory,
    and few nodes have elements of both.
    """
    corner = built.model.corner.reshape(len(built.model.filled), -1)
    is_own = (owner.node == rank)[corner]
    block = np.flatnonzero(is_own.any(axis=1))
    corners = np.unique(corner[block]).astype(np.int64)
    moving = np.flatnonzero(owner.node == rank)
    node = np.concatenate([moving, corners[owner.node[corners] != rank]])
    block_of = built.places.point[:, 0] // LANES
    element = np.flatnonzero(owner.block[block_of] == rank)
    own_blocks = np.flatnonzero(owner.block[block] == rank)
    part = Part(node, len(moving), block, element, own_blocks)
    begin, end = _longest_run(is_own[block].all(axis=1))
    inner: list[Span] = []
    border: list[Span] = []
    for span in built.inner:
        first, last = np.searchsorted(block, (span.first, span.last)).tolist()
        cuts = [first, min(max(begin, first), last), min(max(end, first), last), last]
        before, run, after = (Span(span.part, *pair) for pair in pairwise(cuts))
        inner.append(run)
        border += [before, after]
    return part, inner, border


def at_once(inner: list[Span], border: list[Span]) -> list[Span]:
    """Spans of all blocks in the order of one rank, from the two lists of `part_of`."""
    befores, afters = border[::2], border[1::2]
    return [
        Span(run.part, before.first, after.last)
        for run, before, after in zip(inner, befores, afters, strict=True)
    ]


def _longest_run(chosen: NDArray[np.bool_]) -> tuple[int, int]:
    """First of the longest run of chosen rows (n,), and the row behind its last."""
    others = np.concatenate([[-1], np.flatnonzero(~chosen), [len(chosen)]])
    longest = int(np.argmax(np.diff(others)))
    return int(others[longest]) + 1, int(others[longest + 1])


def cut(
    built: Structure,
    part: Part,
    inner: list[Span],
    border: list[Span],
    ends: Callable[[int], list[int]],
) -> Structure:
    """Return the part of a structure, in the numbers of its own nodes, blocks and elements."""
    mesh, model, blocks = built.mesh, built.model, len(built.model.filled)
    row: Whole = np.full(len(mesh.node), -1)  # of each node
    row[part.node] = np.arange(len(part.node))
    block_row: Whole = np.full(blocks, -1)
    block_row[part.block] = np.arange(len(part.block))
    corners = model.corner.shape[1]  # of an element
    corner = model.corner.reshape(blocks, -1, corners)[part.block].reshape(-1, corners)
    corner = row[corner].astype(np.uint32)
    filled = model.filled[part.block]
    target, acts, parted = targets(corner, filled, [*inner, *border], ends, len(part.node))
    faces = np.flatnonzero(block_row[built.face_places.point[:, 0] // LANES] >= 0)
    face_row: Whole = np.full(len(mesh.side), -1)
    face_row[faces] = np.arange(len(faces))
    side = np.where(mesh.side[faces] < 0, -1, row[mesh.side[faces]])
    pressed = [face_row[numbers] for numbers in built.pressed]
    velocity = None if mesh.velocity is None else mesh.velocity[part.node]
    return built._replace(
        # Corners of elements stand in the model alone.
        mesh=Mesh(
            mesh.node[part.node], np.zeros((0, corners), np.int64), mesh.part[part.element], side,
            mesh.owner[faces], {}, {}, (), velocity,
        ),
        model=model._replace(
            corner=target[: len(corner)],
            target=target,
            acts=acts,
            filled=filled,
            volume=model.volume.reshape(blocks, LANES)[part.block].ravel(),
            inverse_mass=model.inverse_mass[part.node],
            free=model.free[part.node],
            moving=part.moving,
        ),
        parted=parted,
        places=_renumbered(built.places.subset(part.element), block_row),
        inner=inner,
        border=border,
        volume=built.volume[part.element],
        mass=built.mass[part.node],
        coupled=face_row[built.coupled],
        pressed=[rows[rows >= 0] for rows in pressed],
        face_places=_renumbered(built.face_places.subset(faces), block_row),
        element_mass=built.element_mass[part.element],
    )  # fmt: skip


def _renumbered(places: Places, block_row: Whole) -> Places:
    """Places in a rank's own blocks."""
    point = places.point
    return Places(LANES * block_row[point // LANES] + point % LANES, places.share)
