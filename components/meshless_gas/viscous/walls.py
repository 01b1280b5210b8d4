"""What a no-slip wall does to the gas, and the gas to the wall."""

from numba import njit

from quintet.components.meshless_gas.viscous.laws import sutherland, wall_slope
from quintet.components.shared.numba_options import EXACT



@njit(**EXACT)
def hold_walls(first, last, rows, neighbours, weights, velocity, temperature, law, primitive):  # type: ignore[no-untyped-def]
    """Give nodes of no-slip walls the wall's velocity and temperature, the gas's pressure.

    Parameters
    ----------
    first, last : int
        Walls that are written.
    rows : (w,)
        Their nodes.
    neighbours : (w, K)
        Nodes of the gas near each; weights 0 where there are fewer.
    weights : (w, K)
        With sum 1: of no slope along the normal.
    velocity : (w, 3) m/s
    temperature : (w,) K
        Negative where the wall is adiabatic.
    law : Transport
    primitive : (n, 5)
        The rows are written.
    """
    for n in range(first, last):
        pressure, warmth = 0.0, 0.0
        for k in range(neighbours.shape[1]):
            j, share = neighbours[n, k], weights[n, k]
            pressure += share * primitive[j, 4]
            warmth += share * primitive[j, 4] / (primitive[j, 0] * law.gas_constant)
        if temperature[n] > 0.0:
            warmth = temperature[n]
        i = rows[n]
        primitive[i, 0] = pressure / (law.gas_constant * warmth)
        primitive[i, 1], primitive[i, 2], primitive[i, 3] = velocity[n]
        primitive[i, 4] = pressure


@njit(**EXACT)
def write_tractions(  # type: ignore[no-untyped-def]
    first, last, rows, off_wall, positions, normals, velocity, primitive, law, friction, heat
):
    """Friction (w, 3) Pa and heat flux (w,) W/m2 into walls, of second order.

    Parabolas through the wall and two nodes above it: the least-squares slope of the wall's node
    falls 8 to 15 % short where the layer of temperature is eight spacings thick.
    """
    for n in range(first, last):
        i, j, k = rows[n], off_wall[n, 0], off_wall[n, 1]
        near, far, along = 0.0, 0.0, 0.0
        for axis in range(3):
            near += (positions[j, axis] - positions[i, axis]) * normals[n, axis]
            far += (positions[k, axis] - positions[i, axis]) * normals[n, axis]
        wall = primitive[i, 4] / (primitive[i, 0] * law.gas_constant)
        mu = sutherland(wall, law)
        one = primitive[j, 4] / (primitive[j, 0] * law.gas_constant)
        two = primitive[k, 4] / (primitive[k, 0] * law.gas_constant)
        heat[n] = law.conduction * mu * wall_slope(wall, one, two, near, far)
        for axis in range(3):
            slope = wall_slope(
                velocity[n, axis], primitive[j, 1 + axis], primitive[k, 1 + axis], near, far
            )
            friction[n, axis] = mu * slope
            along += friction[n, axis] * normals[n, axis]
        for axis in range(3):
            friction[n, axis] -= along * normals[n, axis]
