"""Tetrahedra with ten nodes and four quadrature points over a step.

Lanes are points, four to an element, at λ = (a, b, b, b) and so on in barycentric coordinates, with
a = (5 + 3√5)/20 and b = (5 - √5)/20: exact for strains that are linear, so that an element with
straight edges has no mode without energy but its six rigid ones. With h_i = (4λ_i - 1) x_i + 4 Σ_j
λ_j x_ij of corners x_i and midside nodes x_ij, a field has the slope ∇x = Σ h_i ∇λ_i.

An element that has yielded takes the mean rate of dilatation at its points, and a fifth of what
each differs from it: plastic flow keeps its volume and would lock at four points, but a point whose
volume nothing held would be turned inside out. An elastic element takes the rate of each point,
which bending needs. Forces are given by the transpose.

Each node has a share of the mass by the diagonal of the consistent mass matrix (Hinton, Rock &
Zienkiewicz 1976): 1/36 at corners, 4/27 at midside nodes. The stiffness is the sum of those of the
points, K = Σ K_q, and the mass that of M_q with shares θ_aq > 0 of each node's, Σ_q θ_aq = 1, so
ω² ≤ max_q of the frequencies of K_q and M_q:

    ω² ≤ V_q/m ((K - 2G/3) tr S + 2G |S|),  S = Σ_a ∇N_a ∇N_aᵀ/(w_a θ_aq)

with m the element's mass, w_a m the node's, and |S| the Frobenius norm, no less than the greatest
eigenvalue. The shares θ are those that make tr S of a regular tetrahedron least.

Papers: Hinton, Rock & Zienkiewicz, Earthq. Eng. Struct. Dyn. 4 (1976) 245 (masses); Hughes, Int. J.
Numer. Methods Eng. 15 (1980) 1413 (mean dilatation); Flanagan & Belytschko, J. Appl. Mech. 51
(1984) 35 (bounds of frequencies).
"""

import math

import numpy as np
from numba import njit

from quintet.components.fe_plate.kernels.blocks import (
    COFACTOR,
    EDGE,
    GRADIENT,
    LENGTH,
    RATIO,
    ROWS,
    STRESS,
    VOLUME,
    put_nine,
    put_three,
    six,
    three,
)
from quintet.components.fe_plate.kernels.eight_points import combined
from quintet.components.fe_plate.kernels.flow import HUGE
from quintet.components.fe_plate.kernels.geometry import cross, dot
from quintet.components.fe_plate.kernels.material import advance_material
from quintet.components.fe_plate.kernels.several_points import compare_volumes, erode
from quintet.components.fe_plate.laws import to_middle
from quintet.components.fe_plate.meshes.four_points import OWN, REST
from quintet.components.fe_plate.state import (
    ACTIVE,
    LANES,
    NODE_SHARES,
    POINT_ROWS,
    STRAIN,
    Model,
    Resistance,
    State,
)
from quintet.components.shared.materials.solid import Solid
from quintet.components.shared.numba_options import FAST, FAST_LANEWISE

POINTS, NODES = 4, 10  # of an element
PER = LANES // POINTS  # elements in a block
X, V = 0, 30  # rows of the nodes of an element, 3a + d: m, m/s; forces in place of X
TRACE, NORM = 60, 61  # of S, 1/m2
WEIGHT = 1.0 / 24.0  # of each of four points; the reference element has a volume of 1/6
LAMBDA = np.full((4, LANES), REST)
LAMBDA[np.arange(LANES) % POINTS, np.arange(LANES)] = OWN
# θ of a corner at its own point and at others, of a midside node at those of its ends and others.
THETA = 0.5, 1.0 / 6.0, 0.3883, 0.1117
CORNER_OWN, CORNER_REST = 1.0 / (NODE_SHARES[0] * THETA[0]), 1.0 / (NODE_SHARES[0] * THETA[1])
EDGE_OWN, EDGE_REST = 1.0 / (NODE_SHARES[4] * THETA[2]), 1.0 / (NODE_SHARES[4] * THETA[3])
ALIKE = 0.8  # share of differences of dilatation that is left out where an element has yielded
SPACING = 3.65  # of nodes of a regular tetrahedron, V^(1/3), over the length 2/√(V_q/V tr S)


