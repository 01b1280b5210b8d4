"""Which samples face another surface across a narrow gap; imported only by a scene that asks."""

from dataclasses import dataclass

import numpy as np

from quintet.components.sph_fluid.boundary.film_search import near
from quintet.components.sph_fluid.boundary.kernels.films import (
    ASIDE,
    OUTERMOST,
    WIDEST,
    add_own_volume,
    face_normals,
    find_partners,
    list_film,
)
from quintet.components.sph_fluid.boundary.samples import Samples
from quintet.components.sph_fluid.laws import Constants
from quintet.components.sph_fluid.state import Array, State, Whole

BESIDE = 1.2  # spacings, between neighbours in a film: those on its square lattice
MOST = 8  # of them
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
    own_share: Array  # (m,) Σ V W of its own body's samples, around the middle of that cell
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
    own_share = np.zeros(len(mine))
    felt = near(foot, position[rows], BEYOND * constants.smoothing.support)
    add_own_volume(
        foot, owner[mine], position[rows], owner[rows], samples.volume, felt, constants, own_share
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
        own_share=own_share,
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
