"""Velocity and density of the fluid at points, fitted to the particles around them."""

import numpy as np
from numba import njit
from scipy.spatial import cKDTree

from quintet.components.shared.numba_options import EXACT
from quintet.components.shared.smoothing.cubic_spline import SUPPORT
from quintet.components.shared.smoothing.smoothing import kernel
from quintet.components.sph_fluid.boundary.kernels.mirrored_density import (
    NO_FLUID,
    add_moments,
    mean_and_variance,
    solve,
)
from quintet.components.sph_fluid.laws import Constants
from quintet.components.sph_fluid.state import Array, Whole


@njit(**EXACT)
def fit_fields(
    points: Array, begin: Whole, near: Whole, position: Array, velocity: Array,
    constants: Constants, fields: Array,
) -> None:  # fmt: skip
    """Write velocity and density of the fluid at points, and how much fluid is around them.

    Planes are fitted by moving least squares, which meet linear fields exactly, also where fluid
    is on one side only (English et al. 2022 fit the density of walls so).

    Parameters
    ----------
    points : (m, k, 3) float array, m
        Of each of m places, the place itself and its images.
    begin, near : (m k + 1,) and (pairs,) int arrays
        Rows of the fluid near each of these points, as of `near_rows`.
    position, velocity : (n, 4) float arrays
        Of fluid, as of the state.
    constants : Constants
    fields : (m, 5) float array
        Written: u, v, w [m/s], ρ [kg/m3] and Σ V W [1]; zeros where there is no fluid.
    """
    h = constants.smoothing.length
    reach2, inverse = (SUPPORT * h) ** 2, 1.0 / h
    fields[:] = 0.0
    moments_of = np.empty((4, 4))  # of u, v, w, ρ: Σ w f, Σ w f r
    for p in range(points.shape[0]):
        moments = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        moments_of[:] = 0.0
        for image in range(points.shape[1]):
            point = p * points.shape[1] + image
            for entry in range(begin[point], begin[point + 1]):
                j = near[entry]
                dz = position[j, 2] - points[p, image, 2]
                dx = position[j, 0] - points[p, image, 0]
                dy = position[j, 1] - points[p, image, 1]
                r2 = dx * dx + dy * dy + dz * dz
                if r2 >= reach2:
                    continue
                w = kernel(r2, constants.smoothing) * constants.mass / position[j, 3]
                x, y, z = dx * inverse, dy * inverse, dz * inverse
                moments = add_moments(moments, w, x, y, z)
                for f in range(4):
                    value = velocity[j, f] if f < 3 else position[j, 3] - constants.density
                    moments_of[f, 0] += w * value
                    moments_of[f, 1] += w * value * x
                    moments_of[f, 2] += w * value * y
                    moments_of[f, 3] += w * value * z
        s = moments[0]
        fields[p, 4] = s
        if s < NO_FLUID:
            continue
        (mx, my, mz), variance = mean_and_variance(moments)
        for f in range(4):
            mean = moments_of[f, 0] / s
            bx = moments_of[f, 1] / s - mx * mean
            by = moments_of[f, 2] / s - my * mean
            bz = moments_of[f, 3] / s - mz * mean
            gx, gy, gz = solve(variance, bx, by, bz)
            fields[p, f] = mean - gx * mx - gy * my - gz * mz
        fields[p, 3] += constants.density


def near_rows(points: Array, position: Array, reach: float) -> tuple[Whole, Whole]:
    """Rows of particles near points, in the order of the rows.

    Parameters
    ----------
    points : (m, k, 3) float array, m
    position : (n, 4) float array
        Of fluid, as of the state.
    reach : float, m

    Returns
    -------
    begin : (m k + 1,) int array
        Where the rows of each point begin, and, last, where they end.
    near : (pairs,) int array
    """
    tree = cKDTree(position[:, :3])
    # A little further: the kernel decides which ones are within reach.
    rows = tree.query_ball_point(points.reshape(-1, 3), (1.0 + 1e-9) * reach, return_sorted=True)
    begin = np.concatenate([[0], np.cumsum([len(numbers) for numbers in rows])]).astype(np.int64)
    return begin, np.concatenate([np.zeros(0, np.int64), *rows]).astype(np.int64)
