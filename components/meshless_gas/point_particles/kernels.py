"""Loops over particles: weights of nearby nodes, loads, and what the nodes lose."""

import math
from typing import Any

from numba import njit
from numpy.typing import NDArray

from quintet.components.meshless_gas.laws.transport import sutherland
from quintet.components.meshless_gas.point_particles.laws import drag_factor, nusselt
from quintet.components.meshless_gas.point_particles.particles import Laws, Loads, Particles
from quintet.components.shared.numba_options import EXACT, INNER
from quintet.components.shared.search.cells import Whole
from quintet.interfaces.component import Array

OUTSIDE = 2.0  # spacings from the nearest node, beyond which a particle has left the gas


@njit(**EXACT)
def write_weights(
    squares: Array, near: Whole, volumes: Array, spacing: Array, weights: Array
) -> None:
    """Write the weights of nodes near each particle: w ∝ V (1 - q)⁴ (1 + 4q), q = r/r_last.

    As the last node has no weight, weights change continuously when another takes its place. Where
    all are equally far away they share by their volumes.

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
        if summed == 0.0:  # all are as far away as the last, as round the middle of a cell
            for k in range(near.shape[1]):
                weights[i, k] = volumes[near[i, k]]
                summed += weights[i, k]
        nearest = OUTSIDE * spacing[near[i, 0]]
        scale = 1.0 / summed if squares[i, 0] < nearest * nearest else 0.0
        for k in range(near.shape[1]):
            weights[i, k] *= scale


@njit(**EXACT)
def exchange(
    laws: Laws, dt: float, old: float, new: float, share: float, particles: Particles,
    near: Whole, weights: Array, primitive: Array, volumes: Array, owner: NDArray[Any],
    turn: Array, loads: Loads, residual: Array | None,
) -> None:  # fmt: skip
    """Add up loads on particles, and take them from the nodes around them.

    Parameters
    ----------
    laws : Laws
    dt : float, s
        Of the whole step.
    old, new, share : float, 1
        Of this stage: what it takes of the step's start and of the stage before, and its weight in
        the whole step.
    particles : Particles
        At the step's start.
    near, weights : (p, k) int and float array
    primitive : (n, 5) float array, kg/m3, m/s, Pa
        Of nodes, ghosts among them.
    volumes : (n,) float array, m3
    owner, turn : (g,) int array and (g, 3, 3) float array
        Nodes that the last g rows are images of, and how these are turned.
    loads : Loads
        Added to; velocities and temperatures of this stage are changed to those of the next.
    residual : (n, 5) float array or None, kg/(m3 s), N/m3, W/m3
        Taken from, divided by volumes; None where the gas does not feel the particles.
    """
    for i in range(near.shape[0]):
        inside = density = u = v = w = pressure = 0.0
        if particles.launched[i] > 0.0:
            inside, density, u, v, w, pressure = gas_around(near[i], weights[i], primitive)
        fx = fy = fz = heat = drag = warms = 0.0
        vx, vy, vz = loads.velocity[i, 0], loads.velocity[i, 1], loads.velocity[i, 2]
        if inside > 0.0:
            warm = pressure / (density * laws.transport.gas_constant)
            sphere_temperature = loads.temperature[i]
            slip = math.sqrt((u - vx) ** 2 + (v - vy) ** 2 + (w - vz) ** 2)
            drag, warms = stiffness(
                laws, density, pressure, warm, slip, particles.diameter[i], sphere_temperature
            )
            drag, warms = drag * particles.number[i], warms * particles.number[i]
            fx, fy, fz = drag * (u - vx), drag * (v - vy), drag * (w - vz)
            heat = warms * (warm - sphere_temperature)
        power = fx * vx + fy * vy + fz * vz + heat
        loads.rates[i, 0], loads.rates[i, 1] = drag, warms
        loads.heat[i] += share * heat
        loads.power[i] += share * power
        rise = dt / particles.heat_capacity[i] * heat
        loads.temperature[i] = old * particles.temperature[i] + new * (loads.temperature[i] + rise)
        for d in range(3):
            push = fx if d == 0 else fy if d == 1 else fz
            loads.force[i, d] += share * push
            kick = dt * (push / particles.mass[i] + particles.acceleration[i, d])
            first, now = particles.velocity[i, d], loads.velocity[i, d]
            loads.velocity[i, d] = old * first + new * (now + kick)
        if residual is not None and inside > 0.0:
            react(fx, fy, fz, power, near[i], weights[i], volumes, owner, turn, residual)


@njit(**INNER)
def gas_around(
    near: Whole, weights: Array, primitive: Array
) -> tuple[float, float, float, float, float, float]:
    """Sum of the weights (k,) of nodes (k,), and the state of the gas by them."""
    inside = density = u = v = w = pressure = 0.0
    for k in range(near.shape[0]):
        j, part = near[k], weights[k]
        inside += part
        density += part * primitive[j, 0]
        u += part * primitive[j, 1]
        v += part * primitive[j, 2]
        w += part * primitive[j, 3]
        pressure += part * primitive[j, 4]
    return inside, density, u, v, w, pressure


@njit(**INNER)
def stiffness(
    laws: Laws, density: float, pressure: float, warm: float, slip: float, diameter: float,
    sphere_temperature: float,
) -> tuple[float, float]:  # fmt: skip
    """Force over velocity [kg/s], and heat over difference of temperature [W/K], of one sphere.

    Parameters
    ----------
    laws : Laws
    density, pressure, warm : float, kg/m3, Pa, K
        Of the gas.
    slip : float, m/s
        Of the sphere through it.
    diameter, sphere_temperature : float, m and K
        Of the sphere, and its temperature.
    """
    viscosity = sutherland(warm, laws.transport)
    sound = math.sqrt(laws.gamma * pressure / density)
    reynolds, mach = density * slip * diameter / viscosity, slip / sound
    rarefied = viscosity / (density * sound * diameter)  # M/Re
    factor = drag_factor(laws.drag, reynolds, mach, rarefied, sphere_temperature / warm, laws.gamma)
    number = nusselt(laws.heat, reynolds, mach, rarefied, laws.prandtl)
    conductivity = viscosity * laws.transport.conduction
    return (
        3.0 * math.pi * viscosity * diameter * factor,
        math.pi * conductivity * diameter * number,
    )


@njit(**INNER)
def react(
    fx: float, fy: float, fz: float, power: float, near: Whole, weights: Array, volumes: Array,
    owner: NDArray[Any], turn: Array, residual: Array,
) -> None:  # fmt: skip
    """Take a force [N] and a power [W] from nodes (k,) by their weights (k,)."""
    real = volumes.shape[0] - owner.shape[0]
    for k in range(near.shape[0]):
        j = near[k]
        ax, ay, az = fx, fy, fz
        if j >= real:  # an image: its owner is pushed as the image is, turned back
            t = turn[j - real]
            ax = t[0, 0] * fx + t[1, 0] * fy + t[2, 0] * fz
            ay = t[0, 1] * fx + t[1, 1] * fy + t[2, 1] * fz
            az = t[0, 2] * fx + t[1, 2] * fy + t[2, 2] * fz
            j = owner[j - real]
        part = weights[k] / volumes[j]
        residual[j, 1] -= part * ax
        residual[j, 2] -= part * ay
        residual[j, 3] -= part * az
        residual[j, 4] -= part * power


@njit(**EXACT)
def fastest(
    rates: Array, particles: Particles, near: Whole, weights: Array, primitive: Array,
    volumes: Array, owner: NDArray[Any], summed: Array, capacity: float,
) -> float:  # fmt: skip
    """Fastest relaxation [1/s] of particles and nodes towards each other.

    Parameters
    ----------
    rates : (p, 2) float array, kg/s and W/K
    particles : Particles
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
        particle = max(particle, rates[i, 0] / particles.mass[i])
        particle = max(particle, rates[i, 1] / particles.heat_capacity[i])
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
