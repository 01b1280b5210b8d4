"""Rings about the z axis: neighbours are turned about it into the plane's surroundings.

A particle at the radius x stands for a ring. A pair sees n rings' cuts, turned by 2πk/n, each with
1/n of the ring's volume; n is the greater of the two rings' own numbers of cuts a smoothing length
apart, so that what one gets the other loses, along the axis to rounding. Near the axis the circle
is whole, elsewhere two cuts at either side are within reach.

Paper: Dyanov, Kazantsev & Chelakov (LOGOS), section 4, with n of the pair.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from quintet.components.shared.float_bits import number_of
from quintet.components.shared.numba_options import EXACT, FAST
from quintet.components.shared.packing import (
    PAIRS,
    empty_rows,
    longest_list,
    out_of_reach,
)
from quintet.components.shared.search.neighbours import Lists
from quintet.components.sph_solid.kernels.pairs import Forces
from quintet.components.sph_solid.kernels.sums import (
    corrected,
    own_stress,
    sum_forces,
    sum_gradients,
)
from quintet.components.sph_solid.laws import PairLaw
from quintet.components.sph_solid.state import Array, Whole

FEWEST = 6  # cuts of a ring
CLOSE = 2.0  # smoothing lengths from the axis within which the circle is whole
WHOLE = 64  # more cuts than a ring has that is near one so close


class Doubles(NamedTuple):
    """Cuts of rings that are near each particle."""

    begin: Whole  # (n,)
    end: Whole  # (n,)
    ring: NDArray[np.int32]  # (any,) particle
    row: NDArray[np.int32]  # (any,) of the table of turns
    turn: Array  # (rows, 4) cos, sin, share of the ring's volume, 0


def turns(most: int) -> Array:
    """Turns (rows, 4) by 2πk/n of up to `most` cuts, for k up to 2, then for all of a few cuts.

    Cuts at k and -k are mirrored in the plane: what is not across it is twice that of one.
    """
    n, k = np.arange(most + 1)[:, None], np.arange(3)
    few = _turned(n, np.broadcast_to(k, (most + 1, 3)))
    n, k = np.arange(WHOLE)[:, None], np.arange(WHOLE // 2 + 1)
    return np.concatenate([few, _turned(n, np.broadcast_to(k, (WHOLE, len(k))))])


def _turned(n: Whole, k: Whole) -> Array:
    whole = np.maximum(n, 1)
    angle = 2.0 * math.pi * k / whole
    share = np.where((k == 0) | (2 * k == whole), 1.0, 2.0) / whole
    columns = [np.cos(angle), np.sin(angle), share, np.zeros_like(angle)]
    return np.stack(columns, axis=-1).reshape(-1, 4)


def cuts(radius: Array, length: float) -> Whole:
    """Numbers (n,) of cuts a smoothing length [m] apart, of rings of a radius (n,) m."""
    chord = np.minimum(0.5 * length / np.maximum(np.abs(radius), 0.5 * length), 1.0)
    return np.maximum(np.ceil(math.pi / np.arcsin(chord)), FEWEST).astype(np.int64)


@njit(**EXACT)
def list_doubles(
    first: int, last: int, points: Array, numbers: Whole, reach: float, close: float,
    lists: Lists, room: int, doubles: Doubles,
) -> int:  # fmt: skip
    """List the cuts that are near; return the most that one ring has, also if it has no room.

    Parameters
    ----------
    first, last : int
        Rings that look.
    points : (n + images, 3) float array, m
    numbers : (n + images,) int array
        Cuts of each ring.
    reach, close : float, m
    lists : Lists
        Rings that are near in the plane.
    room : int
        Cuts that there is room for, near each.
    doubles : Doubles
        Written, but for the turns.
    """
    begin, _, end, neighbour = lists
    begins, ends, ring, row, turn = doubles
    reach2, most, each = reach * reach, 0, WHOLE // 2 + 1
    few = turn.shape[0] - WHOLE * each
    for i in range(first, last):
        x, z = points[i, 0], points[i, 2]
        place, count = i * room, 0
        begins[i] = place
        for q in range(begin[i], end[i]):
            j = neighbour[q]
            r = points[j, 0]
            n = max(numbers[i], numbers[j])
            flat = (x - r) * (x - r) + (z - points[j, 2]) * (z - points[j, 2])
            at, turned = 3 * n, 3
            if x < close or r < close:
                at, turned = few + each * n, n // 2 + 1
            for k in range(1 if i == j else 0, turned):
                if flat + 2.0 * x * r * (1.0 - turn[at + k, 0]) >= reach2:
                    break
                if count < room:
                    ring[place + count] = j
                    row[place + count] = at + k
                count += 1
        ends[i] = place + count
        most = max(most, count)
    return most


@njit(inline="always")
def pack_turned(i, doubles, place, motion, outside, near, moves):  # type: ignore[no-untyped-def]
    """Copy neighbours of a particle, turned, with their shares; return how many, filled up."""
    begin, end = doubles.begin[i], doubles.end[i]
    count = end - begin
    for k in range(count):
        j, t = doubles.ring[begin + k], doubles.row[begin + k]
        c, s = doubles.turn[t, 0], doubles.turn[t, 1]
        near[k, 0], near[k, 1], near[k, 2] = c * place[j, 0], s * place[j, 0], place[j, 2]
        near[k, 3] = doubles.turn[t, 2] * place[j, 3]
        moves[k, 0], moves[k, 1], moves[k, 2] = c * motion[j, 0], s * motion[j, 0], motion[j, 2]
        moves[k, 3] = motion[j, 3]
    full = (count + PAIRS - 1) // PAIRS * PAIRS
    for k in range(count, full):
        near[k, 0], near[k, 1], near[k, 2], near[k, 3] = outside, 0.0, place[i, 2], 0.0
        for d in range(4):
            moves[k, d] = motion[i, d]
    return full


@njit(inline="always")
def pack_stress(i, doubles, stress, filling, full, tension):  # type: ignore[no-untyped-def]
    """Copy stresses of neighbours, turned: A τ Aᵀ."""
    begin, end = doubles.begin[i], doubles.end[i]
    count, width = end - begin, len(filling)
    for k in range(count):
        j, t = doubles.ring[begin + k], doubles.row[begin + k]
        c, s = doubles.turn[t, 0], doubles.turn[t, 1]
        if width == 8:
            xx, yy, zx = stress[j, 0], stress[j, 1], stress[j, 5]
            tension[k, 0], tension[k, 1] = c * c * xx + s * s * yy, s * s * xx + c * c * yy
            tension[k, 2], tension[k, 3] = stress[j, 2], c * s * (xx - yy)
            tension[k, 4], tension[k, 5] = s * zx, c * zx
            tension[k, 6], tension[k, 7] = stress[j, 6], stress[j, 7]
        else:
            xx, xz, yy, zx = stress[j, 0], stress[j, 2], stress[j, 4], stress[j, 6]
            tension[k, 0], tension[k, 4] = c * c * xx + s * s * yy, s * s * xx + c * c * yy
            tension[k, 1] = tension[k, 3] = c * s * (xx - yy)
            tension[k, 2], tension[k, 5] = c * xz, s * xz
            tension[k, 6], tension[k, 7] = c * zx, s * zx
            for d in range(8, 12):
                tension[k, d] = stress[j, d]
    for k in range(count, full):
        for d in range(width):
            tension[k, d] = filling[d]


@njit(**FAST)
def ring_gradients(
    first: int, last: int, place: Array, motion: Array, doubles: Doubles, law: PairLaw,
    velocity_gradient: Array, correction: Array,
) -> None:  # fmt: skip
    """Write η L of rings, as `velocity_gradients` does of particles."""
    rows = longest_list(first, last, doubles.begin, doubles.end)
    near, moves = empty_rows(rows, 4, place.dtype), empty_rows(rows, 4, place.dtype)
    for i in range(first, last):
        x, z, u, w = place[i, 0], place[i, 2], motion[i, 0], motion[i, 2]
        outside = out_of_reach(x, law.smoothing.length)
        count = pack_turned(i, doubles, place, motion, outside, near, moves)
        found, matrix, broken = sum_gradients(count, x, 0.0, z, u, 0.0, w, near, moves, law)
        m00, _, m02, _, m11, _, m20, _, m22 = found
        found = m00, 0.0, m02, 0.0, m11, 0.0, m20, 0.0, m22
        if law.corrected is not None:
            kxx, kyy, kzz, _, _, kzx = matrix
            whole = motion[i, 3] == 0.0 and broken == 0.0
            found, matrix = corrected(found, (kxx, kyy, kzz, 0.0, 0.0, kzx), whole, law)
            for d in range(6):
                correction[i, d] = matrix[d]
        for d in range(9):
            velocity_gradient[i, d] = found[d]


@njit(**FAST)
def ring_accelerations(
    first: int, last: int, place: Array, motion: Array, stress: Array, doubles: Doubles,
    law: PairLaw, forces: Forces,
) -> tuple[float, float]:  # fmt: skip
    """Write accelerations of rings and their heating, as `accelerations` does of particles."""
    acceleration, heating = forces
    rows = longest_list(first, last, doubles.begin, doubles.end)
    near, moves = empty_rows(rows, 4, place.dtype), empty_rows(rows, 4, place.dtype)
    tension = empty_rows(rows, 8 if law.corrected is None else 12, place.dtype)
    slowest, greatest = math.inf, 0.0
    for i in range(first, last):
        x, z, u, w, sound = place[i, 0], place[i, 2], motion[i, 0], motion[i, 2], motion[i, 3]
        outside = out_of_reach(x, law.smoothing.length)
        count = pack_turned(i, doubles, place, motion, outside, near, moves)
        own, density, start, filling = own_stress(stress, i, law.corrected, law.artificial)
        pack_stress(i, doubles, stress, filling, count, tension)
        fx, _, fz, heat, fastest = sum_forces(
            count, x, 0.0, z, u, 0.0, w, sound, density, start, own, near, moves, tension, law,
            law.corrected, law.artificial,
        )  # fmt: skip
        mu, per = number_of(fastest), 1.0 / start
        fx, fz = fx * per, fz * per
        acceleration[i, 0], acceleration[i, 1], acceleration[i, 2] = fx, 0.0, fz
        heating[i] = 0.5 * heat * per
        drag = law.linear * sound + law.quadratic * mu
        slowest = min(slowest, law.smoothing.length / (sound + 1.2 * drag))
        greatest = max(greatest, fx * fx + fz * fz)
    return slowest, greatest
