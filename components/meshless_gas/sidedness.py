"""One-sided stencils: nodes whose neighbours lie mostly on one side take more, or are refused.

The fluxes of first order, which remain at shocks, carry a wave along a unit vector a by the
neighbours upstream alone. Of a symmetric stencil these have half of the least squares:
2 Σ_{c_ij·a < 0} (a·c_ij)(a·r_ij) = 1. The largest departure from 1 over all a is the sidedness of
a node: 0 of a symmetric stencil, 1 of one that has nothing upstream.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.clouds.cloud import Cloud, Whole, is_advanced
from quintet.components.meshless_gas.kernels.sidedness import write_sidedness
from quintet.components.meshless_gas.kernels.stencils import write_coefficients
from quintet.components.meshless_gas.stencils import Stencils, stencils
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError

Rows = NDArray[np.int64]
Find = Callable[[Cloud, int, Team, Rows | None], Whole]

EVEN = 0.35  # greatest sidedness where the number of neighbours is chosen here
UNEVEN = 0.6  # greatest sidedness where the scene says how many neighbours there are
FEW = 0.01  # share of the nodes of layers, whose neighbours are fixed, that may have more
WORST = 0.9  # sidedness that no node may keep
TIE = 1e-6  # relative difference of distances that count as equal
BLOCK = {True: 8, False: 18}  # neighbours of a whole block of a lattice, in the plane and not


class Cure(NamedTuple):
    """Neighbours that surround the nodes, and what was changed for that."""

    stencils: Stencils
    completed: int  # nodes of which a shell of equal distances was completed
    extended: int  # nodes that were given more neighbours for their sidedness
    worst: float  # 1, greatest sidedness before


def directions(planar: bool) -> Array:
    """Unit vectors (a, 3) spread evenly over the plane or over all directions of space."""
    if planar:
        angle = 2.0 * np.pi * (np.arange(16) + 0.1) / 16
        return np.stack([np.cos(angle), np.zeros(16), np.sin(angle)], axis=1)
    count = np.arange(48) + 0.5
    polar, turn = np.arccos(1.0 - count / 24.0), np.pi * (1.0 + np.sqrt(5.0)) * count
    across = np.sin(polar)
    return np.stack([np.cos(turn) * across, np.sin(turn) * across, np.cos(polar)], axis=1)


def sidedness(cloud: Cloud, stencil: Stencils, rows: Rows, planar: bool, team: Team) -> Array:
    """Sidedness (m,) 1 of nodes (m,)."""
    sided = np.zeros(len(rows))
    team.run(
        write_sidedness, len(rows), rows, cloud.positions, *stencil, directions(planar), sided
    )  # fmt: skip
    return sided


def surround(
    cloud: Cloud, find: Find, count: int, is_lattice: bool, limit: float, planar: bool, team: Team
) -> Cure:
    """Find neighbours so that no advanced node's sidedness is above a limit.

    Parameters
    ----------
    cloud : Cloud
    find
        Finds the nearest neighbours of nodes; of all if no rows are given.
    count : int
        Neighbours of most nodes.
    is_lattice : bool
        Whether many distances are equal: all neighbours of one distance are then taken.
    limit : float, 1
        Of the sidedness above which a node takes more neighbours.
    planar : bool
    team : Team
    """
    near = find(cloud, count, team, None)
    rows = np.flatnonzero(is_advanced(cloud.kind[: cloud.nodes])).astype(np.int64)
    completed = 0
    if is_lattice:
        near, completed = _whole_shells(cloud, find, near, rows, planar, team)
    stencil = stencils(cloud, near, planar, team)
    sided = sidedness(cloud, stencil, rows, planar, team)
    worst = float(sided.max(initial=0.0))
    uneven = rows[sided > limit]
    if len(uneven):
        near, left = _extended(cloud, find, stencil, uneven, limit, planar, team)
        _refuse(cloud, uneven, left)
        stencil = stencils(cloud, near, planar, team)
    return Cure(stencil, completed, len(uneven), worst)


def _whole_shells(
    cloud: Cloud, find: Find, near: Whole, rows: Rows, planar: bool, team: Team
) -> tuple[Whole, int]:
    """Neighbours where all of one distance are taken, and of how many nodes some were left out."""
    count = near.shape[1]
    if count + 1 >= len(cloud.positions):
        return near, 0
    further = find(cloud, count + 1, team, None)
    away = _distance(cloud, rows, further[rows])
    cut = rows[away[:, count] <= (1.0 + TIE) * away[:, count - 1]]
    if not len(cut):
        return near, 0
    pool = find(cloud, _most(cloud, count, planar), team, cut)
    away = _distance(cloud, cut, pool)
    taken = (away <= (1.0 + TIE) * away[:, count - 1 : count]).sum(axis=1)
    return _with(near, cut, pool, taken), len(cut)


def _extended(
    cloud: Cloud,
    find: Find,
    stencil: Stencils,
    uneven: Rows,
    limit: float,
    planar: bool,
    team: Team,
) -> tuple[Whole, Array]:
    """Neighbours with the fewest of each uneven node that make it even, and its sidedness then."""
    near = stencil.neighbours
    fewest = int((near[uneven] != uneven[:, None]).sum(axis=1).min())
    pool = find(cloud, _most(cloud, fewest, planar), team, uneven)
    best, taken = np.full(len(uneven), np.inf), np.zeros(len(uneven), np.int64)
    waiting = np.arange(len(uneven))
    # Fewer are a last resort, as beside boundaries, beyond which far neighbours are on one side.
    fewer = range(4 if planar else 6, fewest)
    for many in (*range(fewest, pool.shape[1] + 1), *fewer):
        rows = uneven[waiting]
        sided = _sidedness_of(cloud, rows, pool[waiting, :many], planar, team)
        better = sided < best[waiting]
        best[waiting[better]], taken[waiting[better]] = sided[better], many
        waiting = waiting[best[waiting] > limit]
        if not len(waiting):
            break
    return _with(near, uneven, pool, taken), best


def _sidedness_of(cloud: Cloud, rows: Rows, near: Whole, planar: bool, team: Team) -> Array:
    """Sidedness (m,) of nodes (m,) with neighbours (m, K); infinite where these span no space."""
    places, whole = np.arange(len(rows)), len(rows)
    # The nodes of `rows` come first, so that arrays are no larger than needed.
    positions = np.concatenate([cloud.positions[rows], cloud.positions[near].reshape(-1, 3)])
    itself = whole + np.arange(near.size).reshape(near.shape)
    coefficients, quality = np.zeros((*near.shape, 3)), np.ones(whole)
    weight = cloud.weight[rows]
    team.run(
        write_coefficients, whole, places, positions, itself, weight, planar, coefficients, quality
    )
    sided = np.zeros(whole)
    team.run(
        write_sidedness, whole, places, positions, itself, coefficients, directions(planar), sided
    )
    return np.where(quality > 1e-3, sided, np.inf)


def _distance(cloud: Cloud, rows: Rows, near: Whole) -> Array:
    """Distances (m, K) 1 of neighbours, in the mean spacing of each pair."""
    arms = cloud.positions[near] - cloud.positions[rows, None]
    mean = 0.5 * (cloud.spacing[near] + cloud.spacing[rows, None])
    return np.asarray(np.sqrt((arms**2).sum(axis=2)) / mean)


def _most(cloud: Cloud, count: int, planar: bool) -> int:
    """How many neighbours are tried: up to 14, in space 34; farther ones blur what is sharp."""
    return min(2 * max(count, BLOCK[planar]) - 2, len(cloud.positions) - 1)


def _with(near: Whole, rows: Rows, pool: Whole, taken: NDArray[np.int64]) -> Whole:
    """Neighbours (n, K), of `rows` the first `taken` of a pool; padded with the node itself."""
    wide = max(near.shape[1], int(taken.max()))
    whole = np.repeat(np.arange(len(near), dtype=np.int32)[:, None], wide, axis=1)
    whole[:, : near.shape[1]] = near
    first = np.where(np.arange(wide) < taken[:, None], pool[:, :wide], rows[:, None])
    whole[rows] = first
    return whole


def _refuse(cloud: Cloud, rows: Rows, left: Array) -> None:
    """Refuse nodes that no number of neighbours surrounds."""
    bad = np.flatnonzero(left > WORST)
    if len(bad):
        place = np.array2string(cloud.positions[rows[bad[0]]], precision=4)
        raise SceneError(
            f"neighbours must surround each node; those of {len(bad)} nodes lie on one side, as of "
            f"that at {place} m (sidedness {left[bad[0]]:.2f}, at most {WORST:g}). Lower jitter, "
            "or make the box larger or finer."
        )


def doubts_of(cloud: Cloud, stencil: Stencils, planar: bool, team: Team) -> tuple[str, ...]:
    """Say that layers moved at random leave too many nodes with neighbours on one side."""
    rows = np.flatnonzero(is_advanced(cloud.kind[: cloud.nodes])).astype(np.int64)
    sided = sidedness(cloud, stencil, rows, planar, team)
    many = int((sided > UNEVEN).sum())
    if many <= FEW * len(rows):
        return ()
    return (
        f"{many} of {len(rows)} nodes have neighbours mostly on one side (sidedness up to "
        f"{sided.max():.2f}, at most {UNEVEN:g} of all but {FEW:.0%}): distances of shocks may be "
        "wrong by more than 10 %. Lower layers.jitter to 0.2 or less.",
    )


def notes_of(cure: Cure, count: int, nodes: int, planar: bool) -> tuple[str, ...]:
    """Say what was changed about the neighbours that a scene asks for."""
    most = cure.stencils.neighbours.shape[1]
    notes = []
    if cure.completed:
        notes.append(
            f"neighbours: the {count} nearest of {cure.completed} of {nodes} nodes leave out "
            f"others that are as near, on one side; all these were added, up to {most} neighbours. "
            f"Leave neighbours out, or say {BLOCK[planar]}, to compute faster."
        )
    if cure.extended:
        notes.append(
            f"neighbours: the {count} nearest of {cure.extended} of {nodes} nodes lie mostly on "
            f"one side (sidedness up to {cure.worst:.2f}, at most {UNEVEN:g}); these nodes have "
            f"now the nearest that surround them, at most {most}. Leave neighbours out, or lower "
            "jitter."
        )
    return tuple(notes)
