"""Elements with eight quadrature points over a step: strains assumed so that bending is exact.

Lanes are points, eight to an element. What trilinear displacements strain falsely is left out of
the rates of strain, along axes that turn with the element: a shear strain is averaged over the
points that differ along its own two axes, so that bending shears nothing; and along each axis the
strain is let vary as the other two do, times -ν/(1 - ν), as Poisson's ratio asks for in bending,
or -1 once the element has yielded, so that plastic flow, which keeps its volume, does not lock.
Forces are given by the transpose. What is added has no mean, so that the patch test is passed.

Papers: Simo & Hughes, J. Appl. Mech. 53 (1986) 51 (assumed strains); Belytschko & Bindeman, Comput.
Methods Appl. Mech. Eng. 105 (1993) 225 (strains of bending).
"""

import math

import numpy as np
from numba import njit

from quintet.components.fe_plate.kernels.assumed_strain import (
    POINTS,
    assume_strains,
    spread_stresses,
)
from quintet.components.fe_plate.kernels.blocks import (
    COFACTOR,
    EDGE,
    FRAME,
    GRADIENT,
    LENGTH,
    ROWS,
    STRESS,
    VOLUME,
    V,
    X,
    corners_from,
    load_corners,
    patterns_of,
    put_nine,
    put_three,
    six,
    take_from_corners,
    three,
)
from quintet.components.fe_plate.kernels.flow import HUGE
from quintet.components.fe_plate.kernels.geometry import cross, dot
from quintet.components.fe_plate.kernels.material import advance_material
from quintet.components.fe_plate.kernels.several_points import compare_volumes, erode
from quintet.components.fe_plate.laws import to_middle
from quintet.components.fe_plate.state import (
    ACTIVE,
    LANES,
    POINT_ROWS,
    Array,
    Model,
    Resistance,
    State,
    Whole,
)
from quintet.components.shared.materials.solid import Solid
from quintet.components.shared.numba_options import FAST, FAST_LANEWISE

PER = LANES // POINTS  # elements in a block
OFF = 1.0 / math.sqrt(3.0)  # of the points from the middle, in ξ, η and ζ
XI, ETA, ZETA = (
    OFF * np.tile(np.where((np.arange(POINTS) >> bit) & 1, 1.0, -1.0), PER) for bit in (0, 1, 2)
)
CUBE = math.sqrt(8.0 / 3.0)  # edge of a cube times √Σ|∇N|² at its points


@njit(**FAST)
def step_eight_points(
    first: int, last: int, model: Model, state: State, law: Solid, resistance: Resistance, dt: float
) -> tuple[float, float, int]:
    """Advance the stresses of elements and take the forces on their corners from the nodes.

    As `elements.step_elements`; the place that is returned is that of a point.
    """
    position, velocity = state.position, state.mean_velocity
    corner, start, filled = model.corner, model.volume, model.filled
    target, acts, forces = model.target, model.acts, state.forces
    points = state.points.reshape(-1)
    work = np.zeros(ROWS * LANES)
    step, smallest, worst = HUGE, HUGE, first * LANES
    for block in range(first, last):
        begin, at = block * PER, block * LANES
        rows, before = points[at * POINT_ROWS : (at + LANES) * POINT_ROWS], start[at : at + LANES]
        erode(rows, POINTS)
        load_corners(position, corner, begin, PER, model.depth, X, work)
        load_corners(velocity, corner, begin, PER, 0.0, V, work)
        broadcast(work)
        point_geometry(work, dt)
        assume_strains(rows, work, law)
        compare_volumes(rows, before, work, law, dt, POINTS)
        for k in range(LANES):
            ratio = work[VOLUME * LANES + k] / before[k]
            if ratio < smallest and rows[ACTIVE * LANES + k] > 0.0:
                smallest, worst = ratio, block * LANES + k
        step = min(step, advance_material(rows, work, law, resistance, dt))
        spread_stresses(rows, work, law)
        sum_forces(rows, work)
        take_from_corners(X, work, acts[block], filled[block], target, forces)
    return step, smallest, worst


