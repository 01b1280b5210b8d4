"""Volume, centre and inertia of a union of spheres, by a grid of voxels."""

import math
from functools import lru_cache

import numpy as np

from quintet.interfaces.component import Array

ACROSS = 64  # voxels along the longest side
IN_SPHERE = 24  # and at least this many across the smallest sphere
MOST = 4_000_000  # voxels

Spheres = tuple[tuple[tuple[float, float, float], ...], tuple[float, ...]]


@lru_cache(maxsize=64)
def measure_union(spheres: Spheres) -> tuple[float, Array, Array]:
    """Measure a union of spheres: what lies in several of them counts once.

    Parameters
    ----------
    spheres : centres (n, 3) and radii (n,) as tuples, m

    Returns
    -------
    volume : float, m³
    centre : (3,) float array, m, centre of mass
    inertia : (3, 3) float array, m⁵, about it, at unit density
    """
    centres, radii = np.array(spheres[0]), np.array(spheres[1])[:, None]
    low, high = (centres - radii).min(axis=0), (centres + radii).max(axis=0)
    width = min(float((high - low).max()) / ACROSS, 2.0 * float(radii.min()) / IN_SPHERE)
    width = max(width, (math.prod((high - low).tolist()) / MOST) ** (1 / 3))
    counts = np.ceil((high - low) / width).astype(int)
    width3 = (high - low) / counts
    x, y, z = (a + (np.arange(n) + 0.5) * w for a, n, w in zip(low, counts, width3, strict=True))
    inside = np.zeros(counts, bool)
    for (cx, cy, cz), radius in zip(centres, radii[:, 0], strict=True):
        r2 = ((x - cx) ** 2)[:, None, None] + ((y - cy) ** 2)[:, None] + (z - cz) ** 2
        inside |= r2 < radius**2
    i, j, k = np.nonzero(inside)
    points = np.column_stack([x[i], y[j], z[k]])
    cell = float(width3.prod())
    centre = points.mean(axis=0)
    second = (points - centre).T @ (points - centre) * cell
    second += np.diag(width3**2) / 12.0 * cell * len(points)  # of each voxel about its own middle
    return len(points) * cell, centre, np.trace(second) * np.eye(3) - second
