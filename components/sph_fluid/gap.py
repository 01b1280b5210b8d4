"""Films of water in gaps too narrow for a particle; imported only by a scene that asks.

Between two faces nearer than WIDEST spacings lies a film that the particles cannot show. It is
filled from its rim, where it has the pressure of the fluid outside (none where that is dry), and
pushes its faces apart, one as much as the other. Reynolds' equation of lubrication,

    ∂(θw)/∂t = ∇·(K ∇(p - ρ₀ g·r)),    K = w³/(12μ),    p ≥ 0,  θ ≤ 1,  p (1 - θ) = 0,

says how fast the share θ of the width w that is full of water grows, and with which pressure: a
film that is not full has none (Elrod, ASME J. Lubr. Technol. 103 (1981) 350), faces that part
draw it down and faces that close press it up. Water does not flow in faster than the pressure at
the rim can drive it, √(2p/ρ₀): this bounds K in wide gaps. The film's own mass is left out.
"""

from dataclasses import dataclass

import numpy as np
from numba import njit

from quintet.components.shared.neighbours import FAST
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import Array, State, Whole

WIDEST = 0.49  # spacings, of the gaps that are films: particles get into wider ones, and push
WATER = 1e-3  # Pa s, its viscosity
OUTERMOST = 2.2  # spacings, between a particle of the first layer and its mirror point, at most
ASIDE = 1.01  # spacings, how far beside each other two facing particles may be
BESIDE = 1.2  # spacings, between neighbours in a film: those on its square lattice
MOST = 8  # of them
LARGEST = 0.1  # of the speed of sound, velocity: a pressure above ρu² is sound, not flow
RIM = 0.2  # spacings, from a particle of the film to the mean of its neighbours, beyond which
# it stands at the rim
SWEEPS = 20  # over the film in each step; it starts from the last step's pressure


@dataclass(slots=True)
class Film:
    """Samples that face another surface across a narrow gap; each pair of faces counts once."""

    sample: Whole  # (m,) number of the sample
    facing: Whole  # (m,) sample that it faces; -1 for a wall
    row: Whole  # (m,) its row in the boundary
    across: Whole  # (m,) row in the boundary of what it faces
    rim: Array  # (m,) whether it is at the film's rim
    size: Array  # (m,) m, of the film that it belongs to
    begin: Whole  # (m + 1,) where its neighbours in the film stand in `near`
    near: Whole  # rows of the film


def film(state: State, body: Array, params: SphFluidParams) -> Film:
    """Find where samples face walls, or samples of a body with a lower number.

    As the neighbour lists do, it goes by where all was when they were made, so that a state that
    is loaded finds the same films.
    """
    spacing, split = params.spacing, state.fluid
    place = state.reference[split : len(state.place)]
    off = state.reference[len(state.place) :] - place
    outer = np.einsum("nd,nd->n", off, off) < (OUTERMOST * spacing) ** 2
    samples = np.flatnonzero(outer & (state.sample >= 0))
    samples = samples[np.argsort(state.sample[samples])]
    low, high = place[samples].min(axis=0), place[samples].max(axis=0)
    room = 4.0 * spacing
    near = ((place > low - room) & (place < high + room)).all(axis=1)
    others = np.flatnonzero(outer & near)
    owner = np.where(state.sample >= 0, body[np.maximum(state.sample, 0)], -1.0)
    partner = np.full(len(samples), -1)
    face(
        place[samples], off[samples], owner[samples],
        place[others], off[others], owner[others], spacing, partner,
    )  # fmt: skip
    mine, theirs = samples[partner >= 0], others[partner[partner >= 0]]
    away = off[theirs] / np.linalg.norm(off[theirs], axis=1)[:, None]
    count = np.zeros(len(mine), np.int64)
    table = np.zeros((len(mine), MOST), np.int64)
    join(place[mine], away, owner[mine], owner[theirs], BESIDE * spacing, count, table)
    begin = np.concatenate([[0], np.cumsum(count)])
    pairs = np.stack([owner[mine], owner[theirs]], axis=1)
    _, which, members = np.unique(pairs, axis=0, return_inverse=True, return_counts=True)
    listed = table[np.arange(MOST) < count[:, None]]
    return Film(
        sample=state.sample[mine],
        facing=state.sample[theirs],
        row=mine,
        across=theirs,
        rim=_rim(place[mine], begin, listed, RIM * spacing),
        size=spacing * np.sqrt(members[which.reshape(-1)]),
        begin=begin,
        near=listed,
    )


def _rim(place: Array, begin: Whole, near: Whole, apart: float) -> Array:
    rim = np.ones(len(place), bool)
    for row in range(len(place)):
        some = near[begin[row] : begin[row + 1]]
        if len(some):
            aside = place[some].mean(axis=0) - place[row]
            rim[row] = np.linalg.norm(aside) > apart
    return rim


