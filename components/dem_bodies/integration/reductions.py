"""Sums and extremes over the blocks of rows, put together as the report on a step."""

import math

import numpy as np
from numba import njit

from quintet.components.dem_bodies.contact.geometry import FAR
from quintet.components.dem_bodies.state import (
    CONTACT_WORK,
    DEEPEST,
    DEEPEST_PAIR,
    ELASTIC_ENERGY,
    GROUND_LOAD,
    LARGEST_ACCELERATION,
    LARGEST_SPEED,
    LOAD_WORK,
    SMALLEST_GAP,
    STIFFEST,
    TRAVEL,
    VELOCITY2,
    Numbers,
    State,
)
from quintet.components.shared.numba_options import INNER


@njit(**INNER)
def reduce_pairs(report: Numbers, sums: Numbers) -> None:
    """Report what was found at the pairs of balls."""
    report[SMALLEST_GAP], report[DEEPEST], report[DEEPEST_PAIR] = FAR, 0.0, -1.0
    report[ELASTIC_ENERGY], report[STIFFEST] = 0.0, 0.0
    for b in range(sums.shape[0]):
        report[SMALLEST_GAP] = min(report[SMALLEST_GAP], sums[b, SMALLEST_GAP])
        if sums[b, DEEPEST] > report[DEEPEST]:
            report[DEEPEST], report[DEEPEST_PAIR] = sums[b, DEEPEST], sums[b, DEEPEST_PAIR]
        report[ELASTIC_ENERGY] += sums[b, ELASTIC_ENERGY]
        report[STIFFEST] = max(report[STIFFEST], sums[b, STIFFEST])


@njit(**INNER)
def reduce_bodies(state: State, sums: Numbers) -> None:
    """Report work, travel and how fast points may move; the ground gets the load on planes."""
    report, ground = state.report, state.contact_load.shape[0] - 1
    report[CONTACT_WORK], report[LOAD_WORK] = 0.0, 0.0
    report[TRAVEL] = sums[:, TRAVEL].max()
    largest = np.zeros(5)
    for b in range(sums.shape[0]):
        report[CONTACT_WORK] += sums[b, CONTACT_WORK]
        report[LOAD_WORK] += sums[b, LOAD_WORK]
        for k in range(6):
            state.contact_load[ground, k] += sums[b, GROUND_LOAD + k]
        for k in range(5):
            largest[k] = max(largest[k], sums[b, VELOCITY2 + k])
    report[LARGEST_SPEED] = math.sqrt(largest[0]) + math.sqrt(largest[1])
    report[LARGEST_ACCELERATION] = math.sqrt(largest[2]) + math.sqrt(largest[3]) + largest[4]
