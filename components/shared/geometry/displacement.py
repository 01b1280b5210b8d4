"""The volume of a closed surface below a level, exact for its triangles."""

import numpy as np

from quintet.interfaces.component import Array

HALVINGS = 40


def displaced_volume(triangles: Array, level: float) -> float:
    """Volume [m3] below a level [m] of triangles (t, 3, 3) m that look outwards.

    It is the flux of (0, 0, z - h) through the triangles' parts below the level: the field has a
    divergence of 1 and no flux through the plane of the level. With heights a ≤ b ≤ c above the
    level, the mean of z - h over a triangle, counting 0 above the level, is

        (a + b + c)/3                         c ≤ 0
        (a + b + c)/3 - c³/(3 (c-a)(c-b))     b ≤ 0 < c
        a³/(3 (a-b)(a-c))                     a < 0 < b
    """
    sides = triangles[:, 1:] - triangles[:, :1]
    across = 0.5 * (sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0])  # m2
    a, b, c = np.sort(triangles[:, :, 2] - level, axis=1).T
    mean = np.where(a < 0.0, (a + b + c) / 3.0, 0.0)
    upper, lower = (b <= 0.0) & (c > 0.0) & (a < 0.0), (a < 0.0) & (b > 0.0)
    a_u, b_u, c_u = a[upper], b[upper], c[upper]
    mean[upper] -= c_u**3 / (3.0 * (c_u - a_u) * (c_u - b_u))
    a_l, b_l, c_l = a[lower], b[lower], c[lower]
    mean[lower] = a_l**3 / (3.0 * (a_l - b_l) * (a_l - c_l))
    return float((across * mean).sum())


def level_of_volume(triangles: Array, volume: float) -> float:
    """Level [m] below which a closed surface (t, 3, 3) m has a volume [m3], by halving."""
    low, high = float(triangles[:, :, 2].min()), float(triangles[:, :, 2].max())
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if displaced_volume(triangles, middle) < volume:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)
