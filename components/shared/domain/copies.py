"""Copies of the rows of other ranks behind a rank's own, then images of all in planes of symmetry.

A rank has copies of all rows within reach of the box around the points that it looks from: other
ranks' parts of space are about boxes too, so that these are hardly more than it needs.
"""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.domain.exchange import send_rows, share
from quintet.components.shared.domain.halo import Halo
from quintet.components.shared.symmetry import Plane, SymmetryImages
from quintet.interfaces.component import Array

Whole = NDArray[np.int64]
WIDER = 1.0 + 1e-9  # times a reach, for what is rounded


class Group(NamedTuple):
    """Rows of a rank, one after another, that are found alike."""

    points: Array  # (n, 3) m
    keys: Whole  # (n,) numbers that rise in the order in which one rank would have the rows
    looking: Array  # (q, 3) m, points of this rank that look for such rows


class Extended(NamedTuple):
    """A group with its copies, as one rank would have it."""

    points: Array  # (n + copies, 3) m, in the order of the keys
    row: Whole  # (n + copies,) of each


class CopiesAndImages:
    """Copies and images of one rank's rows, from one list of neighbours to the next.

    It stands in place of the images alone that a solver of one rank has: copies are brought up to
    date where images are.

    Parameters
    ----------
    communicator : mpi4py communicator
    planes : list of Plane
        Of symmetry.
    """

    def __init__(self, communicator: Any, planes: list[Plane]) -> None:
        self._communicator = communicator
        self.images = SymmetryImages(planes)
        self.copies = 0  # rows that are copies
        self.sent: list[Whole] = []  # rows that each rank gets; none before the first `copy`
        self.received: list[Whole] = []  # rows into which its rows go
        self._halos: dict[tuple[int, ...], Halo] = {}  # by widths

    @property
    def planes(self) -> list[Plane]:
        """Planes of symmetry."""
        return self.images.planes

    def copy(self, groups: Sequence[Group], reach: float) -> list[Extended]:
        """Copy what is within reach [m] of the points that look, behind all own rows."""
        rows = sum(len(group.keys) for group in groups)
        boxes = np.concatenate([_box(group.looking) for group in groups])
        all_boxes = share(self._communicator, boxes)
        all_near, all_sent = [], []
        start = 0
        for number, group in enumerate(groups):
            columns = slice(6 * number, 6 * number + 6)
            near = [_within(group.points, box[columns], WIDER * reach) for box in all_boxes]
            near[self._communicator.rank] = np.zeros(0, np.int64)
            # Keys travel as the bits of numbers.
            numbers = np.column_stack([group.points, group.keys.view(np.float64)])
            all_near.append(send_rows(self._communicator, [numbers[part] for part in near]))
            all_sent.append([start + part for part in near])
            start += len(group.keys)
        self.sent = [np.concatenate(parts) for parts in zip(*all_sent, strict=True)]
        received, extended, first, start = [], [], rows, 0
        for group, near_rows in zip(groups, all_near, strict=True):
            copies = np.concatenate(near_rows)
            row = np.concatenate([
                start + np.arange(len(group.keys)), first + np.arange(len(copies))
            ])  # fmt: skip
            keys = np.ascontiguousarray(copies[:, 3]).view(np.int64)
            order = np.argsort(np.concatenate([group.keys, keys]), kind="stable")
            points = np.concatenate([group.points, copies[:, :3]])
            extended.append(Extended(points.take(order, axis=0), row[order]))
            received.append(_blocks(near_rows, first))
            start, first = start + len(group.keys), first + len(copies)
        self.received = [np.concatenate(parts) for parts in zip(*received, strict=True)]
        self._halos, self.copies = {}, first - rows
        return extended

    def with_room(self, array: Array, rows: int) -> Array:
        """Return the first rows of an array (any, width) with room for copies and images."""
        room = np.zeros((self.copies, *array.shape[1:]))
        with_copies = np.concatenate([array[:rows], room])
        return self.images.with_room(with_copies, rows + self.copies)

    def find_images(self, groups: Sequence[Extended], reach: float) -> tuple[Array, list[Whole]]:
        """Find the images of own rows and copies, as one rank would.

        Returns
        -------
        (n + copies + images, 3) float array, m
            All points, by row.
        list of (k,) int array
            For each group its rows with images, in the order in which one rank would have them.
        """
        in_order = np.concatenate([group.row for group in groups])
        count = len(in_order)
        points = self.images.find(np.concatenate([group.points for group in groups]), reach)
        group_of = np.zeros(len(points), np.int64)
        group_of[:count] = np.repeat(np.arange(len(groups)), [len(group.row) for group in groups])
        self.images.write_values(group_of, count)
        self.images.origin = [_renamed(origin, in_order) for origin in self.images.origin]
        row = np.concatenate([in_order, np.arange(count, len(points))])
        by_row = np.empty_like(points)
        by_row[row] = points
        return by_row, [row[group_of == number] for number in range(len(groups))]

    def exchange(self, *arrays: Array) -> None:
        """Bring the copies in arrays (n + copies + images, width) up to date."""
        widths = tuple(array.shape[1] for array in arrays)
        if widths not in self._halos:
            halo = Halo(self._communicator, self.sent, self.received, widths)
            self._halos[widths] = halo
        self._halos[widths].exchange(*arrays)

    def write_all(self, rows: int, positions: Array, vectors: Array, *tensors: Array) -> None:
        """Write copies, in one message to each rank, and images; see `SymmetryImages.write_all`."""
        self.exchange(positions, vectors, *tensors)
        self.images.write_all(rows + self.copies, positions, vectors, *tensors)

    def write_vectors(self, array: Array, rows: int) -> None:
        """Write copies and images; see `SymmetryImages.write_vectors`."""
        self.exchange(array)
        self.images.write_vectors(array, rows + self.copies)

    def write_tensors(self, array: Array, rows: int) -> None:
        """Write copies and images; see `SymmetryImages.write_tensors`."""
        self.exchange(array)
        self.images.write_tensors(array, rows + self.copies)

    def write_values(self, array: Array, rows: int) -> None:
        """Write copies and images of values (rows + copies + images,)."""
        self.exchange(array.reshape(-1, 1))
        self.images.write_values(array, rows + self.copies)


def _box(points: Array) -> Array:
    """Lowest and highest corner (6,) m of points (n, 3) m; of none a box that holds nothing."""
    low, high = points.min(axis=0, initial=np.inf), points.max(axis=0, initial=-np.inf)
    return np.concatenate([low, high])


def _within(points: Array, box: Array, reach: float) -> Whole:
    """Rows of points (n, 3) m that are within reach [m] of a box (6,) m."""
    inside = np.ones(len(points), bool)
    for axis in range(3):
        along = points[:, axis]
        inside &= (along > box[axis] - reach) & (along < box[3 + axis] + reach)
    return np.flatnonzero(inside)


def _blocks(parts: list[Array], first: int) -> list[Whole]:
    """Rows into which blocks go, one after another from a first row on."""
    ends = first + np.cumsum([0, *map(len, parts)])
    return [np.arange(a, b) for a, b in pairwise(ends)]


def _renamed(origin: Whole, row: Whole) -> Whole:
    """Rows of what has images; images themselves stand where they stood."""
    count = len(row)
    return np.where(origin < count, row[np.minimum(origin, count - 1)], origin)