@njit(**FAST_LANEWISE)
def broadcast(work):  # type: ignore[no-untyped-def]
    """Give each point the corners of its element, which stand in the first lanes."""
    for row in range(X * LANES, (X + 24) * LANES, LANES):
        for element in range(PER - 1, -1, -1):
            place, rate = work[row + element], work[row + (V - X) * LANES + element]
            for k in range(POINTS * element, POINTS * (element + 1)):
                work[row + k] = place
                work[row + (V - X) * LANES + k] = rate


@njit(**FAST_LANEWISE)
def combined(a, p, b, q, c, r):  # type: ignore[no-untyped-def]
    """Sum p a + q b + r c of vectors."""
    return (
        p * a[0] + q * b[0] + r * c[0],
        p * a[1] + q * b[1] + r * c[1],
        p * a[2] + q * b[2] + r * c[2],
    )


@njit(**FAST_LANEWISE)
def slopes(x, y, z, xi, eta, zeta):  # type: ignore[no-untyped-def]
    """Slopes in ξ, η and ζ of a vector field with these patterns along each axis."""
    j1, j2, j3 = (x[1], y[1], z[1]), (x[2], y[2], z[2]), (x[3], y[3], z[3])
    g1, g2, g3 = (x[4], y[4], z[4]), (x[5], y[5], z[5]), (x[6], y[6], z[6])
    g4 = x[7], y[7], z[7]
    a = combined(g2, zeta, g3, eta, g4, eta * zeta)
    b = combined(g1, zeta, g3, xi, g4, zeta * xi)
    c = combined(g1, eta, g2, xi, g4, xi * eta)
    return (
        (j1[0] + a[0], j1[1] + a[1], j1[2] + a[2]),
        (j2[0] + b[0], j2[1] + b[1], j2[2] + b[2]),
        (j3[0] + c[0], j3[1] + c[1], j3[2] + c[2]),
    )


@njit(**FAST_LANEWISE)
def point_geometry(work, dt):  # type: ignore[no-untyped-def]
    """Write volumes, lengths, V∇ξ, V∇η, V∇ζ, velocity gradients and axes of the points.

    ω² ≤ 8 c² Σ|∇N|² of any point, as the stiffness of an element is the sum of those of its points.
    """
    half = 0.5 * dt
    for k in range(LANES):
        xi, eta, zeta = XI[k], ETA[k], ZETA[k]
        x, y, z = patterns_of(work, X, k), patterns_of(work, X + 1, k), patterns_of(work, X + 2, k)
        u, v, w = patterns_of(work, V, k), patterns_of(work, V + 1, k), patterns_of(work, V + 2, k)
        x1, x2, x3 = slopes(x, y, z, xi, eta, zeta)
        a, b, c = cross(x2, x3), cross(x3, x1), cross(x1, x2)
        volume = dot(x1, a)
        work[VOLUME * LANES + k] = volume
        put_three(work, COFACTOR, k, a)
        put_three(work, COFACTOR + 3, k, b)
        put_three(work, COFACTOR + 6, k, c)
        ab, ca = combined(a, eta, b, xi, c, 0.0), combined(a, zeta, b, 0.0, c, xi)
        bc = combined(a, 0.0, b, zeta, c, eta)
        abc = combined(a, eta * zeta, b, zeta * xi, c, xi * eta)
        squares = dot(a, a) + dot(b, b) + dot(c, c)
        squares += dot(ab, ab) + dot(bc, bc) + dot(ca, ca) + dot(abc, abc)
        spread = math.sqrt(0.125 * squares) / volume  # √Σ|∇N|², 1/m
        work[LENGTH * LANES + k] = math.sqrt(0.5) / spread
        work[EDGE * LANES + k] = CUBE / spread
        u1, u2, u3 = slopes(u, v, w, xi, eta, zeta)
        per = 1.0 / volume
        row0 = combined(a, per * u1[0], b, per * u2[0], c, per * u3[0])
        row1 = combined(a, per * u1[1], b, per * u2[1], c, per * u3[1])
        row2 = combined(a, per * u1[2], b, per * u2[2], c, per * u3[2])
        end = row0[0], row0[1], row0[2], row1[0], row1[1], row1[2], row2[0], row2[1], row2[2]
        put_nine(work, GRADIENT, k, to_middle(end, half))
        j1, j2 = (x[1], y[1], z[1]), (x[2], y[2], z[2])
        e1 = combined(j1, 1.0 / math.sqrt(dot(j1, j1)), j1, 0.0, j1, 0.0)
        n = cross(j1, j2)
        e3 = combined(n, 1.0 / math.sqrt(dot(n, n)), n, 0.0, n, 0.0)
        put_three(work, FRAME, k, e1)
        put_three(work, FRAME + 3, k, cross(e3, e1))
        put_three(work, FRAME + 6, k, e3)


