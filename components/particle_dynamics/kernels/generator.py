"""Random numbers whose state is a single number, so that a restarted run has the same bits.

SplitMix64: Steele, Lea & Flood, OOPSLA (2014) 453.
"""

import math

import numpy as np
from numba import njit

from quintet.components.particle_dynamics.state import Generator
from quintet.components.shared.numba_options import INNER

STEP = np.uint64(0x9E3779B97F4A7C15)
FIRST, SECOND = np.uint64(0xBF58476D1CE4E5B9), np.uint64(0x94D049BB133111EB)
A, B, C, D = np.uint64(30), np.uint64(27), np.uint64(31), np.uint64(11)


@njit(**INNER)
def uniform(state: Generator) -> float:
    """Draw a number above 0 and below 1."""
    state[0] += STEP
    z = state[0]
    z = (z ^ (z >> A)) * FIRST
    z = (z ^ (z >> B)) * SECOND
    z = z ^ (z >> C)
    return (float(z >> D) + 0.5) * 2.0**-53


@njit(**INNER)
def pass_over(state: Generator, draws: int) -> None:
    """Come to where so many numbers have been drawn."""
    state[0] += STEP * np.uint64(draws)


@njit(**INNER)
def normal(state: Generator) -> float:
    """Draw a number of mean 0 and variance 1 (Box and Muller)."""
    length = math.sqrt(-2.0 * math.log(uniform(state)))
    return length * math.cos(2.0 * math.pi * uniform(state))


@njit(**INNER)
def direction(state: Generator) -> tuple[float, float, float]:
    """Draw a unit vector."""
    z = 2.0 * uniform(state) - 1.0
    across, angle = math.sqrt(1.0 - z * z), 2.0 * math.pi * uniform(state)
    return across * math.cos(angle), across * math.sin(angle), z
