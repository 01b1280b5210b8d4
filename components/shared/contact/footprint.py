"""Compiled search for what holds a particle: the face below it, or all faces that it covers."""

import math

import numpy as np
from numba import njit

from quintet.components.shared.contact.search import (
    ON,
    SETTLED,
    Near,
    away_from,
    gap_of,
    nearest,
    nearest_from,
    normal_at,
    place_listed,
)
from quintet.components.shared.geometry.face_kernels import Array, Whole, foot_within, place_on
from quintet.components.shared.numba_options import EXACT, LANEWISE

BESIDE = 0.1  # of a radius: by how much the foot of one of its points may miss the point


@njit(**EXACT)
def measure(
    place: Array, radii: Array, near: Near, corner: Whole, position: Array, across: Whole,
    reach: float, slack: float, off: float,
) -> float:  # fmt: skip
    """Write gaps, normals, nodes and weights of particles near faces.

    Parameters
    ----------
    place : (n, 3 or more) float array, m
    radii : (n,) float array, m
    near : Near
        Written.
    corner : (m, 4) int array
        Nodes of the faces.
    position : (k, 3) float array, m
        Of the nodes.
    across : (2,) int array
        Points across a particle, along both directions.
    reach : float, m
        Largest diameter: particles that are less deep below a face count as passed through it.
    slack : float, m
        By which particles and faces may still approach each other, before others are near.
    off : float, 1
        Distance from a face at which particles touch it, over their radius: 1, or 0 of points of a
        surface.

    Returns
    -------
    float, 1
        Largest depth of particles that have passed through a face, over their radius.
    """
    room, n, at, passed = np.empty((3, 3)), np.empty(3), np.empty(3), 0.0
    place_listed(near, corner, position)
    for q in range(near.row.shape[0]):
        radius, gap = radii[near.row[q]], math.inf
        for d in range(3):
            at[d] = place[near.row[q], d]
        f, xi, eta = nearest(at, near, q, reach, slack, room)
        if f >= 0:
            gap = gap_of(at, near.x[f], radius, off * radius, room, n)
            if off == 0.0 and gap == math.inf:
                gap = behind_valley(at, f, near, q, radius, room, n)
            if gap < -2.0 * radius:
                passed, gap = max(passed, -gap / radius), math.inf
        if gap > radius:
            for c in range(near.weight.shape[1]):
                near.weight[q, c] = 0.0
        elif near.weight.shape[1] > 4:
            gap = hold(at, f, xi, eta, near, q, corner, position, across, radius, gap, room, n)
        else:
            write_shares(corner, near.listed[f], xi, eta, 1.0, near.nodes, near.weight, q, 0)
        near.gap[q] = gap
        for d in range(3):
            near.normal[q, d] = n[d]
    return passed


@njit(**LANEWISE)
def behind_valley(p, face, near, q, radius, room, n):  # type: ignore[no-untyped-def]
    """Gap [m] of a point below a listed face, and its direction, if it is behind a valley edge.

    Such a point has that edge as nearest point, on two faces at least, and lies below both; beside
    the border of a surface or a ridge it does not. It is pushed to the edge. `room` has the nearest
    point, as `foot_within` leaves it, and is overwritten.

    Returns
    -------
    float, m
        ∞ where it is not behind such an edge.
    """
    edge, normal, square, gap = np.empty(3), np.empty(3), 0.0, math.inf
    for d in range(3):
        edge[d] = room[0, d]
        square += (p[d] - edge[d]) ** 2
    distance = math.sqrt(square)
    for at in range(near.begin[q], near.begin[q + 1]):
        f = near.face[at]
        if f == face or away_from(p, near, f) > (distance + ON * radius) ** 2:
            continue
        foot_within(p, near.x[f], SETTLED, room)
        normal_at(near.x[f], room, normal)
        above, apart = 0.0, 0.0
        for d in range(3):
            above += (p[d] - room[0, d]) * normal[d]
            apart += (room[0, d] - edge[d]) ** 2
        if above < 0.0 and apart <= (ON * radius) ** 2:
            gap = -distance
    if gap < 0.0:
        for d in range(3):
            n[d] = (edge[d] - p[d]) / distance
    return gap


