"""Rates of change by the fluxes between nodes: pairs of LANES nodes side by side.

    dq_i/dt = -2 Σ_j |c_ij| (F(q_L, q_R; n_ij) - F(q_i; n_ij)),   n_ij = c_ij/|c_ij|

The 2 is there because the flux is that in the middle of a pair.
"""

from typing import Any

import numpy as np
from numba import njit

from quintet.components.meshless_gas.laws.fluxes import (
    FAST_LANEWISE,
    half_steps,
    in_laboratory,
    kept_share,
    pair_direction,
    pair_rates,
    positive_share,
    sides,
    thresholds,
)
from quintet.components.shared.numba_options import FAST

LANES = 16
# Rows of what a block needs: of its nodes, then of one neighbour of each.
OWN, OWN_LEAST, OWN_SLOPE = 0, 5, 6  # 5 rows; 1; 15 rows, 3q + d
OTHER, OTHER_LEAST, OTHER_SLOPE = 21, 26, 27  # 5 rows; 1; 5 rows: 2∇q_j·r - Δ needs 2∇q_j·r
ARM, COEFFICIENT = 32, 35  # 3 rows each: r = x_j - x_i, m; c_ij, 1/m
SUM = 38  # 5 rows
ROWS = 43


@njit(**FAST)
def write_residuals(
    first: int,
    last: int,
    rows: Any,
    positions: Any,
    primitive: Any,
    gradients: Any,
    lowest: Any,
    neighbours: Any,
    coefficients: Any,
    frame: Any,
    planar: Any,
    sloped: Any,
    gamma: float,
    limiter: Any,
    residual: Any,
) -> None:
    """Write dq/dt of density, momentum and energy by the inviscid fluxes.

    Parameters
    ----------
    first, last : int
        Of `rows`; LANES of them go side by side.
    primitive : (n, 5) kg/m3, m/s, Pa
        In the laboratory's frame.
    gradients : (n, 5 or more, 3)
    lowest : (n,) Pa
    frame : None or (n, 3) m/s
        Velocities of the nodes.
    sloped : None or True
        Of None the scheme is of first order.
    limiter : Limiter
        Of slopes; which it is, is known when this is compiled.
    residual : (n, 5) kg/(m3 s), N/m3, W/m3
        Written.
    """
    work = np.zeros(ROWS * LANES)
    for begin in range(first, last, LANES):
        count = min(LANES, last - begin)
        load_nodes(rows, begin, count, primitive, gradients, lowest, frame, planar, sloped, work)
        for k in range(neighbours.shape[1]):
            if not has_pairs(rows, begin, count, k, neighbours):
                continue
            load_pairs(
                rows, begin, count, k, positions, primitive, gradients, lowest, neighbours,
                coefficients, frame, planar, sloped, work,
            )  # fmt: skip
            add_fluxes(planar, sloped, gamma, limiter, work)
        store(rows, begin, count, frame, work, residual)


@njit(**FAST_LANEWISE)
def load_nodes(  # type: ignore[no-untyped-def]
    rows, begin, count, primitive, gradients, lowest, frame, planar, sloped, work
):
    """Take the states of a block's nodes, of their own frame, and their gradients; sums from 0."""
    for lane in range(LANES):
        i = np.uintp(rows[begin + min(lane, count - 1)])
        for q in range(5):
            work[(OWN + q) * LANES + lane] = primitive[i, q]
            work[(SUM + q) * LANES + lane] = 0.0
        work[OWN_LEAST * LANES + lane] = lowest[i]
        if frame is not None:
            for d in range(3):
                work[(OWN + 1 + d) * LANES + lane] -= frame[i, d]
        if sloped is not None:
            for q in range(5):
                for d in range(3):
                    work[(OWN_SLOPE + 3 * q + d) * LANES + lane] = 2.0 * gradients[i, q, d]


@njit(**FAST_LANEWISE)
def has_pairs(rows, begin, count, k, neighbours):  # type: ignore[no-untyped-def]
    """Whether any node of a block has a k-th neighbour; rows are padded with the node itself."""
    for lane in range(count):
        i = np.uintp(rows[begin + lane])
        if np.uintp(neighbours[i, k]) != i:
            return True
    return False


@njit(**FAST_LANEWISE)
def load_pairs(  # type: ignore[no-untyped-def]
    rows, begin, count, k, positions, primitive, gradients, lowest, neighbours, coefficients,
    frame, planar, sloped, work,
):  # fmt: skip
    """Take the states of the k-th neighbours, in the nodes' frames, and their slopes."""
    for lane in range(LANES):
        i = np.uintp(rows[begin + min(lane, count - 1)])
        j = np.uintp(neighbours[i, k])
        work[OTHER * LANES + lane] = primitive[j, 0]
        work[(OTHER + 1) * LANES + lane] = primitive[j, 1]
        work[(OTHER + 3) * LANES + lane] = primitive[j, 3]
        work[(OTHER + 4) * LANES + lane] = primitive[j, 4]
        work[OTHER_LEAST * LANES + lane] = lowest[j]
        work[COEFFICIENT * LANES + lane] = coefficients[i, k, 0]
        work[(COEFFICIENT + 2) * LANES + lane] = coefficients[i, k, 2]
        if planar is None:
            work[(OTHER + 2) * LANES + lane] = primitive[j, 2]
            work[(COEFFICIENT + 1) * LANES + lane] = coefficients[i, k, 1]
        if frame is not None:
            for d in range(3):
                work[(OTHER + 1 + d) * LANES + lane] -= frame[i, d]
        if sloped is not None:
            x = 2.0 * (positions[j, 0] - positions[i, 0])
            z = 2.0 * (positions[j, 2] - positions[i, 2])
            y = 0.0 if planar is not None else 2.0 * (positions[j, 1] - positions[i, 1])
            work[ARM * LANES + lane], work[(ARM + 2) * LANES + lane] = 0.5 * x, 0.5 * z
            work[(ARM + 1) * LANES + lane] = 0.5 * y
            for q in range(5):
                if planar is None:
                    work[(OTHER_SLOPE + q) * LANES + lane] = (
                        gradients[j, q, 0] * x + gradients[j, q, 1] * y + gradients[j, q, 2] * z
                    )
                elif q != 2:
                    work[(OTHER_SLOPE + q) * LANES + lane] = (
                        gradients[j, q, 0] * x + gradients[j, q, 2] * z
                    )


