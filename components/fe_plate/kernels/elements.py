"""Elements with one quadrature point over a step: stresses from the motion of their corners.

What one point does not see is held by the stabilisation of Flanagan and Belytschko: of the patterns
h_I a linear field leaves no trace in γ_I = h_I - Σ (h_I·x) ∇N. What is left of the velocities,
q = γ_I·v, loads a spring Q each, turned with the element; forces are γ_I Q.
"""

import numpy as np
from numba import njit

from quintet.components.fe_plate.kernels.blocks import (
    COEFFICIENT,
    GRADIENT,
    LENGTH,
    PATTERN,
    RATE,
    RATIO,
    ROWS,
    SPECIFIC,
    STRESS,
    VOLUME,
    V,
    X,
    corners_from,
    least,
    load_corners,
    put_three,
    six,
    take_from_corners,
    three,
)
from quintet.components.fe_plate.kernels.flow import HUGE
from quintet.components.fe_plate.kernels.geometry import mean_geometry
from quintet.components.fe_plate.kernels.material import advance_material
from quintet.components.fe_plate.state import (
    ACTIVE,
    LANES,
    POINT_ROWS,
    SPRING_ENERGY,
    SPRING_ROWS,
    Model,
    Resistance,
    State,
)
from quintet.components.shared.materials.solid import Solid
from quintet.components.shared.numba_options import FAST, FAST_LANEWISE


@njit(**FAST)
def step_elements(
    first: int, last: int, model: Model, state: State, law: Solid, resistance: Resistance, dt: float
) -> tuple[float, float, int]:
    """Advance the stresses of elements and take the forces on their corners from the nodes.

    Parameters
    ----------
    first, last : int
        Blocks, all of one material.
    model, state, law, resistance
    dt : float, s
        Step that led to the present positions; 0 to write forces again.

    Returns
    -------
    float, s : stable step of all of them
    float, 1 : least volume over that at the start, of those not eroded
    int : place of the element that has it
    """
    # Arrays are taken out of their tuples once: each time costs a count of references.
    position, velocity = state.position, state.mean_velocity
    corner, start, filled = model.corner, model.volume, model.filled
    target, acts, forces = model.target, model.acts, state.forces
    points, springs = state.points.reshape(-1), state.springs.reshape(-1)
    work = np.zeros(ROWS * LANES)
    stiff = 0.015625 * resistance.hourglass * (law.bulk + 4.0 / 3.0 * law.shear)
    step, smallest, worst = HUGE, HUGE, first * LANES
    for block in range(first, last):
        begin = block * LANES
        # Rows at places that are known when this is compiled: else loops do not become vectors.
        rows = points[begin * POINT_ROWS : (begin + LANES) * POINT_ROWS]
        patterns = springs[begin * SPRING_ROWS : (begin + LANES) * SPRING_ROWS]
        load_corners(position, corner, begin, LANES, model.depth, X, work)
        load_corners(velocity, corner, begin, LANES, 0.0, V, work)
        mean_geometry(work, dt)
        ratio = compare_volumes(rows, start[begin : begin + LANES], work, law)
        if ratio < smallest:
            smallest, worst = ratio, smallest_of(work, begin)
        step = min(step, advance_material(rows, work, law, resistance, dt))
        hold_patterns(rows, patterns, work, stiff, dt)
        take_from_corners(X, work, acts[block], filled[block], target, forces)
    return step, smallest, worst


@njit(**FAST_LANEWISE)
def compare_volumes(points, start, work, law):  # type: ignore[no-untyped-def]
    """Write volumes over those at the start; return the least. Eroded elements are at rest."""
    for k in range(LANES):
        live = points[ACTIVE * LANES + k] > 0.0
        ratio = work[VOLUME * LANES + k] / start[k]
        ratio = ratio if live else 1.0
        work[RATIO * LANES + k] = ratio
        work[SPECIFIC * LANES + k] = ratio / law.density
        for row in range(GRADIENT * LANES, (GRADIENT + 9) * LANES, LANES):
            work[row + k] = work[row + k] if live else 0.0
    return least(work, RATIO)


@njit(**FAST_LANEWISE)
def smallest_of(work, begin):  # type: ignore[no-untyped-def]
    """Place of the element whose volume is the least of its block."""
    worst = 0
    for k in range(LANES):
        if work[RATIO * LANES + k] < work[RATIO * LANES + worst]:
            worst = k
    return begin + worst


