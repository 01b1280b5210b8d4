"""The bodies of a scene as described; their copies are made on request."""

import math
from array import array
from bisect import bisect_right
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import fields, replace
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from quintet.components.dem_bodies.shapes import planar
from quintet.components.dem_bodies.shapes.rigid_body import RigidBody
from quintet.components.shared.geometry.lattice import lattice_points
from quintet.interfaces.component import Array

Whole = NDArray[np.integer[Any]]
MOST = 2**31 - 1  # bodies: so many can be numbered
# Numbers that each body has of its own. A geometry's place is not used.
POSE = {"position": 3, "orientation": 4, "velocity": 3, "angular_velocity": 3}
COMMON = [f.name for f in fields(RigidBody) if f.name not in (*POSE, "geometry")]


class Bodies(Sequence[RigidBody]):
    """All bodies, copies in their lattices' order, as a sequence that holds descriptions alone.

    What bodies have in common is held once, as their kind; of each body only its pose and velocity
    are held, in arrays.

    Parameters
    ----------
    templates : iterable of RigidBody
        Bodies as they are described, each with its lattice of copies.
    """

    def __init__(self, templates: Iterable[RigidBody]) -> None:
        known: dict[object, int] = {}
        self.kinds: list[RigidBody] = []  # with the pose of their first body
        kinds, poses = array("q"), array("d")
        for body in templates:
            kind = known.setdefault(common(body), len(known))
            if kind == len(self.kinds):
                self.kinds.append(body)
            kinds.append(kind)
            for name in POSE:
                poses.extend(getattr(body, name))
        columns = np.array(poses).reshape(-1, sum(POSE.values()))
        parts = np.split(columns, np.cumsum(list(POSE.values()))[:-1], axis=1)
        self.poses = dict(zip(POSE, map(compact, parts), strict=True))  # (t, 3 or 4) of templates
        self.kind = np.array(kinds, np.int32)  # (t,) of templates
        times: list[int] = np.bincount(self.kind).tolist()
        count = sum(n * number(kind) for n, kind in zip(times, self.kinds, strict=True))
        if count > MOST:
            raise ValueError(
                f"bodies, with their copies, must be at most {MOST}; found {count:.3g}. "
                "Make fewer copies."
            )
        # Number of the first body of each template, and of all.
        self.first = np.concatenate([[0], np.cumsum(self.counts)])
        self.templates = Templates(self.kinds, self.kind, self.poses)

    @property
    def counts(self) -> Whole:
        """Number (t,) of the bodies of each template."""
        return np.array([number(body) for body in self.kinds], np.int64)[self.kind]

    def __len__(self) -> int:
        return int(self.first[-1])

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

    def have_copies(self) -> NDArray[np.bool_]:
        """Whether the bodies of each kind stand on lattices."""
        return np.array([body.copies is not None for body in self.kinds])

    def kind_of_each(self, dtype: Any = np.int64) -> NDArray[Any]:
        """Kind (n,) of each body."""
        return np.repeat(self.kind.astype(dtype), self.counts)

    def positions(self) -> Array:
        """Where all bodies stand; (n, 3) m."""
        points = np.repeat(self.poses["position"], self.counts, axis=0)
        for k in np.flatnonzero(self.have_copies()[self.kind]).tolist():
            points[self.first[k] : self.first[k + 1]] = places(self.templates[k])
        return points

    def of_each(self, name: str) -> Array:
        """Orientation, velocity or angular velocity (n, 3 or 4) of each body."""
        return np.repeat(self.poses[name], self.counts, axis=0)


class Templates(Sequence[RigidBody]):
    """Bodies as they are described, each made of its kind and pose on request.

    Parameters
    ----------
    kinds : sequence of RigidBody
    kind : (t,) int array
        Kind of each.
    poses : mapping of (t, 3 or 4) float array
        Position, orientation and velocities of each.
    """

    def __init__(self, kinds: Sequence[RigidBody], kind: Whole, poses: dict[str, Array]) -> None:
        self.kinds, self.kind, self.poses = kinds, kind, poses

    def __len__(self) -> int:
        return len(self.kind)

    @overload
    def __getitem__(self, k: int) -> RigidBody: ...
    @overload
    def __getitem__(self, k: slice) -> Sequence[RigidBody]: ...
    def __getitem__(self, k: int | slice) -> RigidBody | Sequence[RigidBody]:
        if isinstance(k, slice):
            return tuple(self)[k]
        pose: dict[str, Any] = {name: tuple(rows[k].tolist()) for name, rows in self.poses.items()}
        return replace(self.kinds[self.kind[k]], **pose)


def common(body: RigidBody) -> tuple[object, ...]:
    """What bodies of one kind have in common: all but pose and velocity."""
    return tuple(getattr(body, name) for name in COMMON)


def compact(rows: Array) -> Array:
    """The same rows (n, k); if all are equal to the bit, only one is held."""
    bits = np.ascontiguousarray(rows).view(np.int64)
    if len(rows) and (bits == bits[0]).all():
        return np.broadcast_to(rows[0].copy(), rows.shape)
    return rows.copy()


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
