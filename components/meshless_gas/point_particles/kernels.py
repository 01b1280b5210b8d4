"""Loops over particles: weights of nearby nodes, loads, and what the nodes lose."""

import math
from typing import Any

from numba import njit
from numpy.typing import NDArray

from quintet.components.meshless_gas.point_particles.laws import drag_factor, nusselt
from quintet.components.meshless_gas.transport import Transport, sutherland
from quintet.components.shared.numba_options import EXACT
from quintet.components.shared.search.cells import Whole
from quintet.interfaces.component import Array

OUTSIDE = 2.0  # spacings from the nearest node, beyond which a particle has left the gas


@njit(**EXACT)
def write_weights(
    squares: Array, near: Whole, volumes: Array, spacing: Array, weights: Array
) -> None:
    """Write the weights of nodes near each particle: w ∝ V (1 - q)⁴ (1 + 4q), q = r/r_last.

    As the last node has no weight, weights change continuously when another takes its place.

    Parameters
    ----------
    squares : (p, k) float array, m2
        Of the distances from particles to their nearest nodes, ascending.
    near : (p, k) int array
    volumes, spacing : (n,) float array, m3 and m
        Of nodes; of ghosts those of their owners.
    weights : (p, k) float array
        Written; their sum is 1, or they are 0 if the particle is outside.

    References
    ----------
    Wendland, Adv. Comput. Math. 4 (1995) 389 (C2).
    """
    last = near.shape[1] - 1
    for i in range(near.shape[0]):
        reach = math.sqrt(squares[i, last])
        summed = 0.0
        for k in range(near.shape[1]):
            q = math.sqrt(squares[i, k]) / reach
            weights[i, k] = volumes[near[i, k]] * (1.0 - q) ** 4 * (1.0 + 4.0 * q)
            summed += weights[i, k]
        nearest = OUTSIDE * spacing[near[i, 0]]
        scale = 1.0 / summed if squares[i, 0] < nearest * nearest else 0.0
        for k in range(near.shape[1]):
            weights[i, k] *= scale


@njit(**EXACT)
def exchange(
    drag: int, heating: int, transport: Transport, gamma: float, prandtl: float, share: float,
    velocity: Array, temperature: Array, diameter: Array, number: Array, near: Whole,
    weights: Array, primitive: Array, volumes: Array, owner: NDArray[Any], turn: Array,
    force: Array, heat: Array, rates: Array, residual: Array | None,
) -> None:  # fmt: skip
    """Add up loads on particles, and take them from the nodes around them.

    Parameters
    ----------
    drag, heating : int
        Laws: of `DRAG` and `HEAT`.
    transport : Transport
    gamma, prandtl : float, 1
    share : float, 1
        Weight of this stage in the whole step.
    velocity, temperature, diameter, number : (p, 3) and (p,) float array, m/s, K, m, 1
        Of particles, and how many each stands for.
    near, weights : (p, k) int and float array
    primitive : (n, 5) float array, kg/m3, m/s, Pa
        Of nodes, ghosts among them.
    volumes : (n,) float array, m3
    owner, turn : (g,) int array and (g, 3, 3) float array
        Nodes that the last g rows are images of, and how these are turned.
    force, heat : (p, 3) and (p,) float array, N and W
        Added to: of all that a particle stands for.
    rates : (p, 2) float array, kg/s and W/K
        Written: force over velocity, heat over difference of temperature.
    residual : (n, 5) float array or None, kg/(m3 s), N/m3, W/m3
        Taken from, divided by volumes; None where the gas does not feel the particles.
    """
    real = primitive.shape[0] - owner.shape[0]
    for i in range(near.shape[0]):
        density = u = v = w = pressure = inside = 0.0
        for k in range(near.shape[1]):
            j, part = near[i, k], weights[i, k]
            inside += part
            density += part * primitive[j, 0]
            u += part * primitive[j, 1]
            v += part * primitive[j, 2]
            w += part * primitive[j, 3]
            pressure += part * primitive[j, 4]
        rates[i, 0] = rates[i, 1] = 0.0
        if inside == 0.0:
            continue
        d, warm = diameter[i], pressure / (density * transport.gas_constant)
        viscosity = sutherland(warm, transport)
        x, y, z = u - velocity[i, 0], v - velocity[i, 1], w - velocity[i, 2]
        speed = math.sqrt(x * x + y * y + z * z)
        sound = math.sqrt(gamma * pressure / density)
        reynolds, mach = density * speed * d / viscosity, speed / sound
        rarefied = viscosity / (density * sound * d)  # M/Re
        factor = drag_factor(drag, reynolds, mach, rarefied, temperature[i] / warm, gamma)
        drags = 3.0 * math.pi * viscosity * d * factor * number[i]
        warms = nusselt(heating, reynolds, mach, rarefied, prandtl)
        warms *= math.pi * viscosity * transport.conduction * d * number[i]
        rates[i, 0], rates[i, 1] = drags, warms
        fx, fy, fz = drags * x, drags * y, drags * z
        gained = warms * (warm - temperature[i])
        force[i, 0] += share * fx
        force[i, 1] += share * fy
        force[i, 2] += share * fz
        heat[i] += share * gained
        if residual is None:
            continue
        power = fx * velocity[i, 0] + fy * velocity[i, 1] + fz * velocity[i, 2] + gained
        for k in range(near.shape[1]):
            j = near[i, k]
            ax, ay, az = fx, fy, fz
            if j >= real:  # a ghost: its owner is pushed as the ghost is, turned back
                t = turn[j - real]
                ax = t[0, 0] * fx + t[1, 0] * fy + t[2, 0] * fz
                ay = t[0, 1] * fx + t[1, 1] * fy + t[2, 1] * fz
                az = t[0, 2] * fx + t[1, 2] * fy + t[2, 2] * fz
                j = owner[j - real]
            part = weights[i, k] / volumes[j]
            residual[j, 1] -= part * ax
            residual[j, 2] -= part * ay
            residual[j, 3] -= part * az
            residual[j, 4] -= part * power


@njit(**EXACT)
def fastest(
    rates: Array, mass: Array, heat_capacity: Array, near: Whole, weights: Array,
    primitive: Array, volumes: Array, owner: NDArray[Any], summed: Array, capacity: float,
) -> float:  # fmt: skip
    """Fastest relaxation [1/s] of particles and nodes towards each other.

    Parameters
    ----------
    rates : (p, 2) float array, kg/s and W/K
    mass, heat_capacity : (p,) float array, kg and J/K
    near, weights, primitive, volumes, owner
        As `exchange` has them.
    summed : (n, 2) float array
        Memory; zero at the start and after.
    capacity : float, J/(kg K)
        Of the gas at constant volume.

    Returns
    -------
    float, 1/s
        Of particles, and of nodes with all particles around them.
    """
    real = primitive.shape[0] - owner.shape[0]
    particle = node = 0.0
    for i in range(near.shape[0]):
        particle = max(particle, rates[i, 0] / mass[i], rates[i, 1] / heat_capacity[i])
        for k in range(near.shape[1]):
            j = near[i, k]
            j = owner[j - real] if j >= real else j
            held = primitive[j, 0] * volumes[j]  # kg
            summed[j, 0] += weights[i, k] * rates[i, 0] / held
            summed[j, 1] += weights[i, k] * rates[i, 1] / (held * capacity)
            node = max(node, summed[j, 0], summed[j, 1])
    for i in range(near.shape[0]):
        for k in range(near.shape[1]):
            j = near[i, k]
            j = owner[j - real] if j >= real else j
            summed[j, 0] = summed[j, 1] = 0.0
    return particle + node
