"""The bodies of a scene as described; their copies are made on request."""

import math
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import accumulate
from typing import overload

import numpy as np

from quintet.components.dem_bodies.shapes import planar
from quintet.components.dem_bodies.shapes.rigid_body import RigidBody
from quintet.components.shared.geometry.lattice import lattice_points
from quintet.interfaces.component import Array

MOST = 2**31 - 1  # bodies: so many can be numbered


class Bodies(Sequence[RigidBody]):
    """All bodies, copies in their lattices' order, as a sequence that holds descriptions alone.

    Parameters
    ----------
    templates : sequence of Body
        Bodies as they are described, each with its lattice of copies.
    """

    def __init__(self, templates: Sequence[RigidBody]) -> None:
        self.templates = tuple(templates)
        self.counts = [number(body) for body in self.templates]
        self.first = [0, *accumulate(self.counts)]  # number of the first body of each, and of all
        if self.first[-1] > MOST:
            raise ValueError(
                f"bodies, with their copies, must be at most {MOST}; found {self.first[-1]:.3g}. "
                "Make fewer copies."
            )

    def __len__(self) -> int:
        return self.first[-1]

    def __iter__(self) -> Iterator[RigidBody]:
        for body in self.templates:
            yield from copies(body)

    @overload
    def __getitem__(self, k: int) -> RigidBody: ...
    @overload
    def __getitem__(self, k: slice) -> Sequence[RigidBody]: ...
    def __getitem__(self, k: int | slice) -> RigidBody | Sequence[RigidBody]:
        if isinstance(k, slice):
            return tuple(self)[k]
        number = k + len(self) if k < 0 else k
        if not 0 <= number < len(self):
            raise IndexError(k)
        group = bisect_right(self.first, number) - 1
        body = self.templates[group]
        return at(body, places(body)[number - self.first[group]])


def number(body: RigidBody) -> int:
    """Count a body and its copies."""
    return 1 if body.copies is None else math.prod(body.copies.number)


def at(body: RigidBody, place: Array) -> RigidBody:
    """Make a body that stands at a place (3,) m, and has no copies."""
    if body.copies is None:
        return body
    x, y, z = place.tolist()
    return replace(body, position=(x, y, z), copies=None)


def copies(body: RigidBody) -> Iterator[RigidBody]:
    """Yield one body, or all that stand on its lattice."""
    if body.copies is None:
        yield body
        return
    for place in places(body):
        yield at(body, place)


def places(body: RigidBody) -> Array:
    """Where a body and its copies stand; (n, 3) m, x slowest."""
    if body.copies is None:
        return np.array([body.position])
    lattice = body.copies
    numbers = lattice_points([np.arange(n) for n in lattice.number], x_fastest=False)
    points = np.array(body.position) + numbers * np.array(lattice.spacing)  # (n, 3) m
    if lattice.scatter == 0.0:
        return points
    random = np.random.default_rng(lattice.seed)
    scattered = random.uniform(-1.0, 1.0, points.shape)
    if body.shape in planar.SHAPES:
        scattered[:, 1] = 0.0
    points += lattice.scatter * scattered
    return points


def some_places(body: RigidBody, low: Array, high: Array) -> tuple[Array, Array]:
    """Numbers (n,) and places (n, 3) m of those of a body's copies that may stand in a box.

    Parameters
    ----------
    low, high : (3,) float array, m
        Corners of the box.
    """
    if body.copies is None:
        return np.zeros(1, np.int64), np.array([body.position])
    lattice = body.copies
    step, counts = np.array(lattice.spacing), np.array(lattice.number, np.float64)
    room = lattice.scatter + 1e-9 * step
    first = np.clip(np.ceil((low - room - body.position) / step), 0.0, counts).astype(np.int64)
    last = np.clip(np.floor((high + room - body.position) / step), -1.0, counts - 1.0)
    axes = [np.arange(a, b + 1) for a, b in zip(first, last.astype(np.int64), strict=True)]
    index = lattice_points(axes, x_fastest=False).astype(np.int64)
    _, ny, nz = lattice.number
    numbers = (index[:, 0] * ny + index[:, 1]) * nz + index[:, 2]
    if lattice.scatter == 0.0:
        return numbers, np.array(body.position) + index * step
    return numbers, places(body)[numbers]
