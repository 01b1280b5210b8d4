"""What the blocks of rows tallied, put together as the report on a step."""

import math

import numpy as np
from numba import njit

from quintet.components.dem_bodies.geometry import FAR
from quintet.components.dem_bodies.state import (
    BORNE,
    DEEPEST,
    ELASTIC,
    FASTEST,
    GAP,
    GIVEN,
    HARDEST,
    MOVING,
    STIFFEST,
    WAY,
    WHICH,
    WORK,
    Numbers,
    State,
)
from quintet.components.shared.rotations import INNER


@njit(**INNER)
def furthest(state: State, tally: Numbers) -> float:
    """Report and return the square of the longest way [m²] since pairs were listed."""
    state.report[WAY] = tally[:, WAY].max()
    return float(state.report[WAY])


@njit(**INNER)
def found(state: State, tally: Numbers) -> None:
    """Report what the pairs of balls tallied."""
    report = state.report
    report[GAP], report[DEEPEST], report[WHICH] = FAR, 0.0, -1.0
    report[ELASTIC], report[STIFFEST] = 0.0, 0.0
    for b in range(tally.shape[0]):
        report[GAP] = min(report[GAP], tally[b, GAP])
        if tally[b, DEEPEST] > report[DEEPEST]:
            report[DEEPEST], report[WHICH] = tally[b, DEEPEST], tally[b, WHICH]
        report[ELASTIC] += tally[b, ELASTIC]
        report[STIFFEST] = max(report[STIFFEST], tally[b, STIFFEST])


@njit(**INNER)
def close(state: State, tally: Numbers) -> None:
    """Report work done, and how fast points may move; give the ground what planes bear."""
    report, ground = state.report, state.contact.shape[0] - 1
    report[WORK], report[GIVEN] = 0.0, 0.0
    most = np.zeros(5)
    for b in range(tally.shape[0]):
        report[WORK] += tally[b, WORK]
        report[GIVEN] += tally[b, GIVEN]
        for k in range(6):
            state.contact[ground, k] += tally[b, BORNE + k]
        for k in range(5):
            most[k] = max(most[k], tally[b, MOVING + k])
    report[FASTEST] = math.sqrt(most[0]) + math.sqrt(most[1])
    report[HARDEST] = math.sqrt(most[2]) + math.sqrt(most[3]) + most[4]
