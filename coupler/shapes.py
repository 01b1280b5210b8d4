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
    cells = np.maximum(1, np.rint(size / spacing)).astype(int)
    step = size / cells
    axes = [(np.arange(n) - 0.5 * (n - 1)) * s for n, s in zip(cells, step, strict=True)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    return _box(points, size, step, depth) if shape == BOX else _sphere(points, size, depth)


def _box(points: Array, size: Array, step: Array, depth: float) -> tuple[Array, Array, Array]:
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


def _sphere(points: Array, size: Array, depth: float) -> tuple[Array, Array, Array]:
    radius = 0.5 * size[0]
    distance = np.linalg.norm(points, axis=1)
    inside = distance < radius
    volume = math.pi / 6 * size[0] ** 3 / max(1, int(inside.sum()))
    keep = inside & (radius - distance < depth)
    normal = points[keep] / np.maximum(distance[keep], 1e-12 * radius)[:, None]
    normal[~normal.any(axis=1)] = (0.0, 0.0, 1.0)
    return points[keep], normal, np.full(int(keep.sum()), volume)


def mirrors(shape: int, size: Array, arm: Array, normal: Array) -> Array:
    """Images (n, 3) m of samples that `fill` made, mirrored in the body's surface."""
    if shape == SPHERE:
        below = 0.5 * size[0] - np.linalg.norm(arm, axis=1)
    else:
        # On edges and corners the nearest surface point is as far along each of the faces' normals.
        below = (0.5 * size - np.abs(arm)).min(axis=1) * np.sqrt((normal != 0.0).sum(axis=1))
    return np.asarray(arm + 2.0 * below[:, None] * normal)
