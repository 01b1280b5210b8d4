"""Walls whose density is that of the fluid before them; imported only by a scene that asks.

Modified dynamic boundary condition: English et al., Comput. Part. Mech. 9 (2022) 911. The
density at the mirror point of a boundary particle, and its gradient there, are fitted to the
fluid around that point and carried on to the particle, so that the fluid feels its own pressure
go on into the wall and comes as near to it as to itself. The fit is one of moving least squares
(English et al. solve the equations of Liu & Liu): linear fields are met exactly by both, and the
symmetric matrix of this one tells by its pivots along which directions the fluid is too thin to
fit, as across a film or a plane of particles; the gradient there is none.
"""

import math

import numpy as np
from numba import njit

from quintet.components.shared.numba_options import FAST
from quintet.components.shared.packing import empty_rows, longest_list, out_of_reach, pack_rows
from quintet.components.shared.search.neighbours import Lists
from quintet.components.shared.smoothing.smoothing import kernel
from quintet.components.shared.threads import Team
from quintet.components.sph_fluid.build import wall_points
from quintet.components.sph_fluid.geometry import FACES, closed_faces
from quintet.components.sph_fluid.laws import Fluid, constants, pressure_term
from quintet.components.sph_fluid.obstacles import obstacle_mirrors
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import Array, State, Whole

THIN = 0.02  # h², variance of places along a direction below which no gradient is fitted
NONE = 1e-2  # Σ V W below which there is no fluid
WALL, HELD = -1, -2  # in place of a row: the lists have none, or a contact potential holds it


def mirrors(params: SphFluidParams) -> Array:
    """Mirror points (n, 3) m of all wall particles, through the nearest point of their wall."""
    points = wall_points(params)
    if params.boundary.walls is None:
        return obstacle_mirrors(params)
    closed = closed_faces(params)
    low, high = (np.array(corner) for corner in params.boundary.walls)
    for axis in range(3):
        low[axis] = low[axis] if FACES[2 * axis] in closed else -np.inf
        high[axis] = high[axis] if FACES[2 * axis + 1] in closed else np.inf
    images = 2.0 * np.clip(points, low, high) - points
    return np.concatenate([images, obstacle_mirrors(params)])


def press_walls(
    state: State, near: Lists, rows: Whole, listed: Whole, held: Whole, params: SphFluidParams,
    team: Team,
) -> None:  # fmt: skip
    """Walls and samples: density as if the fluid went on into them.

    `rows` (samples,) are those of the samples, `listed` where the lists have what is around them,
    `held` (k,) the samples that a contact potential holds.
    """
    own = np.full(len(state.mirror), WALL)
    own[rows - state.fluid] = listed
    own[rows[held] - state.fluid] = HELD
    arrays = (own, state.mirror, state.place, state.motion, near)
    weight = params.density * math.hypot(*params.hydrostatic_gravity) / params.sound_speed**2
    team.run(extrapolate, len(own), state.fluid, *arrays, weight, constants(params))


@njit(**FAST)
def extrapolate(
    first: int, last: int, split: int, own: Whole, mirrors: Array, place: Array, motion: Array,
    near: Lists, weight: float, fluid: Fluid,
) -> None:  # fmt: skip
    """Write density and p/ρ² of boundary rows [first, last).

    Where a mirror point sees no fluid, as between a body and the floor it stands on, the mean
    density around the particle itself is taken (Adami, Hu & Adams, J. Comput. Phys. 231 (2012)
    7057), if `own` says which row of the lists that is. Walls never pull, and the fit raises the
    mean by no more than itself and the fluid's weight, ρ₀g/c₀² = `weight` [kg/m4]: beyond that the
    gradient is noise.
    """
    begin, _, end, _ = near
    most = longest_list(split + first, split + last, begin, end)
    for b in range(first, last):
        if own[b] >= 0:
            most = max(most, end[own[b]] - begin[own[b]])
    beside = empty_rows(most, 4, place.dtype)
    for b in range(first, last):
        if own[b] == HELD:
            continue
        i = split + b
        x, y, z = mirrors[b, 0], mirrors[b, 1], mirrors[b, 2]
        mean, rise, weights = fit(i, x, y, z, place[i], place, near, fluid, beside)
        if weights < NONE and own[b] >= 0:
            x, y, z = place[i, 0], place[i, 1], place[i, 2]
            mean, rise, weights = fit(own[b], x, y, z, place[i], place, near, fluid, beside)
            rise = 0.0
        excess = mean + min(rise, max(mean, 0.0) + weight * distance(place[i], x, y, z))
        place[i, 3] = fluid.density + max(excess, 0.0)
        motion[i, 3] = pressure_term(place[i, 3], fluid)


