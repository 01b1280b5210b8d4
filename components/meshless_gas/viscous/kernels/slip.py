"""What a rarefied gas has at a wall: a velocity and a temperature of its own, by its slopes there.

    u - u_w = (2 - σ)/σ λ (∂u_t/∂n - κ (u - u_w)) + 3/4 μ/(ρT) ∇_t T
    T - T_w = (2 - α)/α 2γ/(γ + 1)/Pr λ ∂T/∂n

κ is the curvature of the wall: the shear of a gas that turns with it as a whole is none.
Slopes are those of parabolas through the wall and two nodes above it, with what is sought as one
of their values: no wall is too rarefied for the step.
"""

import math

from numba import njit

from quintet.components.meshless_gas.laws.transport import sutherland
from quintet.components.meshless_gas.viscous.laws import mean_free_path, slope_shares
from quintet.components.shared.numba_options import EXACT, INNER

ROUNDS, LEFT = 50, 1e-13  # of the iteration for a temperature, and what may be left of it
CREEP = 0.75


@njit(**INNER)
def heights(i, above, n, positions, normals):  # type: ignore[no-untyped-def]
    """Heights (2,) m of the nodes above wall node i."""
    near, far = 0.0, 0.0
    for axis in range(3):
        near += (positions[above[n, 0], axis] - positions[i, axis]) * normals[i, axis]
        far += (positions[above[n, 1], axis] - positions[i, axis]) * normals[i, axis]
    return near, far


@njit(**INNER)
def extrapolated_slip(i, j, k, shares, normals, velocity, primitive, slope):  # type: ignore[no-untyped-def]
    """Write the share (3,) m/s/m of ∂u_t/∂n that does not depend on the slip; return its square.

    Velocities are those against the wall, along it.
    """
    through, square = 0.0, 0.0
    for axis in range(3):
        slope[axis] = shares[1] * (primitive[j, 1 + axis] - velocity[axis])
        slope[axis] += shares[2] * (primitive[k, 1 + axis] - velocity[axis])
        through += slope[axis] * normals[i, axis]
    for axis in range(3):
        slope[axis] -= through * normals[i, axis]
        square += slope[axis] ** 2
    return square


@njit(**EXACT)
def write_jumps(  # type: ignore[no-untyped-def]
    rows, above, positions, normals, velocity, temperature, lengths, curvature, law, primitive
):
    """Write the temperature of the gas at walls, by way of its density; its pressure is kept.

    Parameters
    ----------
    temperature : (w,) K
        Of the walls; negative where they are adiabatic: they then get no heat from the gas, that
        of its sliding included.
    lengths : (w, 2) 1
        Of slip and of jump, over the mean free path.
    curvature : float, 1/m
    primitive : (n, 5)
        The densities of the rows are written.
    """
    for n in range(rows.shape[0]):
        i, j, k = rows[n], above[n, 0], above[n, 1]
        near, far = heights(i, above, n, positions, normals)
        shares = slope_shares(near, far)
        pressure = primitive[i, 4]
        near_temperature = primitive[j, 4] / (primitive[j, 0] * law.gas_constant)
        two = primitive[k, 4] / (primitive[k, 0] * law.gas_constant)
        rest = shares[1] * near_temperature + shares[2] * two
        drawn = extrapolated_slip(
            i, j, k, shares, normals, velocity[n], primitive, primitive[i, 1:4]
        )
        temperature_i = temperature[n] if temperature[n] > 0.0 else near_temperature
        for _ in range(ROUNDS):
            mean = mean_free_path(
                sutherland(temperature_i, law), pressure, temperature_i, law.gas_constant
            )
            if temperature[n] > 0.0:
                length = lengths[n, 1] * mean
                new = (temperature[n] + length * rest) / (1.0 - length * shares[0])
            else:  # λ ∂T/∂n + τ u = 0, with u = L ∂u/∂n
                length = lengths[n, 0] * mean
                slope = math.sqrt(drawn) / (1.0 - length * (shares[0] - curvature))
                new = (-slope * slope * length / law.conduction - rest) / shares[0]
            if not new > 0.0:  # of a parabola that a starting flow has bent too far
                new = near_temperature
            change = abs(new - temperature_i)
            temperature_i = new
            if change <= LEFT * temperature_i:
                break
        primitive[i, 0] = pressure / (law.gas_constant * temperature_i)