@njit(**FAST_LANEWISE)
def hold_patterns(points, springs, work, stiff, dt):  # type: ignore[no-untyped-def]
    """Load and turn the springs of the patterns; write the forces on the corners in place of X.

    `stiff` times V Σ B² /V² is the stiffness [N/m] of each spring; Σ B²/V² = 1/(2 l²).
    """
    for k in range(LANES):
        live = points[ACTIVE * LANES + k] > 0.0
        volume, length = work[VOLUME * LANES + k], work[LENGTH * LANES + k]
        xx, yy, zz, xy, yz, zx = six(work, STRESS * LANES + k)
        half = 0.5 * dt
        g01, g10 = work[(GRADIENT + 1) * LANES + k], work[(GRADIENT + 3) * LANES + k]
        g12, g21 = work[(GRADIENT + 5) * LANES + k], work[(GRADIENT + 7) * LANES + k]
        g20, g02 = work[(GRADIENT + 6) * LANES + k], work[(GRADIENT + 2) * LANES + k]
        turn = half * (g01 - g10), half * (g12 - g21), half * (g20 - g02)
        loads = 0.5 * stiff * dt * volume / (length * length)
        p1 = three(work, PATTERN, k)
        p2 = three(work, PATTERN + 3, k)
        p3 = three(work, PATTERN + 6, k)
        p4 = three(work, PATTERN + 9, k)
        n1, w1 = loaded(three(springs, 0, k), three(work, RATE, k), turn, loads)
        n2, w2 = loaded(three(springs, 3, k), three(work, RATE + 3, k), turn, loads)
        n3, w3 = loaded(three(springs, 6, k), three(work, RATE + 6, k), turn, loads)
        n4, w4 = loaded(three(springs, 9, k), three(work, RATE + 9, k), turn, loads)
        n1, n2, n3, n4 = masked(n1, live), masked(n2, live), masked(n3, live), masked(n4, live)
        put_three(springs, 0, k, n1)
        put_three(springs, 3, k, n2)
        put_three(springs, 6, k, n3)
        put_three(springs, 9, k, n4)
        at = SPRING_ENERGY * LANES + k
        springs[at] += half * (w1 + w2 + w3 + w4) if live else 0.0
        per = -1.0 / volume
        tx = tensor_row(xx, xy, zx, per, (n1[0], n2[0], n3[0], n4[0]), p1, p2, p3, p4)
        ty = tensor_row(xy, yy, yz, per, (n1[1], n2[1], n3[1], n4[1]), p1, p2, p3, p4)
        tz = tensor_row(zx, yz, zz, per, (n1[2], n2[2], n3[2], n4[2]), p1, p2, p3, p4)
        a1, a2, a3 = (
            three(work, COEFFICIENT, k),
            three(work, COEFFICIENT + 3, k),
            three(work, COEFFICIENT + 6, k),
        )
        c1, c2, c3 = (
            three(work, COEFFICIENT + 9, k),
            three(work, COEFFICIENT + 12, k),
            three(work, COEFFICIENT + 15, k),
        )
        along_x = along(tx, a1, a2, a3, c1, c2, c3, (n1[0], n2[0], n3[0], n4[0]), live)
        along_y = along(ty, a1, a2, a3, c1, c2, c3, (n1[1], n2[1], n3[1], n4[1]), live)
        along_z = along(tz, a1, a2, a3, c1, c2, c3, (n1[2], n2[2], n3[2], n4[2]), live)
        corners_from(along_x, work, X, k)
        corners_from(along_y, work, X + 1, k)
        corners_from(along_z, work, X + 2, k)


@njit(**FAST_LANEWISE)
def loaded(old, rate, turn, loads):  # type: ignore[no-untyped-def]
    """Force of a spring after it has been turned and loaded, and twice its mean power [W]."""
    xy, yz, zx = turn
    n0 = old[0] + loads * rate[0] + xy * old[1] - zx * old[2]
    n1 = old[1] + loads * rate[1] + yz * old[2] - xy * old[0]
    n2 = old[2] + loads * rate[2] + zx * old[0] - yz * old[1]
    power = (old[0] + n0) * rate[0] + (old[1] + n1) * rate[1] + (old[2] + n2) * rate[2]
    return (n0, n1, n2), power


@njit(**FAST_LANEWISE)
def masked(force, live):  # type: ignore[no-untyped-def]
    """Give a force, none of an eroded element."""
    return force[0] if live else 0.0, force[1] if live else 0.0, force[2] if live else 0.0


@njit(**FAST_LANEWISE)
def tensor_row(x, y, z, per, q, p1, p2, p3, p4):  # type: ignore[no-untyped-def]
    """Row of the stress, less what the springs bear of a linear field."""
    return (
        x + per * (q[0] * p1[0] + q[1] * p2[0] + q[2] * p3[0] + q[3] * p4[0]),
        y + per * (q[0] * p1[1] + q[1] * p2[1] + q[2] * p3[1] + q[3] * p4[1]),
        z + per * (q[0] * p1[2] + q[1] * p2[2] + q[2] * p3[2] + q[3] * p4[2]),
    )


@njit(**FAST_LANEWISE)
def along(t, a1, a2, a3, c1, c2, c3, q, live):  # type: ignore[no-untyped-def]
    """Forces along one axis on the corners, by their seven patterns."""
    f1 = t[0] * a1[0] + t[1] * a1[1] + t[2] * a1[2]
    f2 = t[0] * a2[0] + t[1] * a2[1] + t[2] * a2[2]
    f3 = t[0] * a3[0] + t[1] * a3[1] + t[2] * a3[2]
    f4 = t[0] * c1[0] + t[1] * c1[1] + t[2] * c1[2] + q[0]
    f5 = t[0] * c2[0] + t[1] * c2[1] + t[2] * c2[2] + q[1]
    f6 = t[0] * c3[0] + t[1] * c3[1] + t[2] * c3[2] + q[2]
    f7 = q[3]
    return (
        f1 if live else 0.0,
        f2 if live else 0.0,
        f3 if live else 0.0,
        f4 if live else 0.0,
        f5 if live else 0.0,
        f6 if live else 0.0,
        f7,
    )