@njit(**FAST)
def reflect(
    first: int, last: int, split: int, mirrors: Array, place: Array, motion: Array, near: Lists,
    fluid: Fluid, seen: Array,
) -> None:  # fmt: skip
    """Write velocities of boundary rows [first, last) that bring the fluid to rest at the face.

    2u_wall - u(mirror point), with the fluid's velocity there from a plane through its
    neighbours', so that a linear profile is met exactly; the wall's own where there is no fluid.
    """
    begin, _, end, neighbour = near
    for b in range(first, last):
        i = split + b
        x, y, z = mirrors[b, 0], mirrors[b, 1], mirrors[b, 2]
        s, mx, my, mz, ax, ay, az = level(i, x, y, z, place, near, fluid)
        if s < NONE:
            continue
        u, v, w = 0.0, 0.0, 0.0
        for k in range(np.uint64(begin[i]), np.uint64(end[i])):
            j = np.uint64(neighbour[k])
            dx, dy, dz = place[j, 0] - x, place[j, 1] - y, place[j, 2] - z
            share = (
                kernel(dx * dx + dy * dy + dz * dz, fluid.smoothing)
                * fluid.mass
                / (place[j, 3] * s)
            )
            share *= 1.0 + ax * (dx - mx) + ay * (dy - my) + az * (dz - mz)
            u += share * motion[j, 0]
            v += share * motion[j, 1]
            w += share * motion[j, 2]
        seen[i, 0] = 2.0 * motion[i, 0] - u
        seen[i, 1] = 2.0 * motion[i, 1] - v
        seen[i, 2] = 2.0 * motion[i, 2] - w


@njit(inline="always")
def distance(target, x, y, z):  # type: ignore[no-untyped-def]
    """From a point to a target [m]."""
    return math.sqrt((target[0] - x) ** 2 + (target[1] - y) ** 2 + (target[2] - z) ** 2)


@njit(inline="always")
def fit(row, x, y, z, target, place, near, fluid, beside):  # type: ignore[no-untyped-def]
    """Mean of ρ - ρ₀ around a point, rise from there to a target, and Σ V W, of a row's fluid."""
    begin, _, end, neighbour = near
    if begin[row] == end[row]:
        return 0.0, 0.0, 0.0
    out = out_of_reach(x, fluid.smoothing.length), y, z, fluid.density
    count = pack_rows(begin[row], end[row], neighbour, place, out, beside)
    inverse = 1.0 / fluid.smoothing.length
    s, sx, sy, sz = 0.0, 0.0, 0.0, 0.0
    xx, xy, xz, yy, yz, zz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    b, bx, by, bz = 0.0, 0.0, 0.0, 0.0
    for k in range(count):
        dx, dy, dz = beside[k, 0] - x, beside[k, 1] - y, beside[k, 2] - z
        w = kernel(dx * dx + dy * dy + dz * dz, fluid.smoothing) * fluid.mass / beside[k, 3]
        dx, dy, dz = dx * inverse, dy * inverse, dz * inverse
        excess = beside[k, 3] - fluid.density
        s += w
        wx, wy, wz, e = w * dx, w * dy, w * dz, w * excess
        sx += wx
        sy += wy
        sz += wz
        xx += wx * dx
        xy += wx * dy
        xz += wx * dz
        yy += wy * dy
        yz += wy * dz
        zz += wz * dz
        b += e
        bx += e * dx
        by += e * dy
        bz += e * dz
    if s < NONE:
        return 0.0, 0.0, s
    mean = b / s
    # About the mean place three unknowns are left.
    mx, my, mz = sx / s, sy / s, sz / s
    xx, xy, xz = xx / s - mx * mx, xy / s - mx * my, xz / s - mx * mz
    yy, yz, zz = yy / s - my * my, yz / s - my * mz, zz / s - mz * mz
    bx, by, bz = bx / s - mx * mean, by / s - my * mean, bz / s - mz * mean
    gx, gy, gz = solve(xx, xy, xz, yy, yz, zz, bx, by, bz)
    rise = gx * ((target[0] - x) * inverse - mx) + gy * ((target[1] - y) * inverse - my)
    return mean, rise + gz * ((target[2] - z) * inverse - mz), s


@njit(**FAST)
def level(row, x, y, z, place, near, fluid):  # type: ignore[no-untyped-def]
    """Σ V W of a row's fluid around a point, m and a: numbers that fit a plane to any field f.

    Its value at the point is Σ V W (1 + a·(r - m)) f / Σ V W, r from the point.
    """
    begin, _, end, neighbour = near
    inverse = 1.0 / fluid.smoothing.length
    s, sx, sy, sz = 0.0, 0.0, 0.0, 0.0
    xx, xy, xz, yy, yz, zz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(np.uint64(begin[row]), np.uint64(end[row])):
        j = np.uint64(neighbour[k])
        dx, dy, dz = place[j, 0] - x, place[j, 1] - y, place[j, 2] - z
        w = kernel(dx * dx + dy * dy + dz * dz, fluid.smoothing) * fluid.mass / place[j, 3]
        dx, dy, dz = dx * inverse, dy * inverse, dz * inverse
        s += w
        wx, wy, wz = w * dx, w * dy, w * dz
        sx += wx
        sy += wy
        sz += wz
        xx += wx * dx
        xy += wx * dy
        xz += wx * dz
        yy += wy * dy
        yz += wy * dz
        zz += wz * dz
    if s < NONE:
        return s, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    mx, my, mz = sx / s, sy / s, sz / s
    xx, xy, xz = xx / s - mx * mx, xy / s - mx * my, xz / s - mx * mz
    yy, yz, zz = yy / s - my * my, yz / s - my * mz, zz / s - mz * mz
    ax, ay, az = solve(xx, xy, xz, yy, yz, zz, -mx, -my, -mz)
    h = fluid.smoothing.length
    return s, mx * h, my * h, mz * h, ax * inverse, ay * inverse, az * inverse


@njit(inline="always")
def solve(xx, xy, xz, yy, yz, zz, bx, by, bz):  # type: ignore[no-untyped-def]
    """Gradient of a plane by Cholesky's method, none along directions that are thin."""
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
