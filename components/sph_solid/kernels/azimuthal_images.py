"""Azimuthal images of rings about the z axis: neighbours, turned about it out of the plane.

A particle at the radius x stands for a ring. A pair sees n images of a ring, turned by 2πk/n, each
with 1/n of the ring's volume; n is the greater of the two rings' own numbers of images a smoothing
length apart, so that forces between the two rings balance, along the axis to rounding. Near the
axis all images of the circle are seen, elsewhere the two at either side that are within reach.

Paper: Dyanov, Kazantsev & Chelakov (LOGOS), section 4, with n of the pair.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from quintet.components.shared.numba_options import EXACT
from quintet.components.shared.packing import PAIRS
from quintet.components.shared.search.neighbours import Lists
from quintet.components.sph_solid.state import Array, Whole

FEWEST = 6  # images of a ring
CLOSE = 2.0  # smoothing lengths from the axis within which all images of a circle are seen
WHOLE = 64  # more images than a ring has that is near one so close


class AzimuthalImages(NamedTuple):
    """Images of rings that are near each particle."""

    begin: Whole  # (n,)
    end: Whole  # (n,)
    ring: NDArray[np.int32]  # (any,) particle
    row: NDArray[np.int32]  # (any,) of the table of turns
    turn: Array  # (rows, 4) cos, sin, share of the ring's volume, 0


def turn_table(most: int) -> Array:
    """Turns (rows, 4) by 2πk/n of up to `most` images, for k up to 2; then all of a few images.

    Images at k and -k mirror each other in the plane: one stands for both, with twice the share.
    """
    n, k = np.arange(most + 1)[:, None], np.arange(3)
    nearest = _turns(n, np.broadcast_to(k, (most + 1, 3)))
    n, k = np.arange(WHOLE)[:, None], np.arange(WHOLE // 2 + 1)
    return np.concatenate([nearest, _turns(n, np.broadcast_to(k, (WHOLE, len(k))))])


def _turns(n: Whole, k: Whole) -> Array:
    number = np.maximum(n, 1)
    angle = 2.0 * math.pi * k / number
    share = np.where((k == 0) | (2 * k == number), 1.0, 2.0) / number
    columns = [np.cos(angle), np.sin(angle), share, np.zeros_like(angle)]
    return np.stack(columns, axis=-1).reshape(-1, 4)


def image_counts(radius: Array, length: float) -> Whole:
    """Numbers (n,) of images a smoothing length [m] apart, of rings of a radius (n,) m."""
    chord = np.minimum(0.5 * length / np.maximum(np.abs(radius), 0.5 * length), 1.0)
    return np.maximum(np.ceil(math.pi / np.arcsin(chord)), FEWEST).astype(np.int64)


@njit(inline="always")
def turns_of_pair(n, is_close, all_of_few):  # type: ignore[no-untyped-def]
    """First row in the table of turns of n images, and how many rows may be near.

    Close to the axis these are all of a circle, which the table has from `all_of_few` on.
    """
    if is_close:
        return all_of_few + (WHOLE // 2 + 1) * n, n // 2 + 1
    return 3 * n, 3


@njit(inline="always")
def turned_square(flat, x, r, cosine):  # type: ignore[no-untyped-def]
    """Square [m2] of the distance from a ring at the radius x to the turned image of one at r.

    `flat` is that to the ring as it is, and `cosine` that of the turn.
    """
    return flat + 2.0 * x * r * (1.0 - cosine)


@njit(inline="always")
def turned_vector(c, s, x, z):  # type: ignore[no-untyped-def]
    """Vector of the plane, (x, 0, z), turned about the axis by a cosine and sine."""
    return c * x, s * x, z


@njit(inline="always")
def turned_six(c, s, xx, yy, zz, zx):  # type: ignore[no-untyped-def]
    """A τ Aᵀ of a symmetric tensor, six numbers."""
    return c * c * xx + s * s * yy, s * s * xx + c * c * yy, zz, c * s * (xx - yy), s * zx, c * zx


@njit(inline="always")
def turned_nine(c, s, xx, xz, yy, zx, zz):  # type: ignore[no-untyped-def]
    """A τ Aᵀ of a tensor, nine numbers by rows."""
    xy = c * s * (xx - yy)
    return (
        c * c * xx + s * s * yy, xy, c * xz, xy, s * s * xx + c * c * yy, s * xz, c * zx, s * zx,
        zz,
    )  # fmt: skip


@njit(**EXACT)
def list_images(
    first: int, last: int, points: Array, numbers: Whole, reach: float, close: float,
    lists: Lists, room: int, images: AzimuthalImages,
) -> int:  # fmt: skip
    """List the images that are near; return the most of one ring, also if there is no room.

    Parameters
    ----------
    first, last : int
        Rings whose lists are written.
    points : (n + images, 3) float array, m
    numbers : (n + images,) int array
        Images of each ring.
    reach, close : float, m
    lists : Lists
        Rings that are near in the plane.
    room : int
        Images that there is room for, near each.
    images : AzimuthalImages
        Written, except the turns.
    """
    begin, _, end, neighbour = lists
    begins, ends, ring, row, turn = images
    reach2, most = reach * reach, 0
    all_of_few = turn.shape[0] - WHOLE * (WHOLE // 2 + 1)
    for i in range(first, last):
        x, z = points[i, 0], points[i, 2]
        place, count = i * room, 0
        begins[i] = place
        for q in range(begin[i], end[i]):
            j = neighbour[q]
            r = points[j, 0]
            n = max(numbers[i], numbers[j])
            flat = (x - r) * (x - r) + (z - points[j, 2]) * (z - points[j, 2])
            at, turned = turns_of_pair(n, x < close or r < close, all_of_few)
            for k in range(1 if i == j else 0, turned):
                if turned_square(flat, x, r, turn[at + k, 0]) >= reach2:
                    break
                if count < room:
                    ring[place + count] = j
                    row[place + count] = at + k
                count += 1
        ends[i] = place + count
        most = max(most, count)
    return most


@njit(inline="always")
def pack_images(i, images, place, motion, outside, near, moves):  # type: ignore[no-untyped-def]
    """Copy images near a ring, with their shares of volume; return how many, filled up."""
    begin, end = images.begin[i], images.end[i]
    count = end - begin
    for k in range(count):
        j, t = images.ring[begin + k], images.row[begin + k]
        c, s = images.turn[t, 0], images.turn[t, 1]
        near[k, 0], near[k, 1], near[k, 2] = turned_vector(c, s, place[j, 0], place[j, 2])
        near[k, 3] = images.turn[t, 2] * place[j, 3]
        moves[k, 0], moves[k, 1], moves[k, 2] = turned_vector(c, s, motion[j, 0], motion[j, 2])
        moves[k, 3] = motion[j, 3]
    full = (count + PAIRS - 1) // PAIRS * PAIRS
    for k in range(count, full):
        near[k, 0], near[k, 1], near[k, 2], near[k, 3] = outside, 0.0, place[i, 2], 0.0
        for d in range(4):
            moves[k, d] = motion[i, d]
    return full


@njit(inline="always")
def pack_images_of_stress(i, images, stress, filling, full, tension):  # type: ignore[no-untyped-def]
    """Copy stresses of images, turned: A τ Aᵀ."""
    begin, end = images.begin[i], images.end[i]
    count, width = end - begin, len(filling)
    for k in range(count):
        j, t = images.ring[begin + k], images.row[begin + k]
        c, s = images.turn[t, 0], images.turn[t, 1]
        if width == 8:
            xx, yy, zz, zx = stress[j, 0], stress[j, 1], stress[j, 2], stress[j, 5]
            six = turned_six(c, s, xx, yy, zz, zx)
            for d in range(6):
                tension[k, d] = six[d]
            tension[k, 6], tension[k, 7] = stress[j, 6], stress[j, 7]
        else:
            xx, xz, yy, zx = stress[j, 0], stress[j, 2], stress[j, 4], stress[j, 6]
            nine = turned_nine(c, s, xx, xz, yy, zx, stress[j, 8])
            for d in range(9):
                tension[k, d] = nine[d]
            for d in range(9, 12):
                tension[k, d] = stress[j, d]
    for k in range(count, full):
        for d in range(width):
            tension[k, d] = filling[d]