@njit(**FAST_LANEWISE)
def sum_forces(points, work):  # type: ignore[no-untyped-def]
    """Write the forces on corners in the first lanes of X: Σ V σ ∇N over an element's points."""
    for k in range(LANES):
        live = points[ACTIVE * LANES + k] > 0.0
        share = 0.125 if live else 0.0
        xx, yy, zz, xy, yz, zx = six(work, STRESS * LANES + k)
        a, b = three(work, COFACTOR, k), three(work, COFACTOR + 3, k)
        c = three(work, COFACTOR + 6, k)
        put_patterns(work, X, k, share, (xx, xy, zx), a, b, c)
        put_patterns(work, X + 7, k, share, (xy, yy, yz), a, b, c)
        put_patterns(work, X + 14, k, share, (zx, yz, zz), a, b, c)
    summed = np.zeros((PER, 21))
    for row in range(21):
        for element in range(PER):
            for k in range(POINTS * element, POINTS * (element + 1)):
                summed[element, row] += work[(X + row) * LANES + k]
    for element in range(PER):
        p = summed[element]
        corners_from((p[0], p[1], p[2], p[3], p[4], p[5], p[6]), work, X, element)
        corners_from((p[7], p[8], p[9], p[10], p[11], p[12], p[13]), work, X + 1, element)
        corners_from((p[14], p[15], p[16], p[17], p[18], p[19], p[20]), work, X + 2, element)


@njit(**FAST_LANEWISE)
def put_patterns(work, row, k, share, stress, a, b, c):  # type: ignore[no-untyped-def]
    """Write forces along one axis with the signs ξ, η, ζ, ηζ, ζξ, ξη and ξηζ of the corners."""
    xi, eta, zeta = XI[k], ETA[k], ZETA[k]
    s1, s2, s3 = share * dot(stress, a), share * dot(stress, b), share * dot(stress, c)
    at = row * LANES + k
    work[at] = s1
    work[at + LANES] = s2
    work[at + 2 * LANES] = s3
    work[at + 3 * LANES] = zeta * s2 + eta * s3
    work[at + 4 * LANES] = zeta * s1 + xi * s3
    work[at + 5 * LANES] = eta * s1 + xi * s2
    work[at + 6 * LANES] = eta * zeta * s1 + zeta * xi * s2 + xi * eta * s3


@njit(**FAST)
def write_point_volumes(position: Array, corner: Whole, beyond: float, out: Array) -> None:
    """Write the volumes (8 e,) m3 of the points of elements, a multiple of a block's number."""
    work = np.zeros(ROWS * LANES)
    for begin in range(0, len(corner), PER):
        load_corners(position, corner, begin, PER, beyond, X, work)
        broadcast(work)
        point_geometry(work, 0.0)
        for k in range(LANES):
            out[begin * POINTS + k] = work[VOLUME * LANES + k]