@njit(**FAST)
def step_ten_nodes(
    first: int, last: int, model: Model, state: State, law: Solid, resistance: Resistance, dt: float
) -> tuple[float, float, int]:
    """Advance the stresses of elements and take the forces on their nodes from these.

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
        load_nodes(position, corner, begin, X, work)
        load_nodes(velocity, corner, begin, V, work)
        point_geometry(work, dt)
        average_dilatation(rows, work, GRADIENT, 4)
        compare_volumes(rows, before, work, law, dt, POINTS)
        for k in range(LANES):
            ratio = work[VOLUME * LANES + k] / before[k]
            if ratio < smallest and rows[ACTIVE * LANES + k] > 0.0:
                smallest, worst = ratio, block * LANES + k
        write_lengths(before, work, law)
        step = min(step, advance_material(rows, work, law, resistance, dt))
        average_dilatation(rows, work, STRESS, 1)
        sum_forces(rows, work)
        take_from_nodes(work, acts[block], filled[block], target, forces)
    return step, smallest, worst


@njit(**FAST_LANEWISE)
def load_nodes(values, corner, begin, row, out):  # type: ignore[no-untyped-def]
    """Take values (n, 3) of the nodes of a block's elements, for each of their points."""
    for element in range(PER):
        for a in range(NODES):
            node = corner[begin + element, a]
            x, y, z = values[node, 0], values[node, 1], values[node, 2]
            at = (row + 3 * a) * LANES + POINTS * element
            for k in range(at, at + POINTS):
                out[k], out[k + LANES], out[k + 2 * LANES] = x, y, z


@njit(**FAST_LANEWISE)
def take_from_nodes(work, first, count, target, out):  # type: ignore[no-untyped-def]
    """Take rows of forces from those (rows, 3) that they act on, element by element."""
    for element in range(count):
        for a in range(NODES):
            at = (X + 3 * a) * LANES + element
            node = target[first + element, a]
            out[node, 0] -= work[at]
            out[node, 1] -= work[at + LANES]
            out[node, 2] -= work[at + 2 * LANES]


@njit(**FAST_LANEWISE)
def weighed(work, row, k, corner, edges, of_corner_node, others):  # type: ignore[no-untyped-def]
    """h_i = (4λ_i - 1) x_i + 4 Σ λ_j x_ij, of a corner and its three edges."""
    x = three(work, row + 3 * corner, k)
    a, b = three(work, row + 3 * edges[0], k), three(work, row + 3 * edges[1], k)
    c = three(work, row + 3 * edges[2], k)
    share, p, q, r = 4.0 * of_corner_node - 1.0, 4.0 * others[0], 4.0 * others[1], 4.0 * others[2]
    return (
        share * x[0] + p * a[0] + q * b[0] + r * c[0],
        share * x[1] + p * a[1] + q * b[1] + r * c[1],
        share * x[2] + p * a[2] + q * b[2] + r * c[2],
    )


@njit(**FAST_LANEWISE)
def slopes(work, row, k):  # type: ignore[no-untyped-def]
    """Slopes of a vector field of the nodes along λ₁, λ₂ and λ₃, with λ₀ = 1 - λ₁ - λ₂ - λ₃."""
    l0, l1, l2, l3 = LAMBDA[0, k], LAMBDA[1, k], LAMBDA[2, k], LAMBDA[3, k]
    h0 = weighed(work, row, k, 0, (4, 6, 7), l0, (l1, l2, l3))
    h1 = weighed(work, row, k, 1, (4, 5, 8), l1, (l0, l2, l3))
    h2 = weighed(work, row, k, 2, (6, 5, 9), l2, (l0, l1, l3))
    h3 = weighed(work, row, k, 3, (7, 8, 9), l3, (l0, l1, l2))
    return (
        (h1[0] - h0[0], h1[1] - h0[1], h1[2] - h0[2]),
        (h2[0] - h0[0], h2[1] - h0[1], h2[2] - h0[2]),
        (h3[0] - h0[0], h3[1] - h0[1], h3[2] - h0[2]),
    )


