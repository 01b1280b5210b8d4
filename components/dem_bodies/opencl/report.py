"""The report on a step, from the numbers that a device reduces over all rows and pairs."""

import math

from quintet.components.dem_bodies.kernels.geometry import FAR
from quintet.components.dem_bodies.opencl.stages import Reduced
from quintet.components.dem_bodies.state import (
    CONTACT_WORK,
    DEEPEST,
    DEEPEST_PAIR,
    ELASTIC_ENERGY,
    LARGEST_ACCELERATION,
    LARGEST_SPEED,
    LOAD_WORK,
    SMALLEST_GAP,
    STIFFEST,
    TOUCHING,
    TRAVEL,
    Numbers,
    State,
)


def write_report(state: State, gravity: Numbers, reduced: Reduced, travel: float) -> None:
    """Write the report of a step, and the load on the ground.

    `travel` [m²] is the square of the largest displacement since pairs were listed.
    """
    report, pairs, kick, g = state.report, reduced.of_pairs, reduced.of_kick, gravity
    report[SMALLEST_GAP] = min(FAR, -pairs["OVERLAP"])
    report[STIFFEST], report[DEEPEST] = pairs["STIFFNESS"], pairs["RELATIVE"]
    report[DEEPEST_PAIR] = 0.0 if pairs["RELATIVE"] > 0.0 else -1.0
    report[ELASTIC_ENERGY] = kick["ENERGY"]
    report[CONTACT_WORK] = reduced.of_drift["WORK"] + kick["WORK"]
    report[LOAD_WORK] = reduced.of_drift["LOAD_WORK"] + kick["LOAD_WORK"]
    report[TRAVEL], report[TOUCHING] = max(travel, 0.0), 0.0
    report[LARGEST_SPEED] = root(kick["VELOCITY2"]) + root(kick["ROTATION2"])
    acceleration2 = max(g[0] * g[0] + g[1] * g[1] + g[2] * g[2], kick["ACCELERATION2"])
    report[LARGEST_ACCELERATION] = (
        root(acceleration2) + root(kick["SPIN_UP2"]) + max(kick["CENTRIPETAL"], 0.0)
    )
    state.contact_load[-1] = reduced.on_ground


def root(square: float) -> float:
    """Root of a maximum of squares; 0 if all were NaN."""
    return math.sqrt(max(square, 0.0))
