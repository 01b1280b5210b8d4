"""One line between its ends: the pull of a straight line, and of an elastic catenary.

Of a line and a place (x, z) of its fairlead beside and above its anchor there is one pair (H, V):
U*(H, V) - x H - z V is convex, and least there. U* = ∫ (T + T²/2EA) ds over the line.
"""

import math
from typing import NamedTuple

from numba import njit

from quintet.components.shared.numba_options import EXACT

STEPS = 100  # of Newton's method; usually 3 to 10
ENOUGH = 1e-13  # of a line's length, by which its end may miss the fairlead
SLACK = 1e-9  # of a line's weight: the least horizontal pull that is computed
HALVINGS = 60  # of one of these steps
ROUNDING = 1e-12  # of energies


class Cable(NamedTuple):
    """What does not change of a line."""

    length: float  # m, L, without pull
    stiffness: float  # N, EA
    weight: float  # N/m, w, in water; 0 of a straight line
    has_bed: bool  # whether it may lie on the bed


class Pull(NamedTuple):
    """Pull of a line at its fairlead."""

    horizontal: float  # N, H, towards the anchor
    vertical: float  # N, V, downwards
    misses: float  # 1, by how much of L the line's end misses the fairlead


@njit(**EXACT)
def straight_pull(distance: float, length: float, stiffness: float) -> float:
    """Pull [N] of a line without weight whose ends are so far apart [m]."""
    return stiffness * max(distance / length - 1.0, 0.0)


@njit(**EXACT)
def lowest_pull(cable: Cable, vertical: float) -> float:
    """Vertical pull V_a [N] at the anchor, or where the line leaves the bed."""
    below = vertical - cable.weight * cable.length
    return max(below, 0.0) if cable.has_bed else below


@njit(**EXACT)
def lying_length(cable: Cable, vertical: float) -> float:
    """Length [m] of a line, without pull, that lies on the bed."""
    return max(cable.length - vertical / cable.weight, 0.0) if cable.has_bed else 0.0


@njit(**EXACT)
def asinh_rise(h: float, v: float, low: float, hung: float) -> float:
    """asinh(v/h) - asinh(low/h) [1], to rounding also where the two are nearly the same.

    `hung` = v - low [N] is the weight of what hangs.
    """
    if v * low <= 0.0:
        return math.asinh(v / h) - math.asinh(low / h)
    upper, lower = math.hypot(h, v), math.hypot(h, low)
    return math.asinh(hung * (v + low) / (v * lower + low * upper))


@njit(**EXACT)
def sine_rise(h: float, v: float, low: float, hung: float) -> float:
    """v/√(h² + v²) - low/√(h² + low²) [1], likewise."""
    upper, lower = math.hypot(h, v), math.hypot(h, low)
    if v * low <= 0.0:
        return v / upper - low / lower
    return h * h * hung * (v + low) / ((v * lower + low * upper) * upper * lower)


@njit(**EXACT)
def end_of(cable: Cable, h: float, v: float) -> tuple[float, float]:
    """Where a line ends [m], beside and above its anchor, under a pull; Jonkman, (2-35), (2-37).

    Lines that lie on the bed have no friction there (C_B = 0).
    """
    low, lying = lowest_pull(cable, v), lying_length(cable, v)
    sum_of_pulls, hung = v + low, cable.length - lying
    x = lying + h / cable.weight * asinh_rise(h, v, low, cable.weight * hung)
    z = hung * sum_of_pulls / (math.hypot(h, v) + math.hypot(h, low))
    stretch = 1.0 / cable.stiffness
    return x + h * cable.length * stretch, z + 0.5 * hung * sum_of_pulls * stretch


@njit(**EXACT)
def compliance(cable: Cable, h: float, v: float) -> tuple[float, float, float]:
    """Derivatives ∂x/∂H, ∂x/∂V = ∂z/∂H and ∂z/∂V [m/N] of where a line ends."""
    low = lowest_pull(cable, v)
    hung = cable.length - lying_length(cable, v)
    weight = cable.weight * hung
    upper, lower, rise = math.hypot(h, v), math.hypot(h, low), sine_rise(h, v, low, weight)
    along = (asinh_rise(h, v, low, weight) - rise) / cable.weight + cable.length / cable.stiffness
    across = -h * hung * (v + low) / (upper * lower * (upper + lower))
    return along, across, rise / cable.weight + hung / cable.stiffness


@njit(**EXACT)
def steepest(cable: Cable, h: float, v: float) -> float:
    """Greatest stiffness [N/m] of a hanging line at its fairlead, in any direction."""
    along, across, up = compliance(cable, h, v)
    determinant = along * up - across * across
    if determinant <= 0.0:
        return cable.stiffness / cable.length
    half = 0.5 * (along + up)
    least = determinant / (half + math.sqrt(max(half * half - determinant, 0.0)))
    return 1.0 / least


