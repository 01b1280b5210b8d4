"""Boxes of equal elements, and rectangles in the plane of x and z."""

import numpy as np

from quintet.components.fe_plate.meshes.arrays import Array, Whole
from quintet.components.fe_plate.meshes.params import MeshedPart


def box(part: MeshedPart) -> tuple[Array, Whole]:
    """Nodes (n, 3) m and corners (e, 8) of a box of equal elements, less what is cut out."""
    nx, ny, nz = part.counts
    ends = zip(*part.geometry.bounds, part.counts, strict=True)
    lines = [np.linspace(a, b, n + 1) for a, b, n in ends]
    node = np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1).reshape(-1, 3)
    number = np.arange(len(node)).reshape(nx + 1, ny + 1, nz + 1)
    low, high = slice(0, -1), slice(1, None)
    around = ((low, low), (high, low), (high, high), (low, high))
    corner = np.stack([number[x, y, z].ravel() for z in (low, high) for x, y in around], axis=1)
    if part.cutout is None:
        return node, corner
    x, y, z = part.cut_out()
    left = ~(x[:, None, None] & y[None, :, None] & z[None, None, :])
    used, numbers = np.unique(corner[left.ravel()], return_inverse=True)
    return node[used], numbers.reshape(-1, 8)


def rectangle(part: MeshedPart) -> tuple[Array, Whole]:
    """Nodes (n, 3) m at y = 0 and corners (e, 8) of a rectangle; far corners are the same nodes.

    Around each element from z to x, as seen from within a solid that extends along y.
    """
    (west, _, bottom), (east, _, top) = part.geometry.bounds
    nx, _, nz = part.counts
    x, z = np.linspace(west, east, nx + 1), np.linspace(bottom, top, nz + 1)
    across, up = np.meshgrid(x, z, indexing="ij")
    node = np.stack([across, np.zeros_like(across), up], axis=-1).reshape(-1, 3)
    number = np.arange(len(node)).reshape(nx + 1, nz + 1)
    around = (number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1])
    quad = np.stack([index.ravel() for index in around], axis=1)
    return node, np.concatenate([quad, quad], axis=1)
