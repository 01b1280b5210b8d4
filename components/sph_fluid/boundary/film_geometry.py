"""Which samples face another surface across a narrow gap; imported only by a scene that asks."""

from dataclasses import dataclass

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import FAST
from quintet.components.shared.smoothing.smoothing import kernel
from quintet.components.sph_fluid.boundary.film_search import Near, near
from quintet.components.sph_fluid.boundary.samples import Samples
from quintet.components.sph_fluid.laws import Constants
from quintet.components.sph_fluid.state import Array, State, Whole

WIDEST = 1.25  # spacings, of the gaps that are films: in wider ones particles press enough
OUTERMOST = 2.2  # spacings, between a particle of the first layer and its mirror point, at most
ASIDE = 0.75  # spacings, how far beside each other two facing particles may be
BESIDE = 1.2  # spacings, between neighbours in a film: those on its square lattice
MOST = 8  # of them
NEARLY = 1e-3  # of a vector's square: less makes no difference between directions
BEYOND = 1.0 + 1e-9  # times a reach: what is listed for it, rounding included
RIM = 0.2  # spacings, from a particle of the film to the mean of its neighbours, beyond which
# it stands at the rim


@dataclass(slots=True)
class Films:
    """Samples that face another surface across a narrow gap; each pair of faces counts once."""

    sample: Whole  # (m,) number of the sample
    facing: Whole  # (m,) sample that it faces; -1 for a wall
    row: Whole  # (m,) its row in the boundary
    across: Whole  # (m,) row in the boundary of what it faces
    area: Array  # (m,) m2, of its cell in the face
    own: Array  # (m,) Σ V W of its own body's samples, around the middle of that cell
    rim: Array  # (m,) whether it is at the film's rim
    size: Array  # (m,) m, of the film that it belongs to
    begin: Whole  # (m + 1,) where its neighbours in the film stand in `near`
    near: Whole  # rows of the film


def find_films(state: State, samples: Samples, spacing: float, constants: Constants) -> Films:
    """Find where samples face walls, or samples of a body with a lower number.

    As the neighbour lists do, it goes by where all was when they were made, so that a state that
    is loaded finds the same films.
    """
    position = state.reference[state.fluid : state.particles]
    normal = state.reference[state.particles :] - position  # to mirror points
    outermost = np.einsum("nd,nd->n", normal, normal) < (OUTERMOST * spacing) ** 2
    rows = np.flatnonzero(state.sample >= 0)
    rows = rows[np.argsort(state.sample[rows])]
    first = rows[outermost[rows]]
    low, high = position[first].min(axis=0), position[first].max(axis=0)
    margin = 4.0 * spacing
    around = ((position > low - margin) & (position < high + margin)).all(axis=1)
    second = np.flatnonzero(outermost & around)
    owner = np.where(state.sample >= 0, samples.body[np.maximum(state.sample, 0)], -1.0)
    partner = np.full(len(first), -1)
    furthest = BEYOND * spacing * float(np.hypot(WIDEST + OUTERMOST, ASIDE))
    find_partners(
        position[first], normal[first], owner[first],
        position[second], normal[second], owner[second],
        near(position[first], position[second], furthest), spacing, partner,
    )  # fmt: skip
    mine, theirs = first[partner >= 0], second[partner[partner >= 0]]
    across = face_normals(normal[mine], normal[theirs])
    below = np.einsum("nd,nd->n", normal[mine], across)
    foot = position[mine] + 0.5 * below[:, None] * across
    own = np.zeros(len(mine))
    felt = near(foot, position[rows], BEYOND * constants.smoothing.support)
    add_own_volume(
        foot, owner[mine], position[rows], owner[rows], samples.volume, felt, constants, own
    )
    count = np.zeros(len(mine), np.int64)
    table = np.zeros((len(mine), MOST), np.int64)
    reach = BESIDE * spacing
    beside = near(position[mine], position[mine], BEYOND * reach)
    list_film(position[mine], across, owner[mine], owner[theirs], beside, reach, count, table)
    begin = np.concatenate([[0], np.cumsum(count)])
    pairs = np.stack([owner[mine], owner[theirs]], axis=1)
    _, which, members = np.unique(pairs, axis=0, return_inverse=True, return_counts=True)
    listed = table[np.arange(MOST) < count[:, None]]
    return Films(
        sample=state.sample[mine],
        facing=state.sample[theirs],
        row=mine,
        across=theirs,
        area=samples.volume[state.sample[mine]] / np.abs(below),
        own=own,
        rim=at_rim(position[mine], begin, listed, RIM * spacing),
        size=spacing * np.sqrt(members[which.reshape(-1)]),
        begin=begin,
        near=listed,
    )


