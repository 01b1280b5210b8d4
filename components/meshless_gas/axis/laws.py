"""Terms of an axis of symmetry at a node, whose circle grows with its distance from the axis."""

from numba import njit

from quintet.components.shared.numba_options import FAST_INNER, INNER


@njit(**INNER)
def axis_rates(r, u, w, p, radius, gamma):  # type: ignore[no-untyped-def]
    """Density, momentum along and across the axis and energy that spread: (ρ, ρu, ρw, E + p) w/r.

    Parameters
    ----------
    r, u, w, p : float, kg/m3, m/s, m/s, Pa
        Density, velocity along the axis and away from it, pressure.
    radius : float, m
        Never 0: nodes lie on neither side of the axis, whose image is beyond it.

    Returns
    -------
    (4,) kg/(m3 s), N/m3, N/m3, W/m3
    """
    rate = r * w / radius
    energy = rate * (gamma / (gamma - 1.0) * p / r + 0.5 * (u * u + w * w))
    return rate, rate * u, rate * w, energy


@njit(**INNER)
def swelling_stress(w, mu, radius):  # type: ignore[no-untyped-def]
    """What circles that grow add to the normal stresses: -2/3 μ w/r [Pa]."""
    return -2.0 / 3.0 * mu * w / radius


@njit(**FAST_INNER)
def axis_stresses(along, across, power, u, w, radius, mu, s, du, dw, heat):  # type: ignore[no-untyped-def]
    """What stresses about an axis have more than those of a plane.

    With s = -2/3 μ w/r: (∂s/∂x + τ_xr/r, ∂s/∂r + 2μ(∂w/∂r - w/r)/r,
    ∇·(s v) + (u τ_xr + w τ_rr + λ ∂T/∂r)/r).

    Parameters
    ----------
    along, across, power : float, N/m3, N/m3, W/m3
        ∂s/∂x, ∂s/∂r, ∇·(s v).
    u, w : float, m/s
    radius : float, m
    mu : float, Pa s
    s : float, Pa
    du, dw : (2,) 1/s
        Slopes of both velocities along x and r.
    heat : float, W/m2
        λ ∂T/∂r.

    Returns
    -------
    (3,) N/m3, N/m3, W/m3
    """
    shear = mu * (du[1] + dw[0])
    normal = mu * (2.0 * dw[1] - 2.0 / 3.0 * (du[0] + dw[1])) + s
    x = along + shear / radius
    r = across + 2.0 * mu * (dw[1] - w / radius) / radius
    return x, r, power + (u * shear + w * normal + heat) / radius
