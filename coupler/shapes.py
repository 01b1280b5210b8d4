"""Filling a rigid body's shape with samples, at the spacing that its partner asks for."""

import math

import numpy as np

from quintet.interfaces.component import Array
from quintet.interfaces.errors import LinkError

SPHERE, BOX = 0, 1  # codes of a body's shape, as ports.MOTION gives them


def fill(
    shape: int, size: Array, spacing: float, depth: float, inset: float | None = None
) -> tuple[Array, Array, Array]:
    """Sample one body on a lattice, to a depth below its surface.

    Parameters
    ----------
    shape : int
        0 sphere, 1 box.
    size : (3,) float array, m
        Edges of the box, or the sphere's diameter three times.
    spacing, depth : float, m
        Distance of samples; how far below the outermost they reach (deeper ones act on nothing).
    inset : float, m
        How far below the surface the outermost samples lie; half a spacing if not given.

    Returns
    -------
    arm (n, 3) m from the centre, outward normal (n, 3), volume (n,) m3
    """
    if shape not in (SPHERE, BOX):
        raise LinkError(
            f"a body's shape must be 0 (sphere) or 1 (box) to be sampled; found {shape}. Give the "
            "body one of these shapes, or leave it out of the link."
        )
    if inset is not None:
        size = size - 2.0 * (inset - 0.5 * spacing)
    return _box(size, spacing, depth) if shape == BOX else _sphere(size, spacing, depth)


def _box(size: Array, spacing: float, depth: float) -> tuple[Array, Array, Array]:
    cells = np.maximum(1, np.rint(size / spacing)).astype(int)
    step = size / cells
    axes = [(np.arange(n) - 0.5 * (n - 1)) * s for n, s in zip(cells, step, strict=True)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    below = 0.5 * size - np.abs(points)  # distance to the faces of each axis
    near = below.min(axis=1)
    keep = near < depth
    # On edges and corners the normal points between the faces, as a mirror there needs it.
    nearest = below <= (near * (1 + 1e-9))[:, None] + 1e-9 * step.max()
    normal = np.where(nearest, np.sign(points), 0.0)[keep]
    # The cell at the centre of an odd count has no side; any normal serves that deep.
    normal[~normal.any(axis=1)] = (0.0, 0.0, 1.0)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    return points[keep], normal, np.full(int(keep.sum()), float(step.prod()))


def _sphere(size: Array, spacing: float, depth: float) -> tuple[Array, Array, Array]:
    radius = 0.5 * size[0]
    edges = np.append(np.arange(radius, 0.0, -spacing), 0.0)
    points = np.concatenate([_shell(*pair, spacing) for pair in zip(edges, edges[1:])])
    distance = np.linalg.norm(points, axis=1)
    keep = radius - distance < depth
    normal = points[keep] / np.maximum(distance[keep], 1e-12 * radius)[:, None]
    normal[~normal.any(axis=1)] = (0.0, 0.0, 1.0)
    volume = math.pi / 6 * size[0] ** 3 / len(points)
    return points[keep], normal, np.full(int(keep.sum()), volume)


def _shell(outer: float, inner: float, spacing: float) -> Array:
    """Points (n, 3) m of one shell, about as many as it holds cubes of the spacing, in rings.

    On a lattice the outermost would lie at all depths down to a spacing, and water would find the
    body as large as their cubes together: a quarter too large at five spacings across.
    """
    count = 4.0 * math.pi / 3.0 * (outer**3 - inner**3) / spacing**3
    if count < 1.5:
        return np.zeros((1, 3))
    radius = 0.5 * (outer + inner)
    rings = max(2, round(math.pi * radius / spacing))
    polar = np.linspace(0.0, math.pi, 2 * rings + 1)  # edges of the rings, and their middles
    parts = []
    for k, middle in enumerate(polar[1::2]):
        band = 0.5 * float(np.cos(polar[2 * k]) - np.cos(polar[2 * k + 2]))
        some = max(2, round(band * count))
        turn = 2.0 * math.pi * (np.arange(some) + 0.5 * (k % 2)) / some
        x, y = np.sin(middle) * np.cos(turn), np.sin(middle) * np.sin(turn)
        parts.append(np.stack([x, y, np.full(some, np.cos(middle))], axis=1))
    return radius * np.concatenate(parts)


def mirrors(shape: int, size: Array, arm: Array, normal: Array) -> Array:
    """Images (n, 3) m of samples that `fill` made, mirrored in the body's surface."""
    if shape == SPHERE:
        below = 0.5 * size[0] - np.linalg.norm(arm, axis=1)
    else:
        # On edges and corners the nearest surface point is as far along each of the faces' normals.
        below = (0.5 * size - np.abs(arm)).min(axis=1) * np.sqrt((normal != 0.0).sum(axis=1))
    return np.asarray(arm + 2.0 * below[:, None] * normal)