@njit(**EXACT)
def stored(cable: Cable, h: float, v: float) -> float:
    """U*(H, V) [J], whose derivatives are x and z."""
    w, low, lying = cable.weight, lowest_pull(cable, v), lying_length(cable, v)
    hung = w * (cable.length - lying)
    upper, lower = math.hypot(h, v), math.hypot(h, low)
    arc = h * h * asinh_rise(h, v, low, hung)
    if v * low > 0.0:  # v upper - low lower, to rounding
        arc += hung * (v + low) * (h * h + v * v + low * low) / (v * upper + low * lower)
    else:
        arc += v * upper - low * lower
    squares = hung * (h * h + (v * v + v * low + low * low) / 3.0)
    lies = lying * (h + h * h / (2.0 * cable.stiffness))
    return arc / (2.0 * w) + squares / (2.0 * w * cable.stiffness) + lies


@njit(**EXACT)
def energy(cable: Cable, h: float, v: float, x: float, z: float) -> float:
    """Energy U [J] of a hanging line: stretch, and weight above the anchor; ∇U is its pull."""
    return h * x + v * z - stored(cable, h, v)


@njit(**EXACT)
def place_along(cable: Cable, h: float, v: float, length: float) -> tuple[float, float, float]:
    """Place (x, z) [m] and tension [N] of a line after so much of its length from the anchor."""
    v = v - cable.weight * (cable.length - length)
    if cable.has_bed:
        v = max(v, 0.0)
    x, z = end_of(Cable(length, cable.stiffness, cable.weight, cable.has_bed), h, v)
    return x, z, math.hypot(h, v)


@njit(**EXACT)
def first_guess(cable: Cable, x: float, z: float) -> tuple[float, float]:
    """H and V [N] to begin with; Jonkman, section 2.3.1, and of taut lines the straight pull."""
    length, w, distance = cable.length, cable.weight, math.hypot(x, z)
    if distance >= length:
        share = straight_pull(distance, length, cable.stiffness) / distance
        h, v = share * x + 0.1 * w * length, share * z + 0.5 * w * length
    else:
        slope = math.sqrt(3.0 * max((length * length - z * z) / (x * x) - 1.0, 1e-6))
        h, v = 0.5 * w * x / slope, 0.5 * w * (z / math.tanh(slope) + length)
    return max(h, SLACK * w * length), v


@njit(**EXACT)
def gap_of(
    cable: Cable, h: float, v: float, x: float, z: float, is_least: bool
) -> tuple[tuple[float, float], bool]:
    """Gap [m] from a line's end to its fairlead, and whether the line is slack: H is 0 then."""
    end_x, end_z = end_of(cable, h, v)
    is_slack = is_least and end_x >= x
    return (0.0 if is_slack else x - end_x, z - end_z), is_slack


@njit(**EXACT)
def newton_step(
    cable: Cable, pull: tuple[float, float], gap: tuple[float, float], is_slack: bool
) -> tuple[float, float]:
    """Changes of H and V [N] that move the line's end over a gap [m] to the fairlead."""
    along, across, up = compliance(cable, pull[0], pull[1])
    if is_slack:
        return 0.0, gap[1] / up
    determinant = along * up - across * across
    return (
        (up * gap[0] - across * gap[1]) / determinant,
        (along * gap[1] - across * gap[0]) / determinant,
    )


@njit(**EXACT)
def bounded(new: float, old: float, least: float) -> float:
    """A pull [N] that stays above its least value, and falls to a tenth at most in a step."""
    return new if new > least else max(0.1 * old, least)


@njit(**EXACT)
def hanging_pull(cable: Cable, x: float, z: float, guess_h: float, guess_v: float) -> Pull:
    """Pull of a line whose fairlead is at (x, z) [m] beside and above its anchor.

    Newton's method on the convex U* - x H - z V, each step halved until that falls. The rest of a
    slack line lies in a heap on the bed, or hangs straight down; its horizontal pull is 0.

    Parameters
    ----------
    cable : Cable
    x, z : float, m
        x is not negative; z is not negative where the line may lie on the bed.
    guess_h, guess_v : float, N
        The pull a moment ago; `guess_h` is 0 where it is not known.

    Returns
    -------
    Pull
    """
    length, least = cable.length, SLACK * cable.weight * cable.length
    lowest = least if cable.has_bed else -math.inf
    x = max(x, 1e-9 * length)
    h, v = (guess_h, guess_v) if guess_h > 0.0 else first_guess(cable, x, z)
    h, v = max(h, least), max(v, lowest)
    level = stored(cable, h, v) - x * h - z * v
    gap, is_slack = gap_of(cable, h, v, x, z, h <= least)
    misses = math.hypot(gap[0], gap[1]) / length
    for _ in range(STEPS):
        if misses < ENOUGH:
            break
        dh, dv = newton_step(cable, (h, v), gap, is_slack)
        is_better = False
        for _ in range(HALVINGS):
            new_h, new_v = bounded(h + dh, h, least), bounded(v + dv, v, lowest)
            new_level = stored(cable, new_h, new_v) - x * new_h - z * new_v
            gap, is_slack = gap_of(cable, new_h, new_v, x, z, new_h <= least)
            new_misses = math.hypot(gap[0], gap[1]) / length
            # At the end levels differ by rounding alone.
            noise = ROUNDING * (abs(x * h) + abs(z * v) + abs(level))
            is_better = new_level < level or (new_misses < misses and new_level < level + noise)
            if is_better:
                break
            dh, dv = 0.5 * dh, 0.5 * dv
        if not is_better:
            break
        h, v, level, misses = new_h, new_v, new_level, new_misses
    return Pull(h, v, misses)