@njit(**FAST_LANEWISE)
def change(work, q, lane, across, limiter, threshold, planar):  # type: ignore[no-untyped-def]
    """Changes of a variable from both nodes to the middle of their pair."""
    at = (OWN_SLOPE + 3 * q) * LANES + lane
    projected = work[at] * work[ARM * LANES + lane]
    projected += work[at + 2 * LANES] * work[(ARM + 2) * LANES + lane]
    if planar is None:
        projected += work[at + LANES] * work[(ARM + 1) * LANES + lane]
    other = work[(OTHER_SLOPE + q) * LANES + lane]
    return half_steps(limiter, projected, other, across, threshold)


@njit(**FAST_LANEWISE)
def five(work, row, lane):  # type: ignore[no-untyped-def]
    """Five numbers of a lane, from a row on."""
    return (
        work[row * LANES + lane], work[(row + 1) * LANES + lane], work[(row + 2) * LANES + lane],
        work[(row + 3) * LANES + lane], work[(row + 4) * LANES + lane],
    )  # fmt: skip


@njit(**FAST_LANEWISE)
def add_fluxes(planar, sloped, gamma, limiter, work):  # type: ignore[no-untyped-def]
    """Add what the k-th neighbours give to their nodes."""
    for lane in range(LANES):
        r, u = work[OWN * LANES + lane], work[(OWN + 1) * LANES + lane]
        w, p = work[(OWN + 3) * LANES + lane], work[(OWN + 4) * LANES + lane]
        rr, ur = work[OTHER * LANES + lane], work[(OTHER + 1) * LANES + lane]
        wr, pr = work[(OTHER + 3) * LANES + lane], work[(OTHER + 4) * LANES + lane]
        cx = work[COEFFICIENT * LANES + lane]
        cz = work[(COEFFICIENT + 2) * LANES + lane]
        v = vr = cy = 0.0
        if planar is None:
            v, vr = work[(OWN + 2) * LANES + lane], work[(OTHER + 2) * LANES + lane]
            cy = work[(COEFFICIENT + 1) * LANES + lane]
        lowest_i, lowest_j = work[OWN_LEAST * LANES + lane], work[OTHER_LEAST * LANES + lane]
        state_i, state_j = (r, u, v, w, p), (rr, ur, vr, wr, pr)
        direction = pair_direction(cx, cy, cz)
        left, right = state_i, state_j
        if sloped is not None:
            keep = kept_share(state_i, state_j, direction, lowest_i, lowest_j)
            eps_r, eps_p, eps_v = thresholds(state_i, state_j, limiter)
            density = change(work, 0, lane, rr - r, limiter, eps_r, planar)
            pressure = change(work, 4, lane, pr - p, limiter, eps_p, planar)
            keep = positive_share(keep, state_i, state_j, density, pressure)
            rl, rr = sides(r, rr, keep, density)
            pl, pr = sides(p, pr, keep, pressure)
            along_x = change(work, 1, lane, ur - u, limiter, eps_v, planar)
            ul, ur = sides(u, ur, keep, along_x)
            along_z = change(work, 3, lane, wr - w, limiter, eps_v, planar)
            wl, wr = sides(w, wr, keep, along_z)
            vl = v
            if planar is None:
                along_y = change(work, 2, lane, vr - v, limiter, eps_v, planar)
                vl, vr = sides(v, vr, keep, along_y)
            left, right = (rl, ul, vl, wl, pl), (rr, ur, vr, wr, pr)
        rates = pair_rates(state_i, left, right, direction, min(lowest_i, lowest_j), gamma)
        work[SUM * LANES + lane] += rates[0]
        work[(SUM + 1) * LANES + lane] += rates[1]
        work[(SUM + 3) * LANES + lane] += rates[3]
        work[(SUM + 4) * LANES + lane] += rates[4]
        if planar is None:
            work[(SUM + 2) * LANES + lane] += rates[2]


@njit(**FAST_LANEWISE)
def store(rows, begin, count, frame, work, residual):  # type: ignore[no-untyped-def]
    """Write the sums of a block's nodes, in the laboratory's frame."""
    for lane in range(count):
        i = np.uintp(rows[begin + lane])
        rates = five(work, SUM, lane)
        if frame is not None:
            rates = in_laboratory(rates, frame[i, 0], frame[i, 1], frame[i, 2])
        residual[i, 0], residual[i, 1], residual[i, 2] = rates[0], rates[1], rates[2]
        residual[i, 3], residual[i, 4] = rates[3], rates[4]
