"""What elements with several quadrature points share: erosion, and the volumes of their points.

Lanes are points; `count` of them, one after another, belong to an element.
"""

from numba import njit

from quintet.components.fe_plate.kernels.blocks import (
    GRADIENT,
    RATIO,
    SPECIFIC,
    VOLUME,
    put_six,
)
from quintet.components.fe_plate.state import (
    ACTIVE,
    DEVIATOR,
    DILATION,
    LANES,
    PRESSURE,
)
from quintet.components.shared.elementary import exponential
from quintet.components.shared.numba_options import FAST_LANEWISE

ROUNDING = 1e-14  # of volumes: at rest nothing is strained


@njit(**FAST_LANEWISE)
def erode(points, count):  # type: ignore[no-untyped-def]
    """Let all points of an element fail of which one has."""
    for first in range(0, LANES, count):
        left = 1.0
        for k in range(first, first + count):
            left = min(left, points[ACTIVE * LANES + k])
        if left == 0.0:
            for k in range(first, first + count):
                points[ACTIVE * LANES + k] = 0.0
                points[PRESSURE * LANES + k] = 0.0
                put_six(points, DEVIATOR * LANES + k, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0))


@njit(**FAST_LANEWISE)
def compare_volumes(points, start, work, law, dt, count):  # type: ignore[no-untyped-def]
    """Write ρ₀/ρ: that of the element, times what the assumed strains have made of each point."""
    for first in range(0, LANES, count):
        now, before, mean = 0.0, 0.0, 0.0
        for k in range(first, first + count):
            now += work[VOLUME * LANES + k]
            before += start[k]
            mean += work[VOLUME * LANES + k] * trace_at(work, k)
        mean /= now
        for k in range(first, first + count):
            live = points[ACTIVE * LANES + k] > 0.0
            at = DILATION * LANES + k
            points[at] += dt * (trace_at(work, k) - mean) if live else 0.0
            ratio = now / before * exponential(points[at])
            ratio = 1.0 if abs(ratio - 1.0) < ROUNDING else ratio
            point_ratio = work[VOLUME * LANES + k] / start[k]
            work[RATIO * LANES + k] = ratio if live else 1.0
            work[SPECIFIC * LANES + k] = (point_ratio if live else 1.0) / law.density
            for row in range(GRADIENT * LANES, (GRADIENT + 9) * LANES, LANES):
                work[row + k] = work[row + k] if live else 0.0


@njit(**FAST_LANEWISE)
def trace_at(work, k):  # type: ignore[no-untyped-def]
    """Trace [1/s] of the velocity gradient of a lane."""
    at = GRADIENT * LANES + k
    return work[at] + work[at + 4 * LANES] + work[at + 8 * LANES]
