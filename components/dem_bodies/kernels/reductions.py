"""Sums and extremes over the blocks of rows, put together as the report on a step."""

import math

from numba import njit

from quintet.components.dem_bodies.kernels.geometry import FAR
from quintet.components.dem_bodies.state import (
    ACCELERATION2,
    CENTRIPETAL,
    CONTACT_WORK,
    DEEPEST,
    DEEPEST_PAIR,
    ELASTIC_ENERGY,
    GROUND_LOAD,
    LARGEST_ACCELERATION,
    LARGEST_SPEED,
    LOAD_WORK,
    ROTATION2,
    SMALLEST_GAP,
    SPIN_UP2,
    STIFFEST,
    TRAVEL,
    VELOCITY2,
    Numbers,
)
from quintet.components.shared.numba_options import EXACT, INNER


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
def reduce_bodies(report: Numbers, contact_load: Numbers, sums: Numbers) -> None:
    """Report work, travel and how fast points may move; the ground gets the load on planes."""
    ground = contact_load.shape[0] - 1
    report[CONTACT_WORK], report[LOAD_WORK] = 0.0, 0.0
    report[TRAVEL] = sums[:, TRAVEL].max()
    velocity2, rotation2, acceleration2, spin_up2, centripetal = 0.0, 0.0, 0.0, 0.0, 0.0
    for b in range(sums.shape[0]):
        report[CONTACT_WORK] += sums[b, CONTACT_WORK]
        report[LOAD_WORK] += sums[b, LOAD_WORK]
        for k in range(6):
            contact_load[ground, k] += sums[b, GROUND_LOAD + k]
        velocity2 = max(velocity2, sums[b, VELOCITY2])
        rotation2 = max(rotation2, sums[b, ROTATION2])
        acceleration2 = max(acceleration2, sums[b, ACCELERATION2])
        spin_up2 = max(spin_up2, sums[b, SPIN_UP2])
        centripetal = max(centripetal, sums[b, CENTRIPETAL])
    report[LARGEST_SPEED] = math.sqrt(velocity2) + math.sqrt(rotation2)
    report[LARGEST_ACCELERATION] = math.sqrt(acceleration2) + math.sqrt(spin_up2) + centripetal


@njit(**EXACT)
def number_pairs(sums: Numbers, first: int, last: int, before: int) -> None:
    """Number the deepest pairs of the blocks [first, last) behind those of earlier ranks."""
    for b in range(first, last):
        if sums[b, DEEPEST_PAIR] >= 0.0:
            sums[b, DEEPEST_PAIR] += before