@njit(**LANEWISE)
def hold(p, f, xi, eta, near, q, corner, position, across, radius, gap, room, n):  # type: ignore[no-untyped-def]
    """Write the nodes that hold a particle on a listed face, and their shares; its gap [m].

    If all that it covers are faces, it is held at points across it, and its gap is the mean of
    theirs; else at its nearest point, at ξ and η.
    """
    nodes, weight = near.nodes, near.weight
    if spread_out(p, f, near, q, corner, across, radius, gap, room, n):
        gap = -radius
        for c in range(weight.shape[1]):
            for d in range(3):
                gap += weight[q, c] * n[d] * (p[d] - position[nodes[q, c], d])
    else:
        write_shares(corner, near.listed[f], xi, eta, 1.0, nodes, weight, q, 0)
        for c in range(4, weight.shape[1]):
            weight[q, c] = 0.0
    return gap


@njit(**LANEWISE)
def write_shares(corner, face, xi, eta, share, nodes, weight, q, at):  # type: ignore[no-untyped-def]
    """Write the nodes of a face, and shares of its shape functions at ξ and η, from `at` on."""
    for c in range(4):
        nodes[q, at + c] = corner[face, c]
    share *= 0.25
    weight[q, at], weight[q, at + 1] = (
        share * (1.0 - xi) * (1.0 - eta),
        share * (1.0 + xi) * (1.0 - eta),
    )
    weight[q, at + 2], weight[q, at + 3] = (
        share * (1.0 + xi) * (1.0 + eta),
        share * (1.0 - xi) * (1.0 + eta),
    )


@njit(**LANEWISE)
def spread_out(p, face, near, q, corner, across, radius, gap, room, n):  # type: ignore[no-untyped-def]
    """Hold a particle that lies on a face at the points across it.

    The points lie in the plane through its nearest point on the surface, normal to its direction
    from there, in rows along the face's first side and across it; of edges only along it. Each has
    the nearest face of its own. Where the surface bends by θ, a point at a distance s from the bend
    misses its foot by s sin²θ in that plane: it counts as on the face up to `BESIDE`.

    Parameters
    ----------
    across : two int
        Points along both directions.
    gap : float, m
        Between the particle and its face.

    Returns
    -------
    bool
        Whether all points lie on faces; what was written is of no use otherwise.
    """
    tangent, side, point = np.empty(3), np.empty(3), np.empty(3)
    along, square, at, all_on = 0.0, 0.0, 0, True
    for d in range(3):
        tangent[d] = near.x[face, 1, d] - near.x[face, 0, d]
        along += tangent[d] * n[d]
    for d in range(3):
        tangent[d] -= along * n[d]
        square += tangent[d] * tangent[d]
    for d in range(3):
        tangent[d] /= math.sqrt(square)
    for d in range(3):
        a, b = (d + 1) % 3, (d + 2) % 3
        side[d] = n[a] * tangent[b] - n[b] * tangent[a]
    for i in range(across[0]):
        for j in range(across[1]):
            x, y = (2 * i + 1) / across[0] - 1.0, (2 * j + 1) / across[1] - 1.0
            for d in range(3):
                point[d] = p[d] - (radius + gap) * n[d] + radius * (x * tangent[d] + y * side[d])
            f, xi, eta, _ = nearest_from(point, face, near, q, room)
            place_on(near.x[f], xi, eta, room)
            above, away = 0.0, 0.0
            for d in range(3):
                above += (point[d] - room[0, d]) * n[d]
                away += (point[d] - room[0, d]) ** 2
            all_on &= away - above * above <= (BESIDE * radius) ** 2
            share = 1.0 / (across[0] * across[1])
            write_shares(corner, near.listed[f], xi, eta, share, near.nodes, near.weight, q, at)
            at += 4
    return all_on