@njit(**FAST)
def face(
    place: Array, off: Array, owner: Array, other_place: Array, other_off: Array,
    other_owner: Array, spacing: float, partner: Whole,
) -> None:  # fmt: skip
    """Write the particle that each faces across a narrow gap; -1: none.

    Points lie half of `off` below their faces.
    """
    for i in range(place.shape[0]):
        best = (ASIDE * spacing) ** 2
        for k in range(other_place.shape[0]):
            if other_owner[k] >= owner[i]:
                continue
            size, against = 0.0, 0.0
            for d in range(3):
                size += other_off[k, d] ** 2
                against += off[i, d] * other_off[k, d]
            if against >= 0.0:
                continue
            r2, ahead, gap = 0.0, 0.0, 0.0
            inverse = 1.0 / np.sqrt(size)
            for d in range(3):
                apart = place[i, d] - other_place[k, d]
                r2 += apart * apart
                ahead += apart * other_off[k, d] * inverse
                gap += (apart + 0.5 * (off[i, d] - other_off[k, d])) * other_off[k, d] * inverse
            aside = r2 - ahead * ahead
            if aside < best and -0.5 * spacing < gap < WIDEST * spacing:
                best = aside
                partner[i] = k


@njit(**FAST)
def join(
    place: Array, away: Array, owner: Array, other: Array, reach: float, count: Whole,
    table: Whole,
) -> None:  # fmt: skip
    """Write the neighbours of each particle in its film, the gap between the same two faces."""
    for i in range(place.shape[0]):
        for j in range(place.shape[0]):
            if i == j or owner[i] != owner[j] or other[i] != other[j]:
                continue
            r2, along = 0.0, 0.0
            for d in range(3):
                r2 += (place[i, d] - place[j, d]) ** 2
                along += away[i, d] * away[j, d]
            if r2 < reach * reach and along > 0.9 and count[i] < table.shape[1]:
                table[i, count[i]] = j
                count[i] += 1


@njit(**FAST)
def flow(
    rim: Array, begin: Whole, near: Whole, width: Array, ease: Array, place: Array,
    outside: Array, stored: Array, cell: float, weight: tuple[float, float, float],
    sweeps: int, pressure: Array, share: Array,
) -> None:  # fmt: skip
    """Write pressure [Pa] and full share of a film at a step's end, by Gauss and Seidel.

    `ease` is K [m4 s/kg], `stored` the water per area at the step's beginning [m], `cell` the area
    of a sample over the step [m2/s], `weight` ρ₀ g.
    """
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
                path = 0.5 * (ease[i] + ease[j])
                head = 0.0
                for d in range(3):
                    head += weight[d] * (place[i, d] - place[j, d])
                # What is not full has no pressure to drive anything out.
                if pressure[j] > 0.0:
                    brought += path * (pressure[j] + head)
                paths += path
            full = brought - cell * (width[i] - stored[i])
            pressure[i] = max(full / paths, 0.0) if paths > 0.0 else 0.0
            filled = (stored[i] + brought / cell) / width[i]
            share[i] = 1.0 if pressure[i] > 0.0 else min(filled, 1.0)


def push(film: Film, state: State, dt: float, params: SphFluidParams) -> None:
    """Advance the film by a step [s], and add its push to the samples' force."""
    spacing, density = params.spacing, params.density
    place, mirror = state.place[state.fluid :], state.mirror
    term = state.motion[state.fluid :, 3]
    off, back = (mirror[row] - place[row, :3] for row in (film.row, film.across))
    away = back / np.linalg.norm(back, axis=1)[:, None]
    on_face = place[film.row, :3] + 0.5 * off
    apart = on_face - place[film.across, :3] - 0.5 * back
    gap = np.einsum("nd,nd->n", apart, away)
    width = np.maximum(gap, params.roughness)
    weight = density * np.array(params.gravity)
    outside = term[film.row] * place[film.row, 3] ** 2
    outside = np.where(outside > 0.0, outside + 0.5 * off @ weight, 0.0)
    outside = np.minimum(outside, density * (LARGEST * params.sound_speed) ** 2)
    driving = max(float(outside[film.rim].max(initial=0.0)), 1.0)
    bound = width * film.size * np.sqrt(2.0 / (density * driving))
    ease = np.minimum(width**3 / (12.0 * WATER), bound)
    pressure, share, before = state.film[film.sample].T.copy()
    known = before > 0.0
    stored = np.where(known, share * before, 0.0)
    arrays = (film.rim, film.begin, film.near, width, ease, on_face, outside, stored)
    x, y, z = weight.tolist()
    flow(*arrays, spacing**2 / dt, (x, y, z), SWEEPS, pressure, share)
    state.film[:] = 0.0
    state.film[film.sample] = np.stack([pressure, share, width], axis=1)
    # A sample half a spacing below a face is as far from its mirror point as its cell is wide; on
    # edges and corners that vector has such a part for each face.
    area = -spacing * np.minimum(np.einsum("nd,nd->n", off, away), 0.0)
    force = (pressure * area)[:, None] * away
    np.add.at(state.force, film.sample, force)
    bodies = film.facing >= 0
    np.add.at(state.force, film.facing[bodies], -force[bodies])
