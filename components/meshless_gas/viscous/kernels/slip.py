"""Velocity and temperature of a rarefied gas at walls; see `slip_laws`."""

from numba import njit

from quintet.components.meshless_gas.kernels.outflows import five
from quintet.components.meshless_gas.viscous.kernels.slip_laws import (
    slip_traction,
    spread,
    temperature_at_wall,
    velocity_at_wall,
)
from quintet.components.meshless_gas.viscous.laws import gas_temperature, slope_shares
from quintet.components.shared.numba_options import EXACT, INNER


@njit(**INNER)
def shares_of(i, above, n, positions, normals):  # type: ignore[no-untyped-def]
    """Shares (3,) 1/m of wall node i and the nodes above it in slopes along its normal."""
    near, far = 0.0, 0.0
    for axis in range(3):
        near += (positions[above[n, 0], axis] - positions[i, axis]) * normals[i, axis]
        far += (positions[above[n, 1], axis] - positions[i, axis]) * normals[i, axis]
    return slope_shares(near, far)


@njit(**INNER)
def three(row):  # type: ignore[no-untyped-def]
    """Numbers of a vector."""
    return row[0], row[1], row[2]


@njit(**EXACT)
def write_jumps(  # type: ignore[no-untyped-def]
    rows, above, positions, normals, velocity, temperature, lengths, curvature, law, primitive
):
    """Write the temperature of the gas at walls, by way of its density; its pressure is kept.

    Parameters
    ----------
    temperature : (w,) K
        Of the walls; negative where they are adiabatic.
    lengths : (w, 2) 1
        Of slip and of jump, over the mean free path.
    curvature : float, 1/m
    primitive : (n, 5)
        The densities of the rows are written.
    """
    for n in range(rows.shape[0]):
        i = rows[n]
        warmth = temperature_at_wall(
            primitive[i, 4], five(primitive[above[n, 0]]), five(primitive[above[n, 1]]),
            shares_of(i, above, n, positions, normals), three(velocity[n]), three(normals[i]),
            temperature[n], (lengths[n, 0], lengths[n, 1]), curvature, law,
        )  # fmt: skip
        primitive[i, 0] = primitive[i, 4] / (law.gas_constant * warmth)


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
        i = rows[n]
        temperature = gas_temperature(primitive[i, 0], primitive[i, 4], law.gas_constant)
        x, y, z = 0.0, 0.0, 0.0
        for m in range(neighbours.shape[1]):
            other = neighbours[i, m]
            if other >= nodes:  # images get their states after walls; a temperature has no sides
                other = owner[other - nodes]
            rise = gas_temperature(primitive[other, 0], primitive[other, 4], law.gas_constant)
            rise -= temperature
            x += coefficients[i, m, 0] * rise
            y += coefficients[i, m, 1] * rise
            z += coefficients[i, m, 2] * rise
        u, v, w = velocity_at_wall(
            five(primitive[i]), five(primitive[above[n, 0]]), five(primitive[above[n, 1]]),
            shares_of(i, above, n, positions, normals), three(velocity[n]), three(normals[i]),
            (x, y, z), lengths[n, 0], curvature, law,
        )  # fmt: skip
        primitive[i, 1], primitive[i, 2], primitive[i, 3] = u, v, w


@njit(**EXACT)
def write_slip_tractions(  # type: ignore[no-untyped-def]
    rows, above, positions, normals, neighbours, coefficients, velocity, curvature, law, primitive,
    friction, heat,
):  # fmt: skip
    """Write viscous stress (w, 3) Pa on walls, heat flux (w,) W/m2 into them; as `write_jumps`."""
    for n in range(rows.shape[0]):
        i = rows[n]
        normal, spreading = three(normals[i]), 0.0
        for m in range(neighbours.shape[1]):
            other = neighbours[i, m]
            rise = (
                primitive[other, 1] - primitive[i, 1],
                primitive[other, 2] - primitive[i, 2],
                primitive[other, 3] - primitive[i, 3],
            )
            spreading += spread(three(coefficients[i, m]), rise, normal)
        x, y, z, flux = slip_traction(
            five(primitive[i]), five(primitive[above[n, 0]]), five(primitive[above[n, 1]]),
            shares_of(i, above, n, positions, normals), three(velocity[n]), normal, spreading,
            curvature, law,
        )  # fmt: skip
        friction[n, 0], friction[n, 1], friction[n, 2], heat[n] = x, y, z, flux
