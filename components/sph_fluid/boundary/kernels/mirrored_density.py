"""Density and velocity of mirrored walls, fitted to the fluid around their mirror points.

The fit is one of moving least squares (English et al. 2022 solve the equations of Liu & Liu):
linear fields are met exactly by both, and the symmetric matrix of this one tells by its pivots
along which directions the fluid is too thin to fit, as across a film or a plane of particles; the
gradient there is none.
"""

import math

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import FAST
from quintet.components.shared.packing import empty_rows, longest_list, out_of_reach, pack_rows
from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.smoothing.smoothing import kernel
from quintet.components.sph_fluid.laws import Constants, pressure_term
from quintet.components.sph_fluid.state import Array, Whole

THIN = 0.02  # h², variance of positions along a direction below which no gradient is fitted
NO_FLUID = 1e-2  # Σ V W below which there is no fluid
NOT_LISTED, BY_POTENTIAL = -1, -2  # in place of a row: lists have none, or a potential acts


@njit(**FAST)
def extrapolate_density(
    first: int, last: int, split: int, listed: Whole, mirror_point: Array, position: Array,
    velocity: Array, lists: Lists, rest_gradient: float, constants: Constants,
) -> None:  # fmt: skip
    """Write density and p/ρ² of boundary rows.

    Where a mirror point sees no fluid, as between a body and the floor it stands on, the mean
    density around the particle itself is taken. Walls never pull, and the fit raises the mean by
    no more than itself and what the fluid's weight makes of it: beyond that the gradient is noise.

    Parameters
    ----------
    first, last : int
        Rows of the boundary, which stand behind the first `split` rows of the state.
    listed : (boundary,) int array
        Row of the lists that has what is around the particle itself; NOT_LISTED, or BY_POTENTIAL.
    mirror_point : (boundary, 3) float array, m
    position, velocity : (n, 4) float arrays
        Of the state; density and p/ρ² are written.
    lists, constants
    rest_gradient : float, kg/m4
        ρ₀g/c₀², of the density at rest.

    References
    ----------
    English et al., Comput. Part. Mech. 9 (2022) 911; Adami, Hu & Adams, J. Comput. Phys. 231
    (2012) 7057, for particles whose mirror points see no fluid.
    """
    begin, _, end, _ = lists
    most = longest_list(split + first, split + last, begin, end)
    for b in range(first, last):
        if listed[b] >= 0:
            most = max(most, end[listed[b]] - begin[listed[b]])
    packed = empty_rows(most, 4, position.dtype)
    for b in range(first, last):
        if listed[b] == BY_POTENTIAL:
            continue
        i = split + b
        to = position[i]
        x, y, z = mirror_point[b, 0], mirror_point[b, 1], mirror_point[b, 2]
        mean, rise, volume = fit_density(i, x, y, z, to, position, lists, constants, packed)
        if volume < NO_FLUID and listed[b] >= 0:
            x, y, z = position[i, 0], position[i, 1], position[i, 2]
            row = listed[b]
            mean, rise, volume = fit_density(row, x, y, z, to, position, lists, constants, packed)
            rise = 0.0
        excess = mean + min(rise, max(mean, 0.0) + rest_gradient * distance(to, x, y, z))
        position[i, 3] = constants.density + max(excess, 0.0)
        velocity[i, 3] = pressure_term(position[i, 3], constants)


@njit(**FAST)
def mirror_velocity(
    first: int, last: int, split: int, mirror_point: Array, position: Array, velocity: Array,
    lists: Lists, constants: Constants, apparent: Array,
) -> None:  # fmt: skip
    """Write velocities of boundary rows that bring the fluid to rest at the face.

    2u_wall - u(mirror point), with the fluid's velocity there from a plane through its
    neighbours', so that a linear profile is met exactly; the wall's own where there is no fluid.

    Parameters
    ----------
    first, last, split, mirror_point, position, velocity, lists, constants
        As of `extrapolate_density`.
    apparent : (n, 4) float array, m/s
        Written.
    """
    begin, _, end, neighbour = lists
    for b in range(first, last):
        i = split + b
        x, y, z = mirror_point[b, 0], mirror_point[b, 1], mirror_point[b, 2]
        s, mx, my, mz, ax, ay, az = fit_plane(i, x, y, z, position, lists, constants)
        if s < NO_FLUID:
            continue
        u, v, w = 0.0, 0.0, 0.0
        for k in range(np.uint64(begin[i]), np.uint64(end[i])):
            j = np.uint64(neighbour[k])
            dx, dy, dz = position[j, 0] - x, position[j, 1] - y, position[j, 2] - z
            r2 = dx * dx + dy * dy + dz * dz
            share = kernel(r2, constants.smoothing) * constants.mass / (position[j, 3] * s)
            share *= 1.0 + ax * (dx - mx) + ay * (dy - my) + az * (dz - mz)
            u += share * velocity[j, 0]
            v += share * velocity[j, 1]
            w += share * velocity[j, 2]
        apparent[i, 0] = 2.0 * velocity[i, 0] - u
        apparent[i, 1] = 2.0 * velocity[i, 1] - v
        apparent[i, 2] = 2.0 * velocity[i, 2] - w


