"""Loops of films in narrow gaps: their places, their neighbours, their pressure."""

from typing import NamedTuple

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import EXACT, FAST
from quintet.components.shared.search.cells import REACH, Grid
from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.smoothing.smoothing import kernel
from quintet.components.sph_fluid.laws import Constants
from quintet.components.sph_fluid.state import Array, Whole

WIDEST = 1.25  # spacings, of the gaps that are films: in wider ones particles press enough
OUTERMOST = 2.2  # spacings, between a particle of the first layer and its mirror point, at most
ASIDE = 0.75  # spacings, how far beside each other two facing particles may be
NEARLY = 1e-3  # of a vector's square: less makes no difference between directions


class Near(NamedTuple):
    """For each of m places, the numbers of the points that are near, in their order."""

    begin: Whole  # (m + 1,)
    point: Whole


@njit(**EXACT)
def list_near(
    places: Array, cell: Whole, points: Array, start: Whole, order: Whole, grid: Grid,
    reach2: float, begin: Whole, listed: Whole,
) -> int:  # fmt: skip
    """Write the lists of `near`; how many numbers they have, or -1 where there is no space."""
    nx, ny, nz = grid.nx, grid.ny, grid.nz
    count = 0
    for i in range(places.shape[0]):
        begin[i] = count
        c = cell[i]
        if c == nx * ny * nz:
            continue
        cx, cy, cz = c % nx, (c // nx) % ny, c // (nx * ny)
        low, high = max(cx - REACH, 0), min(cx + REACH, nx - 1)
        for kz in range(max(cz - REACH, 0), min(cz + REACH, nz - 1) + 1):
            for ky in range(max(cy - REACH, 0), min(cy + REACH, ny - 1) + 1):
                row = nx * (ky + ny * kz)
                for k in range(start[row + low], start[row + high + 1]):
                    j, r2 = order[k], 0.0
                    for d in range(3):
                        r2 += (places[i, d] - points[j, d]) ** 2
                    if r2 < reach2:
                        if count == listed.shape[0]:
                            return -1
                        listed[count] = j
                        count += 1
        listed[begin[i] : count].sort()
    begin[places.shape[0]] = count
    return count


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


@njit(**EXACT)
def face_normals(off: Array, back: Array) -> Array:
    """Normals (m, 3) of the faces across, from vectors (m, 3) m out of both faces of films."""
    normals = np.empty_like(off)
    for i in range(off.shape[0]):
        ax, ay, az, bx, by, bz = off[i, 0], off[i, 1], off[i, 2], back[i, 0], back[i, 1], back[i, 2]
        normals[i, 0], normals[i, 1], normals[i, 2] = face_normal(ax, ay, az, bx, by, bz)
    return normals


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
    constants: Constants, own_share: Array,
) -> None:  # fmt: skip
    """Add Σ V W of the samples of the same body around points (m, 3) m."""
    for i in range(foot.shape[0]):
        for k in felt.point[felt.begin[i] : felt.begin[i + 1]]:
            if owners[k] == owner[i]:
                r2 = 0.0
                for d in range(3):
                    r2 += (foot[i, d] - position[k, d]) ** 2
                own_share[i] += kernel(r2, constants.smoothing) * volume[k]


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


class FilmPlaces(NamedTuple):
    """Places of films, one for each sample that faces another surface."""

    rim: Array  # (m,) whether it has the pressure outside
    begin: Whole  # (m + 1,) where its neighbours in the film stand in `near`
    near: Whole
    width: Array  # (m,) m
    position: Array  # (m, 3) m
    outside: Array  # (m,) Pa
    stored: Array  # (m,) m, water per area at the step's beginning
    transmissivity: Array  # (m,) m4 s/kg, K = w³/(12μ), bounded


@njit(**FAST)
def solve_reynolds(
    places: FilmPlaces, cell: float, weight: tuple[float, float, float], sweeps: int,
    pressure: Array, share: Array,
) -> None:  # fmt: skip
    """Write pressure and full share of films at a step's end, by Gauss and Seidel.

    Parameters
    ----------
    places : FilmPlaces
    cell : float, m2/s
        Area of a sample over the step.
    weight : three floats, N/m3
        ρ₀ g.
    sweeps : int
    pressure, share : (m,) float arrays, Pa, 1
        Of the last step; written.

    References
    ----------
    Elrod, ASME J. Lubr. Technol. 103 (1981) 350.
    """
    rim, begin, near, width, position, outside, stored, transmissivity = places
    for i in range(rim.shape[0]):
        if rim[i]:
            pressure[i] = outside[i]
            share[i] = 1.0 if outside[i] > 0.0 else 0.0
    for _ in range(sweeps):
        for i in range(rim.shape[0]):
            if rim[i]:
                continue
            brought, paths = 0.0, 0.0
            for k in range(begin[i], begin[i + 1]):
                j = near[k]
                path = 0.5 * (transmissivity[i] + transmissivity[j])
                head = 0.0
                for d in range(3):
                    head += weight[d] * (position[i, d] - position[j, d])
                # What is not full has no pressure to drive anything out.
                if pressure[j] > 0.0:
                    brought += path * (pressure[j] + head)
                paths += path
            full = brought - cell * (width[i] - stored[i])
            pressure[i] = max(full / paths, 0.0) if paths > 0.0 else 0.0
            filled = (stored[i] + brought / cell) / width[i]
            share[i] = 1.0 if pressure[i] > 0.0 else min(filled, 1.0)


@njit(**FAST)
def write_fluid_share(
    row: Whole, face: Array, split: int, position: Array, lists: Lists, constants: Constants,
    share: Array,
) -> None:  # fmt: skip
    """Write Σ V W of the fluid around points (m, 3) m of faces, by the lists of mirror points."""
    begin, _, end, neighbour = lists
    for s in range(row.shape[0]):
        i = split + row[s]
        share[s] = 0.0
        for k in range(np.uint64(begin[i]), np.uint64(end[i])):
            j = np.uint64(neighbour[k])
            r2 = 0.0
            for d in range(3):
                r2 += (face[s, d] - position[j, d]) ** 2
            share[s] += kernel(r2, constants.smoothing) * constants.mass / position[j, 3]
