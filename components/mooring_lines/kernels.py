"""Loops over lines: where their fairleads are, and what they pull with there."""

import math

from numba import njit

from quintet.components.mooring_lines.laws import (
    Cable,
    energy,
    hanging_pull,
    lowest_pull,
    lying_length,
    place_along,
    steepest,
    straight_pull,
)
from quintet.components.mooring_lines.state import BELOW, Array, Lines
from quintet.components.shared.numba_options import EXACT

ALLOWED = 1e-8  # of a line's length, by which its end may miss the fairlead


@njit(**EXACT)
def height_of(cable: Cable, rise: float) -> float:
    """Height [m] of a fairlead above its anchor; one that has sunk lies on the bed."""
    return max(rise, 0.0) if cable.has_bed else rise


@njit(**EXACT)
def pull_of(k: int, fairlead: Array, lines: Lines, pull: Array) -> tuple[float, float, bool]:
    """Pull H and V [N] of a line, and whether it was found; updates `pull`, where it begins."""
    dx, dy, dz = fairlead[k] - lines.anchor[k]
    level = math.hypot(dx, dy)
    if lines.weight[k] == 0.0:
        distance = math.hypot(level, dz)
        tension = straight_pull(distance, lines.length[k], lines.stiffness[k])
        share = tension / distance if tension > 0.0 else 0.0
        return share * level, share * dz, math.isfinite(distance)
    cable = Cable(lines.length[k], lines.stiffness[k], lines.weight[k], lines.has_bed[k])
    is_sunken = cable.has_bed and dz < -BELOW * cable.length
    hanging = hanging_pull(cable, level, height_of(cable, dz), pull[k, 0], pull[k, 1])
    pull[k, 0], pull[k, 1] = hanging.horizontal, hanging.vertical
    return hanging.horizontal, hanging.vertical, hanging.misses < ALLOWED and not is_sunken


@njit(**EXACT)
def add_loads(fairlead: Array, centre: Array, lines: Lines, pull: Array, load: Array) -> int:
    """Add the force [N] and the torque [N m] of all lines to the loads of bodies.

    Parameters
    ----------
    fairlead : (k, 3) m
    centre : (b, 3) m
    lines : Lines
    pull : (k, 2) N
        Where each search begins; updated.
    load : (b, 6) N, N m

    Returns
    -------
    int
        Number of the first line that was not found, or that of the lines.
    """
    wrong = len(fairlead)
    for k in range(len(fairlead)):
        body = lines.body[k]
        h, v, is_found = pull_of(k, fairlead, lines, pull)
        if not is_found:
            wrong = min(wrong, k)
            continue
        dx, dy = fairlead[k, 0] - lines.anchor[k, 0], fairlead[k, 1] - lines.anchor[k, 1]
        level = math.hypot(dx, dy)
        share = h / level if level > 0.0 else 0.0
        fx, fy, fz = -share * dx, -share * dy, -v
        rx, ry, rz = fairlead[k] - centre[body]
        load[body, 0] += fx
        load[body, 1] += fy
        load[body, 2] += fz
        load[body, 3] += ry * fz - rz * fy
        load[body, 4] += rz * fx - rx * fz
        load[body, 5] += rx * fy - ry * fx
    return wrong


@njit(**EXACT)
def read_lines(fairlead: Array, lines: Lines, pull: Array, gauge: Array) -> float:
    """Read all lines: their energy [J], and into `gauge` (k, 4) tensions, length and stiffness.

    Tension at the fairlead and at the anchor [N], length on the bed [m], greatest stiffness [N/m].
    """
    total = 0.0
    for k in range(len(fairlead)):
        h, v, _ = pull_of(k, fairlead, lines, pull)
        tension = math.hypot(h, v)
        gauge[k, 0], gauge[k, 1], gauge[k, 2] = tension, tension, 0.0
        gauge[k, 3] = lines.stiffness[k] / lines.length[k] if tension > 0.0 else 0.0
        if lines.weight[k] == 0.0:
            total += 0.5 * tension * tension * lines.length[k] / lines.stiffness[k]
            continue
        cable = Cable(lines.length[k], lines.stiffness[k], lines.weight[k], lines.has_bed[k])
        dx, dy, dz = fairlead[k] - lines.anchor[k]
        gauge[k, 1] = math.hypot(h, lowest_pull(cable, v))
        gauge[k, 2] = lying_length(cable, v)
        gauge[k, 3] = steepest(cable, h, v)
        total += energy(cable, h, v, math.hypot(dx, dy), height_of(cable, dz))
    return total


@njit(**EXACT)
def draw_lines(fairlead: Array, lines: Lines, pull: Array, points: Array, tension: Array) -> None:
    """Places (k, m, 3) m and tension (k, m) N along all lines, evenly spaced without pull."""
    count = points.shape[1]
    for k in range(len(fairlead)):
        h, v, _ = pull_of(k, fairlead, lines, pull)
        dx, dy, dz = fairlead[k] - lines.anchor[k]
        level = math.hypot(dx, dy)
        cable = Cable(lines.length[k], lines.stiffness[k], lines.weight[k], lines.has_bed[k])
        for m in range(count):
            share = m / (count - 1)
            along, up, pulled = share * level, share * dz, math.hypot(h, v)
            if cable.weight > 0.0:
                along, up, pulled = place_along(cable, h, v, share * cable.length)
            ratio = along / level if level > 0.0 else 0.0
            points[k, m, 0] = lines.anchor[k, 0] + ratio * dx
            points[k, m, 1] = lines.anchor[k, 1] + ratio * dy
            points[k, m, 2] = lines.anchor[k, 2] + up
            tension[k, m] = pulled
