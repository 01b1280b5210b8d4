"""Exact solution of the Riemann problem of a perfect gas. Toro (2009), chapter 4; his equations."""

import math
from typing import NamedTuple

import numpy as np

from quintet.interfaces.component import Array

CLOSE = 1e-14  # relative change of the pressure at which it has been found
VACUUM = 1e-300  # Pa


class Side(NamedTuple):
    """A state along x."""

    density: float  # kg/m3
    velocity: float  # m/s
    pressure: float  # Pa


def change(p: float, side: Side, gamma: float) -> float:
    """Velocity [m/s] that a shock or a rarefaction to the pressure p makes; equations 4.6, 4.7."""
    sound = math.sqrt(gamma * side.pressure / side.density)
    if p > side.pressure:
        a = 2.0 / ((gamma + 1.0) * side.density)
        b = (gamma - 1.0) / (gamma + 1.0) * side.pressure
        return (p - side.pressure) * math.sqrt(a / (p + b))
    power = (gamma - 1.0) / (2.0 * gamma)
    return 2.0 * sound / (gamma - 1.0) * ((p / side.pressure) ** power - 1.0)


def star(left: Side, right: Side, gamma: float) -> tuple[float, float]:
    """Pressure [Pa] and velocity [m/s] between the waves; by bisection of equation 4.5.

    Where gas is torn apart the pressure is 0.
    """

    def gap(p: float) -> float:
        return change(p, left, gamma) + change(p, right, gamma) + right.velocity - left.velocity

    low, high = VACUUM, max(left.pressure, right.pressure)
    while gap(high) < 0.0:
        high *= 2.0
    if gap(low) < 0.0:
        while high > low * (1.0 + CLOSE):
            middle = math.sqrt(low) * math.sqrt(high) if high > 2.0 * low else 0.5 * (low + high)
            if not low < middle < high:
                break
            low, high = (middle, high) if gap(middle) < 0.0 else (low, middle)
    velocity = 0.5 * (left.velocity + right.velocity)
    return low, velocity + 0.5 * (change(low, right, gamma) - change(low, left, gamma))


def solution(left: Side, right: Side, gamma: float, speeds: Array) -> Array:
    """States (n, 3) kg/m3, m/s, Pa at x/t (n,) m/s; section 4.5."""
    pressure, velocity = star(left, right, gamma)
    states = np.empty((len(speeds), 3))
    on_left = speeds < velocity
    for side, sign, mine in ((left, 1.0, on_left), (right, -1.0, ~on_left)):
        mirrored = Side(side.density, sign * side.velocity, side.pressure)
        part = one_side(mirrored, pressure, sign * velocity, gamma, sign * speeds[mine])
        part[:, 1] *= sign
        states[mine] = part
    return states


def one_side(side: Side, pressure: float, velocity: float, gamma: float, speeds: Array) -> Array:
    """States left of the contact."""
    density, u, p = side
    sound, ratio = math.sqrt(gamma * p / density), pressure / p
    states = np.tile([density, u, p], (len(speeds), 1))
    g = (gamma - 1.0) / (gamma + 1.0)
    if pressure > p:  # equations 4.50 and 4.52
        mach = math.sqrt(((gamma + 1.0) * ratio + gamma - 1.0) / (2.0 * gamma))
        front = u - sound * mach
        behind = density * (ratio + g) / (g * ratio + 1.0)
        states[speeds > front] = behind, velocity, pressure
        return states
    head, tail = u - sound, velocity - sound * ratio ** ((gamma - 1.0) / (2.0 * gamma))
    states[speeds > tail] = density * ratio ** (1.0 / gamma), velocity, pressure
    fan = (speeds >= head) & (speeds <= tail)
    along = np.maximum(2.0 / (gamma + 1.0) + g / sound * (u - speeds[fan]), 0.0)  # equation 4.56
    states[fan, 0] = density * along ** (2.0 / (gamma - 1.0))
    states[fan, 1] = 2.0 / (gamma + 1.0) * (sound + 0.5 * (gamma - 1.0) * u + speeds[fan])
    states[fan, 2] = p * along ** (2.0 * gamma / (gamma - 1.0))
    return states
