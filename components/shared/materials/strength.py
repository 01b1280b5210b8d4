"""Shear strength: Jaumann's rate, and the return to the flow stress of Johnson and Cook.

Stress deviators are six numbers, xx yy zz xy yz zx.

Papers: Johnson & Cook, Proc. 7th Int. Symp. Ballistics (1983) 541; Wilkins, Methods in
Computational Physics 3 (1964) 211 (radial return).
"""

import math

from numba import njit

from quintet.components.shared.elementary import exponential, logarithm
from quintet.components.shared.numba_options import FAST_LANEWISE, INNER

CLOSE = 1e-8  # of the flow stress: how far the returned stress may be from it
MOST = 80  # iterations
LEAST = 1e-300  # plastic strain by which none is divided


@njit(**FAST_LANEWISE)
def turned_and_strained(s, gradient, shear, dt):  # type: ignore[no-untyped-def]
    """Deviator after an elastic step, s + dt (2G dev D + W s - s W).

    Parameters
    ----------
    s : six floats, Pa
    gradient : nine floats, 1/s
        Of velocity, L_ab = ∂v_a/∂x_b, by rows.
    shear : float, Pa
    dt : float, s
    """
    xx, yy, zz, xy, yz, zx = s
    l00, l01, l02, l10, l11, l12, l20, l21, l22 = gradient
    mean = (l00 + l11 + l22) / 3.0
    wxy, wyz, wzx = 0.5 * (l01 - l10), 0.5 * (l12 - l21), 0.5 * (l20 - l02)
    g, h = 2.0 * shear * dt, shear * dt
    return (
        xx + g * (l00 - mean) + 2.0 * dt * (wxy * xy - wzx * zx),
        yy + g * (l11 - mean) + 2.0 * dt * (wyz * yz - wxy * xy),
        zz + g * (l22 - mean) + 2.0 * dt * (wzx * zx - wyz * yz),
        xy + h * (l01 + l10) + dt * (wxy * (yy - xx) + wyz * zx - wzx * yz),
        yz + h * (l12 + l21) + dt * (wyz * (zz - yy) + wzx * xy - wxy * zx),
        zx + h * (l20 + l02) + dt * (wzx * (xx - zz) + wxy * yz - wyz * xy),
    )


@njit(**FAST_LANEWISE)
def equivalent(s):  # type: ignore[no-untyped-def]
    """Von Mises' equivalent stress √(3/2 s:s) [Pa] of a deviator."""
    xx, yy, zz, xy, yz, zx = s
    return math.sqrt(1.5 * (xx * xx + yy * yy + zz * zz) + 3.0 * (xy * xy + yz * yz + zx * zx))


@njit(**FAST_LANEWISE)
def softening(temperature, law):  # type: ignore[no-untyped-def]
    """1 - T*ᵐ, between 0 at melting and 1."""
    above = min(max((temperature - law.reference_temperature) / law.melting, 0.0), 1.0)
    return 1.0 - (above if law.m == 1.0 else exponential(law.m * logarithm(above)))


@njit(**FAST_LANEWISE)
def flow_stress(strain, rate, soft, law):  # type: ignore[no-untyped-def]
    """Y [Pa] at a plastic strain and its rate [1/s], and dY/dε_p at that rate, dY/d(rate)."""
    grows = law.b * (strain if law.n == 1.0 else exponential(law.n * logarithm(strain)))
    grows = grows if strain > 0.0 else 0.0
    static, slope = (law.hard + grows) * soft, law.n * soft * grows / max(strain, LEAST)
    over = max(rate / law.reference_rate, 1.0)
    faster = 1.0 + law.c * logarithm(over)
    hastens = static * law.c / rate if over > 1.0 else 0.0
    return static * faster, slope * faster, hastens


@njit(**INNER)
def plastic_increment(trial, strain, soft, dt, law):  # type: ignore[no-untyped-def]
    """Plastic strain of a step, from the equivalent trial stress [Pa]: se - 3GΔ = Y(ε + Δ, Δ/dt).

    Newton's method within a bracket; Δ is 0 where the trial stress is no more than the flow stress.
    """
    if not trial > law.hard * soft:
        return 0.0
    still, hardens, _ = flow_stress(strain, 0.0, soft, law)
    if trial <= still:
        return 0.0
    stiff = 3.0 * law.shear
    low, high = 0.0, trial / stiff
    # An upper bound; the next step then lands on the lower side, from where it is monotone.
    delta = (trial - still) / (stiff + (hardens if law.c == 0.0 and law.n == 1.0 else 0.0))
    for _ in range(MOST):
        stress, hardens, hastens = flow_stress(strain + delta, delta / dt, soft, law)
        gap = trial - stiff * delta - stress
        if abs(gap) <= CLOSE * trial:
            break
        if gap > 0.0:
            low = delta
        else:
            high = delta
        delta += gap / (stiff + hardens + hastens / dt)
        if not low < delta < high:
            delta = 0.5 * (low + high)
    return delta


@njit(**INNER)
def returned(s, strain, temperature, dt, law):  # type: ignore[no-untyped-def]
    """Deviator on the yield surface, plastic strain of the step, and its work [J/m3]."""
    trial = equivalent(s)
    soft = softening(temperature, law)
    delta = plastic_increment(trial, strain, soft, dt, law)
    if delta == 0.0:
        return s, 0.0, 0.0
    scale = 1.0 - 3.0 * law.shear * delta / trial
    xx, yy, zz, xy, yz, zx = s
    s = xx * scale, yy * scale, zz * scale, xy * scale, yz * scale, zx * scale
    return s, delta, scale * trial * delta
