"""Velocity slip and temperature jump of a rarefied gas at walls, from the gradients there.

    u - u_w = (2 - σ)/σ λ (∂u_t/∂n - κ (u - u_w)) + 3/4 μ/(ρT) ∇_t T
    T - T_w = (2 - α)/α 2γ/(γ + 1)/Pr λ ∂T/∂n

κ is the curvature of the wall; with its term a gas in rigid rotation with the wall has no shear.
Slopes are those of parabolas through the wall and two nodes above it. The unknown at the wall is
one of the three values, so the formulas are implicit and stable for any mean free path.
`shares` (3,) 1/m are those of `slope_shares`; `state`, `first` and `second` (5,) kg/m3, m/s, Pa
are on the wall and at the two nodes above it.
"""

import math

from numba import njit

from quintet.components.meshless_gas.laws.transport import sutherland
from quintet.components.meshless_gas.viscous.laws import gas_temperature, mean_free_path
from quintet.components.shared.numba_options import INNER

ROUNDS, LEFT = 50, 1e-13  # of the iteration for a temperature, and what may be left of it
CREEP = 0.75


@njit(**INNER)
def extrapolated_slip(shares, first, second, velocity, normal):  # type: ignore[no-untyped-def]
    """The share (3,) 1/s of ∂u_t/∂n that does not depend on the slip, and its square.

    Velocities are those against the wall, of a `velocity` (3,) m/s, along it.
    """
    x = shares[1] * (first[1] - velocity[0]) + shares[2] * (second[1] - velocity[0])
    y = shares[1] * (first[2] - velocity[1]) + shares[2] * (second[2] - velocity[1])
    z = shares[1] * (first[3] - velocity[2]) + shares[2] * (second[3] - velocity[2])
    through = x * normal[0] + y * normal[1] + z * normal[2]
    x -= through * normal[0]
    y -= through * normal[1]
    z -= through * normal[2]
    return x, y, z, x * x + y * y + z * z


@njit(**INNER)
def temperature_at_wall(  # type: ignore[no-untyped-def]
    pressure, first, second, shares, velocity, normal, temperature, lengths, curvature, law
):
    """Temperature [K] of the gas at a wall.

    Parameters
    ----------
    pressure : float, Pa
        At the wall.
    temperature : float, K
        Of the wall; negative where it is adiabatic: it then gets no heat from the gas, that of its
        sliding included.
    lengths : (2,) 1
        Of slip and of jump, over the mean free path.
    curvature : float, 1/m
    """
    near = gas_temperature(first[0], first[4], law.gas_constant)
    far = gas_temperature(second[0], second[4], law.gas_constant)
    rest = shares[1] * near + shares[2] * far
    square = extrapolated_slip(shares, first, second, velocity, normal)[3]
    warmth = temperature if temperature > 0.0 else near
    for _ in range(ROUNDS):
        mean = mean_free_path(sutherland(warmth, law), pressure, warmth, law.gas_constant)
        if temperature > 0.0:
            length = lengths[1] * mean
            new = (temperature + length * rest) / (1.0 - length * shares[0])
        else:  # λ ∂T/∂n + τ u = 0, with u = L ∂u/∂n
            length = lengths[0] * mean
            slope = math.sqrt(square) / (1.0 - length * (shares[0] - curvature))
            new = (-slope * slope * length / law.conduction - rest) / shares[0]
        if not new > 0.0:  # of a parabola that a starting flow has bent too far
            new = near
        change = abs(new - warmth)
        warmth = new
        if change <= LEFT * warmth:
            break
    return warmth


@njit(**INNER)
def velocity_at_wall(  # type: ignore[no-untyped-def]
    state, first, second, shares, velocity, normal, rise, length, curvature, law
):
    """Velocity (3,) m/s of the gas at a wall, where its temperature is known.

    Parameters
    ----------
    rise : (3,) K/m
        Gradient of the temperature.
    length : float, 1
        Of slip, over the mean free path.
    """
    temperature = gas_temperature(state[0], state[4], law.gas_constant)
    through = rise[0] * normal[0] + rise[1] * normal[1] + rise[2] * normal[2]
    mu = sutherland(temperature, law)
    creep = CREEP * mu / (state[0] * temperature)
    reach = length * mean_free_path(mu, state[4], temperature, law.gas_constant)
    x, y, z, _ = extrapolated_slip(shares, first, second, velocity, normal)
    share = 1.0 - reach * (shares[0] - curvature)
    return (
        velocity[0] + (reach * x + creep * (rise[0] - through * normal[0])) / share,
        velocity[1] + (reach * y + creep * (rise[1] - through * normal[1])) / share,
        velocity[2] + (reach * z + creep * (rise[2] - through * normal[2])) / share,
    )


@njit(**INNER)
def spread(coefficient, rise, normal):  # type: ignore[no-untyped-def]
    """What a neighbour adds to the divergence [1/s] of the velocity along a wall.

    Parameters
    ----------
    coefficient : (3,) 1/m
    rise : (3,) m/s
        Of the velocity, from the wall to the neighbour.
    """
    along = coefficient[0] * rise[0] + coefficient[1] * rise[1] + coefficient[2] * rise[2]
    across = coefficient[0] * normal[0] + coefficient[1] * normal[1] + coefficient[2] * normal[2]
    lifted = rise[0] * normal[0] + rise[1] * normal[1] + rise[2] * normal[2]
    return along - across * lifted


@njit(**INNER)
def slip_traction(  # type: ignore[no-untyped-def]
    state, first, second, shares, velocity, normal, spreading, curvature, law
):
    """Viscous stress (3,) Pa on a wall and heat flux [W/m2] into it.

    The heat is that which is conducted and that of the sliding. The stress has a part along the
    normal, for gas that slips away from a place is replaced from above.

    Parameters
    ----------
    spreading : float, 1/s
        Divergence of the velocity along the wall.

    Returns
    -------
    (4,) Pa, W/m2
    """
    temperature = gas_temperature(state[0], state[4], law.gas_constant)
    near = gas_temperature(first[0], first[4], law.gas_constant)
    far = gas_temperature(second[0], second[4], law.gas_constant)
    mu = sutherland(temperature, law)
    heat = law.conduction * mu * (shares[0] * temperature + shares[1] * near + shares[2] * far)
    u, v, w = state[1] - velocity[0], state[2] - velocity[1], state[3] - velocity[2]
    x = shares[0] * u + shares[1] * (first[1] - velocity[0]) + shares[2] * (second[1] - velocity[0])
    y = shares[0] * v + shares[1] * (first[2] - velocity[1]) + shares[2] * (second[2] - velocity[1])
    z = shares[0] * w + shares[1] * (first[3] - velocity[2]) + shares[2] * (second[3] - velocity[2])
    rising = x * normal[0] + y * normal[1] + z * normal[2]
    stress = mu * (2.0 * rising - 2.0 / 3.0 * (rising + spreading))
    x = mu * (x - curvature * u) - mu * rising * normal[0]
    y = mu * (y - curvature * v) - mu * rising * normal[1]
    z = mu * (z - curvature * w) - mu * rising * normal[2]
    heat = heat + x * u + y * v + z * w
    return x + stress * normal[0], y + stress * normal[1], z + stress * normal[2], heat