@njit(**FAST_LANEWISE)
def point_geometry(work, dt):  # type: ignore[no-untyped-def]
    """Write volumes, 24 V∇λ, velocity gradients, and the trace and norm of S of the points."""
    half = 0.5 * dt
    for k in range(LANES):
        x1, x2, x3 = slopes(work, X, k)
        a, b, c = cross(x2, x3), cross(x3, x1), cross(x1, x2)
        volume = dot(x1, a)
        put_three(work, COFACTOR, k, a)
        put_three(work, COFACTOR + 3, k, b)
        put_three(work, COFACTOR + 6, k, c)
        work[VOLUME * LANES + k] = WEIGHT * volume
        u1, u2, u3 = slopes(work, V, k)
        per = 1.0 / volume
        row0 = combined(a, per * u1[0], b, per * u2[0], c, per * u3[0])
        row1 = combined(a, per * u1[1], b, per * u2[1], c, per * u3[1])
        row2 = combined(a, per * u1[2], b, per * u2[2], c, per * u3[2])
        end = row0[0], row0[1], row0[2], row1[0], row1[1], row1[2], row2[0], row2[1], row2[2]
        put_nine(work, GRADIENT, k, to_middle(end, half))
    for k in range(LANES):
        a, b = three(work, COFACTOR, k), three(work, COFACTOR + 3, k)
        c = three(work, COFACTOR + 6, k)
        per = WEIGHT / work[VOLUME * LANES + k]
        g1, g2 = (per * a[0], per * a[1], per * a[2]), (per * b[0], per * b[1], per * b[2])
        g3 = per * c[0], per * c[1], per * c[2]
        g0 = -g1[0] - g2[0] - g3[0], -g1[1] - g2[1] - g3[1], -g1[2] - g2[2] - g3[2]
        trace, norm = spread_of(g0, g1, g2, g3, k)
        work[TRACE * LANES + k] = trace
        work[NORM * LANES + k] = norm


@njit(**FAST_LANEWISE)
def squared(v, w):  # type: ignore[no-untyped-def]
    """Tensor w v vᵀ as xx yy zz xy yz zx."""
    x, y, z = v
    return w * x * x, w * y * y, w * z * z, w * x * y, w * y * z, w * z * x


@njit(**FAST_LANEWISE)
def plus(p, q):  # type: ignore[no-untyped-def]
    """Sum of two symmetric tensors."""
    return p[0] + q[0], p[1] + q[1], p[2] + q[2], p[3] + q[3], p[4] + q[4], p[5] + q[5]


@njit(**FAST_LANEWISE)
def of_corner(g, coordinate):  # type: ignore[no-untyped-def]
    """∇N ∇Nᵀ/(w θ) of a corner, ∇N = (4λ - 1) ∇λ."""
    slope = 4.0 * coordinate - 1.0
    return squared(g, slope * slope * (CORNER_OWN if coordinate > 0.5 else CORNER_REST))


@njit(**FAST_LANEWISE)
def of_edge(g, p, h, q):  # type: ignore[no-untyped-def]
    """∇N ∇Nᵀ/(w θ) of a midside node, ∇N = 4 (λ_i ∇λ_j + λ_j ∇λ_i)."""
    slope = p * h[0] + q * g[0], p * h[1] + q * g[1], p * h[2] + q * g[2]
    return squared(slope, 16.0 * (EDGE_OWN if max(p, q) > 0.5 else EDGE_REST))


@njit(**FAST_LANEWISE)
def spread_of(g0, g1, g2, g3, k):  # type: ignore[no-untyped-def]
    """Trace and norm of S [1/m2] at a point, of the slopes ∇λ [1/m]."""
    l0, l1, l2, l3 = LAMBDA[0, k], LAMBDA[1, k], LAMBDA[2, k], LAMBDA[3, k]
    s = plus(plus(of_corner(g0, l0), of_corner(g1, l1)), plus(of_corner(g2, l2), of_corner(g3, l3)))
    s = plus(s, plus(of_edge(g0, l0, g1, l1), of_edge(g1, l1, g2, l2)))
    s = plus(s, plus(of_edge(g2, l2, g0, l0), of_edge(g0, l0, g3, l3)))
    xx, yy, zz, xy, yz, zx = plus(s, plus(of_edge(g1, l1, g3, l3), of_edge(g2, l2, g3, l3)))
    squares = xx * xx + yy * yy + zz * zz + 2.0 * (xy * xy + yz * yz + zx * zx)
    return xx + yy + zz, math.sqrt(squares)


@njit(**FAST_LANEWISE)
def write_lengths(start, work, law):  # type: ignore[no-untyped-def]
    """Write lengths: over the speed of sound of a point each is a proven stable step.

    ρc² = K + 4G/3 with the K of the pressure now; of a law of shocks it may be greater than that
    at rest, and |S| is replaced by tr S.
    """
    for first in range(0, LANES, POINTS):
        whole = 0.0
        for k in range(first, first + POINTS):
            whole += start[k]
        for k in range(first, first + POINTS):
            ratio = work[RATIO * LANES + k]
            trace, norm = work[TRACE * LANES + k], work[NORM * LANES + k]
            sheared = 2.0 * law.shear / (law.bulk / ratio + 4.0 / 3.0 * law.shear)
            sheared = 0.0 if law.shocks else sheared
            per = work[VOLUME * LANES + k] / (whole * ratio)
            work[LENGTH * LANES + k] = 2.0 / math.sqrt(per * (trace - sheared * (trace - norm)))
            work[EDGE * LANES + k] = 2.0 * SPACING / math.sqrt(per * trace)