def at_rim(position: Array, begin: Whole, near: Whole, distance: float) -> Array:
    """Which rows of films (m, 3) m are further than a distance [m] from their neighbours' mean."""
    count = np.diff(begin)
    row = np.repeat(np.arange(len(position)), count)
    sums = [np.bincount(row, position[near, d], len(position)) for d in range(3)]
    off = np.stack(sums, axis=1) - count[:, None] * position
    return (count == 0) | (np.linalg.norm(off, axis=1) > distance * count)


@njit(inline="always")
def face_normal(ax, ay, az, bx, by, bz):  # type: ignore[no-untyped-def]
    """Unit normal of a face b against which another, a, lies; none if they do not.

    Vectors go out of the faces to the mirror points. On edges and corners they have a part for
    each face that meets there: of one vector, the other turned round, and their mean, the shortest
    has least of what is not common.
    """
    a2, b2 = ax * ax + ay * ay + az * az, bx * bx + by * by + bz * bz
    x, y, z = 0.5 * (bx - ax), 0.5 * (by - ay), 0.5 * (bz - az)
    shortest = x * x + y * y + z * z + NEARLY * b2
    if a2 < min(shortest, b2):
        x, y, z = -ax, -ay, -az
    elif b2 < shortest:
        x, y, z = bx, by, bz
    size = np.sqrt(x * x + y * y + z * z)
    if size == 0.0 or ax * x + ay * y + az * z >= 0.0 or bx * x + by * y + bz * z <= 0.0:
        return 0.0, 0.0, 0.0
    return x / size, y / size, z / size


@njit(**FAST)
def face_normals(off: Array, back: Array) -> Array:
    """Normals (m, 3) of the faces across, from vectors (m, 3) m out of both faces of films."""
    found = np.empty_like(off)
    for i in range(off.shape[0]):
        ax, ay, az, bx, by, bz = off[i, 0], off[i, 1], off[i, 2], back[i, 0], back[i, 1], back[i, 2]
        found[i, 0], found[i, 1], found[i, 2] = face_normal(ax, ay, az, bx, by, bz)
    return found


@njit(**FAST)
def find_partners(
    position: Array, normal: Array, owner: Array, other_position: Array, other_normal: Array,
    other_owner: Array, close: Near, spacing: float, partner: Whole,
) -> None:  # fmt: skip
    """Write the particle that each faces across a narrow gap; -1: none.

    Points lie half of `normal` below their faces; `close` lists those that may be meant.
    """
    furthest2 = (WIDEST + OUTERMOST) ** 2 * spacing**2 + (ASIDE * spacing) ** 2
    for i in range(position.shape[0]):
        best = (ASIDE * spacing) ** 2
        ax, ay, az = normal[i, 0], normal[i, 1], normal[i, 2]
        for k in close.point[close.begin[i] : close.begin[i + 1]]:
            dx = position[i, 0] - other_position[k, 0]
            dy = position[i, 1] - other_position[k, 1]
            dz = position[i, 2] - other_position[k, 2]
            r2 = dx * dx + dy * dy + dz * dz
            if r2 > furthest2 or other_owner[k] >= owner[i]:
                continue
            bx, by, bz = other_normal[k, 0], other_normal[k, 1], other_normal[k, 2]
            x, y, z = face_normal(ax, ay, az, bx, by, bz)
            ahead = dx * x + dy * y + dz * z
            gap = ahead + 0.5 * ((ax - bx) * x + (ay - by) * y + (az - bz) * z)
            aside = r2 - ahead * ahead
            if aside < best and -0.5 * spacing < gap < WIDEST * spacing:
                best = aside
                partner[i] = k


@njit(**FAST)
def add_own_volume(
    foot: Array, owner: Array, position: Array, owners: Array, volume: Array, felt: Near,
    constants: Constants, own: Array,
) -> None:  # fmt: skip
    """Add Σ V W of the samples of the same body around points (m, 3) m."""
    for i in range(foot.shape[0]):
        for k in felt.point[felt.begin[i] : felt.begin[i + 1]]:
            if owners[k] == owner[i]:
                r2 = 0.0
                for d in range(3):
                    r2 += (foot[i, d] - position[k, d]) ** 2
                own[i] += kernel(r2, constants.smoothing) * volume[k]


@njit(**FAST)
def list_film(
    position: Array, across: Array, owner: Array, other: Array, beside: Near, reach: float,
    count: Whole, table: Whole,
) -> None:  # fmt: skip
    """Write the neighbours of each particle in its film, the gap between the same two faces."""
    for i in range(position.shape[0]):
        for j in beside.point[beside.begin[i] : beside.begin[i + 1]]:
            if i == j or owner[i] != owner[j] or other[i] != other[j]:
                continue
            r2, along = 0.0, 0.0
            for d in range(3):
                r2 += (position[i, d] - position[j, d]) ** 2
                along += across[i, d] * across[j, d]
            if r2 < reach * reach and along > 0.9 and count[i] < table.shape[1]:
                table[i, count[i]] = j
                count[i] += 1
