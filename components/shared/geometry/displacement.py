"""The volume of a closed surface below a level, exact for its triangles."""

from typing import NamedTuple, Self

import numpy as np

from quintet.interfaces.component import Array

MOST_TRIED = 100  # levels; about ten are usual
CLOSE = 1e-12  # of the whole volume


class Heights(NamedTuple):
    """Triangles as what counts for the volume below a level: sorted heights, and areas."""

    lowest: Array  # (t,) m, corners of each triangle
    middle: Array  # (t,) m
    highest: Array  # (t,) m
    across: Array  # (t,) m2, area seen from above; below 0 where a triangle looks down

    @classmethod
    def of(cls, triangles: Array) -> Self:
        """Sort the heights of triangles (t, 3, 3) m that look outwards."""
        sides = triangles[:, 1:] - triangles[:, :1]
        across = 0.5 * (sides[:, 0, 0] * sides[:, 1, 1] - sides[:, 0, 1] * sides[:, 1, 0])
        lowest, middle, highest = np.sort(triangles[:, :, 2], axis=1).T
        return cls(lowest, middle, highest, across)

    def volume_below(self, level: float) -> float:
        """Volume [m3] below a level [m].

        It is the flux of (0, 0, z - h) through the triangles' parts below the level: the field has
        a divergence of 1 and no flux through the plane of the level. With heights a ≤ b ≤ c above
        the level, the mean of z - h over a triangle, counting 0 above the level, is

            (a + b + c)/3                         c ≤ 0
            (a + b + c)/3 - c³/(3 (c-a)(c-b))     b ≤ 0 < c
            a³/(3 (a-b)(a-c))                     a < 0 < b
        """
        a, b, c = self.lowest - level, self.middle - level, self.highest - level
        mean = np.where(a < 0.0, (a + b + c) / 3.0, 0.0)
        upper, lower = (b <= 0.0) & (c > 0.0) & (a < 0.0), (a < 0.0) & (b > 0.0)
        a_u, b_u, c_u = a[upper], b[upper], c[upper]
        mean[upper] -= c_u**3 / (3.0 * (c_u - a_u) * (c_u - b_u))
        a_l, b_l, c_l = a[lower], b[lower], c[lower]
        mean[lower] = a_l**3 / (3.0 * (a_l - b_l) * (a_l - c_l))
        return float((self.across * mean).sum())

    def level_of(self, volume: float) -> float:
        """Level [m] below which there is a volume [m3], by regula falsi in Illinois' form."""
        low, high = float(self.lowest.min()), float(self.highest.max())
        whole = self.volume_below(high)
        if volume >= whole:
            return high
        below, above = -volume, whole - volume  # m3, at low and high
        last = 0.0  # m3, excess at the level before
        for _ in range(MOST_TRIED):
            level = (low * above - high * below) / (above - below)
            excess = self.volume_below(level) - volume
            if abs(excess) <= CLOSE * whole:
                return level
            if excess < 0.0:
                low, below = level, excess
                above *= 0.5 if last < 0.0 else 1.0
            else:
                high, above = level, excess
                below *= 0.5 if last > 0.0 else 1.0
            last = excess
        return 0.5 * (low + high)