@njit(**FAST_LANEWISE)
def average_dilatation(points, work, row, apart):  # type: ignore[no-untyped-def]
    """Bring the traces of tensors at the points of elements that have yielded near their means.

    Diagonals stand in rows `apart` from each other. The means are weighed with the volumes: the
    operator is its own transpose, and rates of strain and stresses do the same work.
    """
    for first in range(0, LANES, POINTS):
        whole, mean, most = 0.0, 0.0, 0.0
        for k in range(first, first + POINTS):
            at, volume = row * LANES + k, work[VOLUME * LANES + k]
            whole += volume
            mean += volume * (work[at] + work[at + apart * LANES] + work[at + 2 * apart * LANES])
            most = max(most, points[STRAIN * LANES + k])
        mean /= whole
        for k in range(first, first + POINTS):
            at = row * LANES + k
            trace = work[at] + work[at + apart * LANES] + work[at + 2 * apart * LANES]
            change = ALIKE * (mean - trace) / 3.0 if most > 0.0 else 0.0
            work[at] += change
            work[at + apart * LANES] += change
            work[at + 2 * apart * LANES] += change


@njit(**FAST_LANEWISE)
def sum_forces(points, work):  # type: ignore[no-untyped-def]
    """Write the forces on nodes in the first lanes of X: Σ V σ ∇N over an element's points."""
    for k in range(LANES):
        share = WEIGHT if points[ACTIVE * LANES + k] > 0.0 else 0.0
        xx, yy, zz, xy, yz, zx = six(work, STRESS * LANES + k)
        a, b = three(work, COFACTOR, k), three(work, COFACTOR + 3, k)
        c = three(work, COFACTOR + 6, k)
        x, y = (share * xx, share * xy, share * zx), (share * xy, share * yy, share * yz)
        z = share * zx, share * yz, share * zz
        t1, t2 = (dot(x, a), dot(y, a), dot(z, a)), (dot(x, b), dot(y, b), dot(z, b))
        t3 = dot(x, c), dot(y, c), dot(z, c)
        t0 = -t1[0] - t2[0] - t3[0], -t1[1] - t2[1] - t3[1], -t1[2] - t2[2] - t3[2]
        l0, l1, l2, l3 = LAMBDA[0, k], LAMBDA[1, k], LAMBDA[2, k], LAMBDA[3, k]
        put_scaled(work, 0, k, t0, 4.0 * l0 - 1.0, t0, 0.0)
        put_scaled(work, 1, k, t1, 4.0 * l1 - 1.0, t1, 0.0)
        put_scaled(work, 2, k, t2, 4.0 * l2 - 1.0, t2, 0.0)
        put_scaled(work, 3, k, t3, 4.0 * l3 - 1.0, t3, 0.0)
        put_scaled(work, 4, k, t1, 4.0 * l0, t0, 4.0 * l1)
        put_scaled(work, 5, k, t2, 4.0 * l1, t1, 4.0 * l2)
        put_scaled(work, 6, k, t0, 4.0 * l2, t2, 4.0 * l0)
        put_scaled(work, 7, k, t3, 4.0 * l0, t0, 4.0 * l3)
        put_scaled(work, 8, k, t3, 4.0 * l1, t1, 4.0 * l3)
        put_scaled(work, 9, k, t3, 4.0 * l2, t2, 4.0 * l3)
    for row in range(X * LANES, (X + 3 * NODES) * LANES, LANES):
        for element in range(PER):
            total = 0.0
            for k in range(row + POINTS * element, row + POINTS * (element + 1)):
                total += work[k]
            work[row + element] = total  # a lane that has been summed already


@njit(**FAST_LANEWISE)
def put_scaled(work, node, k, p, share, q, other):  # type: ignore[no-untyped-def]
    """Write the force share p + other q on a node."""
    force = (
        share * p[0] + other * q[0],
        share * p[1] + other * q[1],
        share * p[2] + other * q[2],
    )
    put_three(work, X + 3 * node, k, force)
