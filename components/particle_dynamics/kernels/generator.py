"""Random numbers whose state is a single number, so that a restarted run has the same bits.

SplitMix64: Steele, Lea & Flood, OOPSLA (2014) 453.
"""

import math

import numpy as np
from numba import njit

from quintet.components.particle_dynamics.state import Generator
from quintet.components.shared.numba_options import INNER
from quintet.components.shared.wrapped_integers import (
    as_signed,
    shifted_down,
    wrapped_product,
    wrapped_sum,
)

STEP = as_signed(0x9E3779B97F4A7C15)
FIRST, SECOND = as_signed(0xBF58476D1CE4E5B9), as_signed(0x94D049BB133111EB)
LAST = 2.0**-53


@njit(**INNER)
def counter_after(counter: int, draws: int) -> int:
    """State of the generator after so many numbers were drawn."""
    return wrapped_sum(counter, wrapped_product(STEP, draws))


@njit(**INNER)
def uniform_of(counter: int) -> float:
    """Return the number above 0 and below 1 that a state of the generator stands for."""
    z = counter
    z = wrapped_product(z ^ shifted_down(z, 30), FIRST)
    z = wrapped_product(z ^ shifted_down(z, 27), SECOND)
    z = z ^ shifted_down(z, 31)
    return (float(shifted_down(z, 11)) + 0.5) * LAST


@njit(**INNER)
def normal_of(first: float, second: float) -> float:
    """Return the number of mean 0 and variance 1 of two uniform ones (Box and Muller)."""
    return math.sqrt(-2.0 * math.log(first)) * math.cos(2.0 * math.pi * second)


@njit(**INNER)
def direction_of(first: float, second: float) -> tuple[float, float, float]:
    """Return the unit vector of two uniform numbers."""
    z = 2.0 * first - 1.0
    across, angle = math.sqrt(1.0 - z * z), 2.0 * math.pi * second
    return across * math.cos(angle), across * math.sin(angle), z


@njit(**INNER)
def pass_over(state: Generator, draws: int) -> None:
    """Come to where so many numbers have been drawn."""
    state[0] = counter_after(state[0], draws)


@njit(**INNER)
def uniform(state: Generator) -> float:
    """Draw a number above 0 and below 1."""
    pass_over(state, 1)
    return uniform_of(np.int64(state[0]))


@njit(**INNER)
def normal(state: Generator) -> float:
    """Draw a number of mean 0 and variance 1."""
    first = uniform(state)
    return normal_of(first, uniform(state))


@njit(**INNER)
def direction(state: Generator) -> tuple[float, float, float]:
    """Draw a unit vector."""
    first = uniform(state)
    return direction_of(first, uniform(state))