@njit(inline="always")
def distance(target, x, y, z):  # type: ignore[no-untyped-def]
    """From a point to a target [m]."""
    return math.sqrt((target[0] - x) ** 2 + (target[1] - y) ** 2 + (target[2] - z) ** 2)


@njit(inline="always")
def add_moments(moments, w, dx, dy, dz):  # type: ignore[no-untyped-def]
    """Add a weight w at a place (in h) to Σ w, Σ w r (3) and Σ w r r (6)."""
    s, sx, sy, sz, xx, xy, xz, yy, yz, zz = moments
    wx, wy, wz = w * dx, w * dy, w * dz
    return (
        s + w, sx + wx, sy + wy, sz + wz,
        xx + wx * dx, xy + wx * dy, xz + wx * dz, yy + wy * dy, yz + wy * dz, zz + wz * dz,
    )  # fmt: skip


@njit(inline="always")
def mean_and_variance(moments):  # type: ignore[no-untyped-def]
    """Mean place (3) and variances about it (6), of which three unknowns of a plane are left."""
    s, sx, sy, sz, xx, xy, xz, yy, yz, zz = moments
    mx, my, mz = sx / s, sy / s, sz / s
    return (
        (mx, my, mz),
        (
            xx / s - mx * mx, xy / s - mx * my, xz / s - mx * mz,
            yy / s - my * my, yz / s - my * mz, zz / s - mz * mz,
        ),
    )  # fmt: skip


@njit(inline="always")
def fit_density(row, x, y, z, to, position, lists, constants, packed):  # type: ignore[no-untyped-def]
    """Mean of ρ - ρ₀ around a point, rise from there to a target, and Σ V W, of a row's fluid."""
    begin, _, end, neighbour = lists
    if begin[row] == end[row]:
        return 0.0, 0.0, 0.0
    padding = out_of_reach(x, constants.smoothing.length), y, z, constants.density
    count = pack_rows(begin[row], end[row], neighbour, position, padding, packed)
    inverse = 1.0 / constants.smoothing.length
    moments = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    b, bx, by, bz = 0.0, 0.0, 0.0, 0.0
    for k in range(count):
        dx, dy, dz = packed[k, 0] - x, packed[k, 1] - y, packed[k, 2] - z
        w = kernel(dx * dx + dy * dy + dz * dz, constants.smoothing) * constants.mass / packed[k, 3]
        dx, dy, dz = dx * inverse, dy * inverse, dz * inverse
        moments = add_moments(moments, w, dx, dy, dz)
        e = w * (packed[k, 3] - constants.density)
        b += e
        bx += e * dx
        by += e * dy
        bz += e * dz
    s = moments[0]
    if s < NO_FLUID:
        return 0.0, 0.0, s
    mean = b / s
    (mx, my, mz), variance = mean_and_variance(moments)
    bx, by, bz = bx / s - mx * mean, by / s - my * mean, bz / s - mz * mean
    gx, gy, gz = solve(variance, bx, by, bz)
    rise = gx * ((to[0] - x) * inverse - mx) + gy * ((to[1] - y) * inverse - my)
    return mean, rise + gz * ((to[2] - z) * inverse - mz), s


@njit(**FAST)
def fit_plane(row, x, y, z, position, lists, constants):  # type: ignore[no-untyped-def]
    """Σ V W of a row's fluid around a point, m and a: numbers that fit a plane to any field f.

    Its value at the point is Σ V W (1 + a·(r - m)) f / Σ V W, r from the point.
    """
    begin, _, end, neighbour = lists
    inverse = 1.0 / constants.smoothing.length
    moments = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(np.uint64(begin[row]), np.uint64(end[row])):
        j = np.uint64(neighbour[k])
        dx, dy, dz = position[j, 0] - x, position[j, 1] - y, position[j, 2] - z
        r2 = dx * dx + dy * dy + dz * dz
        w = kernel(r2, constants.smoothing) * constants.mass / position[j, 3]
        moments = add_moments(moments, w, dx * inverse, dy * inverse, dz * inverse)
    s = moments[0]
    if s < NO_FLUID:
        return s, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    (mx, my, mz), variance = mean_and_variance(moments)
    ax, ay, az = solve(variance, -mx, -my, -mz)
    h = constants.smoothing.length
    return s, mx * h, my * h, mz * h, ax * inverse, ay * inverse, az * inverse


@njit(inline="always")
def solve(variance, bx, by, bz):  # type: ignore[no-untyped-def]
    """Gradient of a plane by Cholesky's method, none along directions that are thin."""
    xx, xy, xz, yy, yz, zz = variance
    x_in, l21, l31 = 0.0, 0.0, 0.0
    if xx > THIN:
        x_in, l21, l31 = 1.0 / xx, xy / xx, xz / xx
    d2, y_in, l32 = yy - l21 * xy, 0.0, 0.0
    if d2 > THIN:
        y_in, l32 = 1.0 / d2, (yz - l31 * xy) / d2
    d3, z_in = zz - l31 * xz - l32 * l32 * d2, 0.0
    if d3 > THIN:
        z_in = 1.0 / d3
    by -= l21 * bx
    bz -= l31 * bx + l32 * by
    gz = bz * z_in
    gy = by * y_in - l32 * gz
    gx = bx * x_in - l21 * gy - l31 * gz
    return gx, gy, gz
