"""Where bodies stand at the start: none inside another, none below a plane."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from quintet.components.dem_bodies.clump import union
from quintet.interfaces.component import Array

if TYPE_CHECKING:
    from quintet.components.dem_bodies.params import Body, Plane

ALLOWED = 1e-6  # overlap over the size of the smaller body: rounding of what touches exactly

Balls = tuple[Array, Array]  # centres (n, 3) m, radii (n,) m


def copied(bodies: "Sequence[Body]") -> "tuple[Body, ...]":
    """Put the copies of each body in its place, on their lattice."""
    return tuple(one for body in bodies for one in copies(body))


def copies(body: "Body") -> "Iterator[Body]":
    """One body, or all that stand on its lattice."""
    if body.copies is None:
        yield body
        return
    numbers = np.stack(np.meshgrid(*map(np.arange, body.copies), indexing="ij"), axis=-1)
    places = np.array(body.position) + numbers.reshape(-1, 3) * np.array(body.apart)  # (n, 3) m
    random = np.random.default_rng(body.seed)
    places += body.scatter * random.uniform(-1.0, 1.0, places.shape)
    for x, y, z in places.tolist():
        yield replace(body, position=(x, y, z), copies=None, apart=None, scatter=0.0)


def rotation(orientation: tuple[float, float, float, float]) -> Array:
    """Matrix (3, 3) of a unit quaternion: body -> world."""
    w, x, y, z = np.array(orientation) / np.linalg.norm(orientation)
    skew = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + 2.0 * w * skew + 2.0 * skew @ skew)


def spheres(body: "Body") -> Balls:
    """Contact spheres of a body that is not a box, in body axes about its centre of mass."""
    if body.diameter is not None:
        return np.zeros((1, 3)), np.array([0.5 * body.diameter])
    if body.agglomerate is not None:
        one = body.agglomerate
        return one.centres, np.full(len(one.centres), one.radius)
    assert body.centres is not None and body.radii is not None
    return np.array(body.centres) - union((body.centres, body.radii))[1], np.array(body.radii)


def balls(body: "Body") -> Balls:
    """Find the same spheres in the world."""
    centres, radii = spheres(body)
    return np.array(body.position) + centres @ rotation(body.orientation).T, radii


def reach(body: "Body") -> float:
    """Radius [m] about the centre of mass that holds the body."""
    if body.size is not None:
        return 0.5 * float(np.linalg.norm(body.size))
    centres, radii = spheres(body)
    return float((np.linalg.norm(centres, axis=1) + radii).max())


def check(bodies: "Sequence[Body]", planes: "Sequence[Plane]") -> None:
    """Refuse bodies that start inside one another or below a plane."""
    for k, body in enumerate(bodies):
        for m, plane in enumerate(planes):
            gap = above(body, plane)
            if gap < -ALLOWED * reach(body):
                raise ValueError(
                    f"bodies[{k}] must start above planes[{m}]; it reaches {-gap:.6g} m below. "
                    "Raise it, or turn the plane's normal to the free side."
                )
    for i, j in near(bodies):
        gap = between(bodies[i], bodies[j])
        if gap < -ALLOWED * min(reach(bodies[i]), reach(bodies[j])):
            raise ValueError(
                f"bodies[{i}] and bodies[{j}] must not overlap at the start; they do by "
                f"{-gap:.6g} m. Move one of them; touching is allowed."
            )


def above(body: "Body", plane: "Plane") -> float:
    """Distance [m] of a body's lowest point from a plane."""
    normal = np.array(plane.normal) / np.linalg.norm(plane.normal)
    origin = np.array(plane.point)
    if body.size is not None:
        down = np.abs(normal @ rotation(body.orientation)) @ (0.5 * np.array(body.size))
        return float(normal @ (np.array(body.position) - origin) - down)
    centres, radii = balls(body)
    return float(((centres - origin) @ normal - radii).min())


def near(bodies: "Sequence[Body]") -> Iterator[tuple[int, int]]:
    """Pairs of bodies whose bounding spheres overlap, by a sweep along x."""
    middle = np.array([body.position for body in bodies])
    radius = np.array([reach(body) for body in bodies])
    order = np.argsort(middle[:, 0] - radius, kind="stable")
    middle, radius = middle[order], radius[order]
    left, right = middle[:, 0] - radius, middle[:, 0] + radius
    for step in range(1, len(bodies)):
        # Sorted by their left ends: once nobody reaches the step-th next, nobody reaches further.
        if not (left[step:] < right[:-step]).any():
            return
        apart = np.linalg.norm(middle[step:] - middle[:-step], axis=1)
        for k in np.flatnonzero(apart < radius[step:] + radius[:-step]):
            i, j = sorted((int(order[k]), int(order[k + step])))
            yield i, j


def between(a: "Body", b: "Body") -> float:
    """Gap [m] between two bodies, negative where they overlap."""
    if a.size is not None and b.size is not None:
        return separation(a, b)
    if a.size is not None or b.size is not None:
        box, other = (a, b) if a.size is not None else (b, a)
        centres, radii = balls(other)
        return float((outside(box, centres) - radii).min())
    (c, r), (d, s) = balls(a), balls(b)
    return float((np.linalg.norm(c[:, None] - d, axis=2) - r[:, None] - s).min())


def outside(box: "Body", points: Array) -> Array:
    """Signed distances (n,) m of points (n, 3) m from a box."""
    local = (points - np.array(box.position)) @ rotation(box.orientation)
    beyond = np.abs(local) - 0.5 * np.array(box.size)
    far = np.linalg.norm(np.maximum(beyond, 0.0), axis=1)
    return np.asarray(far + np.minimum(beyond.max(axis=1), 0.0))


def separation(a: "Body", b: "Body") -> float:
    """Widest gap [m] between two boxes over the 15 axes that can part them (Gottschalk 1996)."""
    R, S = rotation(a.orientation), rotation(b.orientation)
    crossed = np.cross(R.T[:, None], S.T[None]).reshape(9, 3)
    lengths = np.linalg.norm(crossed, axis=1)
    axes = np.vstack([R.T, S.T, crossed[lengths > 1e-9] / lengths[lengths > 1e-9, None]])
    apart = np.abs(axes @ (np.array(a.position) - np.array(b.position)))
    half_a = np.abs(axes @ R) @ (0.5 * np.array(a.size))
    half_b = np.abs(axes @ S) @ (0.5 * np.array(b.size))
    return float((apart - half_a - half_b).max())
