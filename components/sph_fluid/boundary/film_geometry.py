"""Which samples face another surface across a narrow gap; imported only by a scene that asks."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

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
from quintet.components.sph_fluid.ranks.method import Ranks
from quintet.components.sph_fluid.state import Array, State, Whole

BESIDE = 1.2  # spacings, between neighbours in a film: those on its square lattice
MOST = 8  # of them
BEYOND = 1.0 + 1e-9  # times a reach: what is listed for it, rounding included
MARGIN = 4.0  # spacings, around all samples, that faces of their films are within
RIM = 0.2  # spacings, from a particle of the film to the mean of its neighbours, beyond which
# it stands at the rim


@dataclass(slots=True)
class Films:
    """Samples that face another surface across a narrow gap; each pair of faces counts once."""

    sample: Whole  # (m,) number of the sample
    facing: Whole  # (m,) sample that it faces; -1 for a wall
    row: Whole  # (m,) its row of `Faces`
    across: Whole  # (m,) row of `Faces` of what it faces
    area: Array  # (m,) m2, of its cell in the face
    own_share: Array  # (m,) Σ V W of its own body's samples, around the middle of that cell
    rim: Array  # (m,) whether it is at the film's rim
    size: Array  # (m,) m, of the film that it belongs to
    begin: Whole  # (m + 1,) where its neighbours in the film stand in `near`
    near: Whole  # rows of the film


class Faces(NamedTuple):
    """All samples, and the walls' outermost layer near them, of all ranks and in their order."""

    position: Array  # (n, 3) m
    normal: Array  # (n, 3) m, to the mirror point
    outermost: NDArray[np.bool_]  # (n,) whether it is next to the surface
    sample: Whole  # (n,) number of the sample; -1 for walls
    rank: Whole  # (n,) that owns it
    row: Whole  # (n,) in the boundary of that rank


def find_faces(state: State, ranks: Ranks, spacing: float) -> Faces:
    """Find the faces that films may lie between.

    As the neighbour lists do, it goes by where all was when they were made, so that a state that
    is loaded finds the same films.
    """
    places, is_sample = state.reference[state.fluid : state.particles], state.sample >= 0
    ends = _ends(places[is_sample], ranks)
    around = np.flatnonzero(_is_between(places, ends, MARGIN * spacing))
    position = places[around]
    normal = state.reference[state.particles + around] - position
    outermost = np.einsum("nd,nd->n", normal, normal) < (OUTERMOST * spacing) ** 2
    chosen = outermost | is_sample[around]
    rows = around[chosen]
    numbers = np.column_stack([outermost[chosen], state.sample[rows], rows])
    numbers = np.column_stack([numbers, np.full(len(rows), ranks.rank)]).astype(float)
    columns = np.concatenate([position[chosen], normal[chosen], numbers], axis=1)
    of_all = ranks.all_rows(ranks.boundary_keys(state)[rows], columns)
    outer, sample, row, rank = of_all[:, 6:].T.astype(np.int64)
    return Faces(of_all[:, :3].copy(), of_all[:, 3:6].copy(), outer > 0, sample, rank, row)


def _ends(points: Array, ranks: Ranks) -> Array:
    """Lowest and highest corner (2, 3) m of points (n, 3) m of all ranks."""
    both = np.concatenate([-points, points], axis=1)
    greatest = np.array(ranks.greatest(*both.max(axis=0, initial=-np.inf).tolist()))
    return np.array([-greatest[:3], greatest[3:]])


def _is_between(points: Array, ends: Array, margin: float) -> NDArray[np.bool_]:
    """Which points (n, 3) m are between two corners (2, 3) m, or nearer to them than a margin."""
    low, high = ends[0] - margin, ends[1] + margin
    is_inside = np.ones(len(points), bool)
    for axis in range(3):  # a column after the other takes half the time
        column = points[:, axis]
        is_inside &= (column > low[axis]) & (column < high[axis])
    return is_inside


def find_films(faces: Faces, samples: Samples, spacing: float, constants: Constants) -> Films:
    """Find where samples face walls, or samples of a body with a lower number."""
    position, normal, outermost, sample, *_ = faces
    rows = np.flatnonzero(sample >= 0)
    rows = rows[np.argsort(sample[rows])]
    first = rows[outermost[rows]]
    ends = np.array([position[first].min(axis=0), position[first].max(axis=0)])
    second = np.flatnonzero(outermost & _is_between(position, ends, MARGIN * spacing))
    owner = np.where(sample >= 0, samples.body[np.maximum(sample, 0)], -1.0)
    partner = np.full(len(first), -1)
    furthest = BEYOND * spacing * float(np.hypot(WIDEST + OUTERMOST, ASIDE))
    find_partners(
        position[first], normal[first], owner[first],
        position[second], normal[second], owner[second],
        near(position[first], position[second], furthest), spacing, partner,
    )  # fmt: skip
    sample_rows, partner_rows = first[partner >= 0], second[partner[partner >= 0]]
    direction = face_normals(normal[sample_rows], normal[partner_rows])
    below = np.einsum("nd,nd->n", normal[sample_rows], direction)
    foot = position[sample_rows] + 0.5 * below[:, None] * direction
    own_share = np.zeros(len(sample_rows))
    felt = near(foot, position[rows], BEYOND * constants.smoothing.support)
    add_own_volume(
        foot,
        owner[sample_rows],
        position[rows],
        owner[rows],
        samples.volume,
        felt,
        constants,
        own_share,
    )
    count = np.zeros(len(sample_rows), np.int64)
    table = np.zeros((len(sample_rows), MOST), np.int64)
    reach = BESIDE * spacing
    beside = near(position[sample_rows], position[sample_rows], BEYOND * reach)
    list_film(
        position[sample_rows],
        direction,
        owner[sample_rows],
        owner[partner_rows],
        beside,
        reach,
        count,
        table,
    )
    begin = np.concatenate([[0], np.cumsum(count)])
    pairs = np.stack([owner[sample_rows], owner[partner_rows]], axis=1)
    _, pair, members = np.unique(pairs, axis=0, return_inverse=True, return_counts=True)
    listed = table[np.arange(MOST) < count[:, None]]
    return Films(
        sample=sample[sample_rows],
        facing=sample[partner_rows],
        row=sample_rows,
        across=partner_rows,
        area=samples.volume[sample[sample_rows]] / np.abs(below),
        own_share=own_share,
        rim=at_rim(position[sample_rows], begin, listed, RIM * spacing),
        size=spacing * np.sqrt(members[pair.reshape(-1)]),
        begin=begin,
        near=listed,
    )


def at_rim(position: Array, begin: Whole, near: Whole, distance: float) -> Array:
    """Which rows of films (m, 3) m are further than a distance [m] from their neighbours' mean."""
    count = np.diff(begin)
    row = np.repeat(np.arange(len(position)), count)
    sums = [np.bincount(row, position[near, d], len(position)) for d in range(3)]
    offset = np.stack(sums, axis=1) - count[:, None] * position
    return (count == 0) | (np.linalg.norm(offset, axis=1) > distance * count)