@njit(**EXACT)
def write_slips(  # type: ignore[no-untyped-def]
    rows, above, positions, normals, neighbours, coefficients, owner, velocity, lengths, curvature,
    law, primitive,
):  # fmt: skip
    """Write the velocity of the gas at walls, whose temperatures are known; as `write_jumps`.

    Parameters
    ----------
    owner : (g,)
        Nodes whose images the last rows of `positions` are.
    """
    nodes = positions.shape[0] - owner.shape[0]
    for n in range(rows.shape[0]):
        i, j, k = rows[n], above[n, 0], above[n, 1]
        temperature_i = primitive[i, 4] / (primitive[i, 0] * law.gas_constant)
        x, y, z = 0.0, 0.0, 0.0
        for m in range(neighbours.shape[1]):
            other = neighbours[i, m]
            if other >= nodes:  # images get their states after walls; a temperature has no sides
                other = owner[other - nodes]
            rise = primitive[other, 4] / (primitive[other, 0] * law.gas_constant) - temperature_i
            x += coefficients[i, m, 0] * rise
            y += coefficients[i, m, 1] * rise
            z += coefficients[i, m, 2] * rise
        through = x * normals[i, 0] + y * normals[i, 1] + z * normals[i, 2]
        mu = sutherland(temperature_i, law)
        creep = CREEP * mu / (primitive[i, 0] * temperature_i)
        near, far = heights(i, above, n, positions, normals)
        shares = slope_shares(near, far)
        length = lengths[n, 0] * mean_free_path(
            mu, primitive[i, 4], temperature_i, law.gas_constant
        )
        drawn = primitive[i, 1:4]
        extrapolated_slip(i, j, k, shares, normals, velocity[n], primitive, drawn)
        for axis in range(3):
            slope = (x, y, z)[axis] - through * normals[i, axis]
            slip = length * drawn[axis] + creep * slope
            slip /= 1.0 - length * (shares[0] - curvature)
            drawn[axis] = velocity[n, axis] + slip


@njit(**EXACT)
def write_slip_tractions(  # type: ignore[no-untyped-def]
    rows, above, positions, normals, neighbours, coefficients, velocity, curvature, law, primitive,
    friction, heat,
):  # fmt: skip
    """Write viscous stress (w, 3) Pa on walls and heat flux (w,) W/m2 into them; as `write_jumps`.

    The heat is that which is conducted and that of the sliding. The stress has a part along the
    normal, for gas that slips away from a place is replaced from above.
    """
    for n in range(rows.shape[0]):
        i, j, k = rows[n], above[n, 0], above[n, 1]
        near, far = heights(i, above, n, positions, normals)
        shares = slope_shares(near, far)
        temperature_i = primitive[i, 4] / (primitive[i, 0] * law.gas_constant)
        near_temperature = primitive[j, 4] / (primitive[j, 0] * law.gas_constant)
        two = primitive[k, 4] / (primitive[k, 0] * law.gas_constant)
        mu = sutherland(temperature_i, law)
        heat[n] = (
            law.conduction
            * mu
            * (shares[0] * temperature_i + shares[1] * near_temperature + shares[2] * two)
        )
        rising, spreading = 0.0, 0.0
        for axis in range(3):
            slip = primitive[i, 1 + axis] - velocity[n, axis]
            slope = shares[0] * slip
            slope += shares[1] * (primitive[j, 1 + axis] - velocity[n, axis])
            slope += shares[2] * (primitive[k, 1 + axis] - velocity[n, axis])
            friction[n, axis] = mu * (slope - curvature * slip)
            rising += slope * normals[i, axis]
        for m in range(neighbours.shape[1]):
            other = neighbours[i, m]
            along, across, lifted = 0.0, 0.0, 0.0
            for axis in range(3):
                rise = primitive[other, 1 + axis] - primitive[i, 1 + axis]
                along += coefficients[i, m, axis] * rise
                across += coefficients[i, m, axis] * normals[i, axis]
                lifted += rise * normals[i, axis]
            spreading += along - across * lifted
        normal = mu * (2.0 * rising - 2.0 / 3.0 * (rising + spreading))
        for axis in range(3):
            slip = primitive[i, 1 + axis] - velocity[n, axis]
            friction[n, axis] -= mu * rising * normals[i, axis]
            heat[n] += friction[n, axis] * slip
            friction[n, axis] += normal * normals[i, axis]
