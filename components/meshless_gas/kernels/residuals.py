"""Rates of change by the fluxes between nodes: pairs of LANES nodes side by side.

    dq_i/dt = -2 Σ_j |c_ij| (F(q_L, q_R; n_ij) - F(q_i; n_ij)),   n_ij = c_ij/|c_ij|

The 2 is there because the flux is that in the middle of a pair.
"""

import math
from typing import Any

import numpy as np
from numba import njit

from quintet.components.meshless_gas.laws.fluxes import (
    FAST_LANEWISE,
    LEAST,
    ausmpw,
    smoothness,
)
from quintet.components.meshless_gas.laws.limiters import half_step
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
        Of slopes; its class is known when this is compiled.
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
    return (
        half_step(limiter, projected - across, across, threshold),
        half_step(limiter, other - across, across, threshold),
    )


@njit(**FAST_LANEWISE)
def add_fluxes(planar, sloped, gamma, limiter, work):  # type: ignore[no-untyped-def]
    """Add what the k-th neighbours give to their nodes."""
    heat = gamma / (gamma - 1.0)
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
        size = math.sqrt(cx * cx + cy * cy + cz * cz)
        per = 1.0 / max(size, 1e-300)
        x, y, z = cx * per, cy * per, cz * per
        rl, ul, vl, wl, pl = r, u, v, w, p
        lowest_i, lowest_j = work[OWN_LEAST * LANES + lane], work[OTHER_LEAST * LANES + lane]
        if sloped is not None:
            closing = max((u - ur) * x + (v - vr) * y + (w - wr) * z, 0.0)
            ram = min(r, rr) * closing * closing
            keep = smoothness(lowest_i, lowest_j, p, pr, ram)
            mean_r, mean_p, threshold = r + rr, p + pr, limiter.threshold
            eps_r = threshold * mean_r * mean_r
            eps_p = threshold * mean_p * mean_p
            a, b = change(work, 0, lane, rr - r, limiter, eps_r, planar)
            c, d = change(work, 4, lane, pr - p, limiter, eps_p, planar)
            least_r, least_p = LEAST * min(r, rr), LEAST * min(p, pr)
            sound = (
                (r + keep * a > least_r)
                & (rr - keep * b > least_r)
                & (p + keep * c > least_p)
                & (pr - keep * d > least_p)
            )
            keep = keep if sound else 0.0
            rl, rr = r + keep * a, rr - keep * b
            pl, pr = p + keep * c, pr - keep * d
            eps_v = threshold * mean_p / mean_r
            a, b = change(work, 1, lane, ur - u, limiter, eps_v, planar)
            ul, ur = u + keep * a, ur - keep * b
            a, b = change(work, 3, lane, wr - w, limiter, eps_v, planar)
            wl, wr = w + keep * a, wr - keep * b
            if planar is None:
                a, b = change(work, 2, lane, vr - v, limiter, eps_v, planar)
                vl, vr = v + keep * a, vr - keep * b
        normal_l, normal_r = ul * x + vl * y + wl * z, ur * x + vr * y + wr * z
        lowest = min(lowest_i, lowest_j)
        left, right, pressure = ausmpw(rl, normal_l, pl, rr, normal_r, pr, lowest, gamma)
        mass = r * (u * x + v * y + w * z)
        push, factor = pressure - p, -2.0 * size
        enthalpy = heat * p / r + 0.5 * (u * u + v * v + w * w)
        enthalpy_l = heat * pl / rl + 0.5 * (ul * ul + vl * vl + wl * wl)
        enthalpy_r = heat * pr / rr + 0.5 * (ur * ur + vr * vr + wr * wr)
        work[SUM * LANES + lane] += factor * (left + right - mass)
        work[(SUM + 1) * LANES + lane] += factor * (left * ul + right * ur - mass * u + push * x)
        work[(SUM + 3) * LANES + lane] += factor * (left * wl + right * wr - mass * w + push * z)
        work[(SUM + 4) * LANES + lane] += factor * (
            left * enthalpy_l + right * enthalpy_r - mass * enthalpy
        )
        if planar is None:
            work[(SUM + 2) * LANES + lane] += factor * (
                left * vl + right * vr - mass * v + push * y
            )


@njit(**FAST_LANEWISE)
def store(rows, begin, count, frame, work, residual):  # type: ignore[no-untyped-def]
    """Write the sums of a block's nodes, in the laboratory's frame."""
    for lane in range(count):
        i = np.uintp(rows[begin + lane])
        r0, r1 = work[SUM * LANES + lane], work[(SUM + 1) * LANES + lane]
        r2, r3 = work[(SUM + 2) * LANES + lane], work[(SUM + 3) * LANES + lane]
        r4 = work[(SUM + 4) * LANES + lane]
        if frame is not None:
            x, y, z = frame[i, 0], frame[i, 1], frame[i, 2]
            r4 += x * r1 + y * r2 + z * r3 + 0.5 * (x * x + y * y + z * z) * r0
            r1, r2, r3 = r1 + x * r0, r2 + y * r0, r3 + z * r0
        residual[i, 0], residual[i, 1], residual[i, 2] = r0, r1, r2
        residual[i, 3], residual[i, 4] = r3, r4
