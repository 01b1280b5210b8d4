"""Blocks of elements or of quadrature points, which kernels advance side by side.

A block's numbers stand in rows of LANES, one row after another in one flat array: loops over lanes
read and write rows whose distances the compiler knows, and become vectors.
"""

from numba import njit

from quintet.components.fe_plate.state import LANES
from quintet.components.shared.numba_options import FAST_LANEWISE

# Rows of what a block needs within a step.
X, V = 0, 24  # corners, 3a + d: m, m/s
COEFFICIENT = 48  # 18: ∂V/∂x of a corner is a sum of these by its signs, m2
PATTERN, RATE = 66, 78  # 12 each: hourglass patterns of the corners, m, and their rates, m/s
GRADIENT = 90  # 9: velocity gradient in the middle of the step, by rows, 1/s
VOLUME, LENGTH, EDGE = 99, 100, 101  # m3, m, m
RATIO, CHANGE = 102, 103  # ρ₀/ρ; of the specific volume over the step, m3/kg
SPEED = 104  # of sound, m/s
STRESS = 105  # 6 rows, Pa
TRIAL, SOFT, DELTA = 111, 112, 113  # Pa, equivalent; 1, thermal softening; plastic strain
LOGARITHM = 147  # of DELTA
WORK = 114  # plastic, J/m3; on the springs, J
OLD = 115  # 6 rows, deviator before the step, Pa
COFACTOR = 121  # 9: V ∇ξ, V ∇η, V ∇ζ at points, m2
FRAME = 130  # 9: axes of an element
LOCAL = 139  # 6: along them, rates of strain or stresses
PLACE, ENDS = 139, 140  # in the isentrope's table; 4: energies and slopes of its two rows, J/kg
SPECIFIC = 145  # V over the mass, m3/kg
SCRATCH = 146
ROWS = 148


@njit(**FAST_LANEWISE)
def load_corners(values, corner, first, count, beyond, row, out):  # type: ignore[no-untyped-def]
    """Take values (n, 3) of the corners of `count` elements from a first one on.

    Far corners 4 to 7 stand `beyond` the values along y: the depth of elements in a plane.
    """
    for lane in range(count):
        for a in range(8):
            node = corner[first + lane, a]
            at = (row + 3 * a) * LANES + lane
            out[at] = values[node, 0]
            out[at + LANES] = values[node, 1]
            out[at + 2 * LANES] = values[node, 2]
    if beyond != 0.0:
        for a in range(4, 8):
            for lane in range(count):
                out[(row + 3 * a + 1) * LANES + lane] += beyond


@njit(**FAST_LANEWISE)
def take_from_corners(row, work, first, count, target, out):  # type: ignore[no-untyped-def]
    """Take rows of corner values from those (rows, 3) that they act on, element by element.

    Each sum is made in the order of the elements: the same bits however these are shared out.
    """
    for lane in range(count):
        for a in range(8):
            at = (row + 3 * a) * LANES + lane
            node = target[first + lane, a]
            out[node, 0] -= work[at]
            out[node, 1] -= work[at + LANES]
            out[node, 2] -= work[at + 2 * LANES]


@njit(**FAST_LANEWISE)
def patterns_of(values, row, lane):  # type: ignore[no-untyped-def]
    """Means of corner values along one axis times 1, ξ, η, ζ, ηζ, ζξ, ξη and ξηζ of the corners.

    The field within the element is their sum with these factors; rows are 3 apart.
    """
    at = row * LANES + lane
    a, b, c, d = (
        values[at],
        values[at + 3 * LANES],
        values[at + 6 * LANES],
        values[at + 9 * LANES],
    )
    e, f, g, h = (
        values[at + 12 * LANES],
        values[at + 15 * LANES],
        values[at + 18 * LANES],
        values[at + 21 * LANES],
    )
    ab, ba, cd, dc = a + b, b - a, c + d, c - d
    ef, fe, gh, hg = e + f, f - e, g + h, g - h
    low, high = (ab + cd, ba + dc, cd - ab, dc - ba), (ef + gh, fe + hg, gh - ef, hg - fe)
    return (
        0.125 * (low[0] + high[0]),
        0.125 * (low[1] + high[1]),
        0.125 * (low[2] + high[2]),
        0.125 * (high[0] - low[0]),
        0.125 * (high[2] - low[2]),
        0.125 * (high[1] - low[1]),
        0.125 * (low[3] + high[3]),
        0.125 * (high[3] - low[3]),
    )


@njit(**FAST_LANEWISE)
def corners_from(p, out, row, lane):  # type: ignore[no-untyped-def]
    """Write the sums of seven numbers with the signs ξ, η, ζ, ηζ, ζξ, ξη and ξηζ of the corners."""
    low = -p[2], p[0] - p[4], p[1] - p[3], p[5] - p[6]
    high = p[2], p[0] + p[4], p[1] + p[3], p[5] + p[6]
    at = row * LANES + lane
    out[at] = low[0] - low[1] - low[2] + low[3]
    out[at + 3 * LANES] = low[0] + low[1] - low[2] - low[3]
    out[at + 6 * LANES] = low[0] + low[1] + low[2] + low[3]
    out[at + 9 * LANES] = low[0] - low[1] + low[2] - low[3]
    out[at + 12 * LANES] = high[0] - high[1] - high[2] + high[3]
    out[at + 15 * LANES] = high[0] + high[1] - high[2] - high[3]
    out[at + 18 * LANES] = high[0] + high[1] + high[2] + high[3]
    out[at + 21 * LANES] = high[0] - high[1] + high[2] - high[3]


@njit(**FAST_LANEWISE)
def three(work, row, k):  # type: ignore[no-untyped-def]
    """Vector that stands in three rows."""
    at = row * LANES + k
    return work[at], work[at + LANES], work[at + 2 * LANES]


@njit(**FAST_LANEWISE)
def put_three(work, row, k, values):  # type: ignore[no-untyped-def]
    """Write a vector into three rows."""
    at = row * LANES + k
    work[at], work[at + LANES], work[at + 2 * LANES] = values


@njit(**FAST_LANEWISE)
def six(work, at):  # type: ignore[no-untyped-def]
    """Symmetric tensor that stands in six rows, the first number at a place."""
    return (
        work[at],
        work[at + LANES],
        work[at + 2 * LANES],
        work[at + 3 * LANES],
        work[at + 4 * LANES],
        work[at + 5 * LANES],
    )


@njit(**FAST_LANEWISE)
def put_six(work, at, values):  # type: ignore[no-untyped-def]
    """Write a symmetric tensor into six rows."""
    work[at], work[at + LANES], work[at + 2 * LANES] = values[0], values[1], values[2]
    work[at + 3 * LANES], work[at + 4 * LANES], work[at + 5 * LANES] = (
        values[3],
        values[4],
        values[5],
    )


@njit(**FAST_LANEWISE)
def nine(work, row, k):  # type: ignore[no-untyped-def]
    """Tensor that stands in nine rows."""
    a, b, c = three(work, row, k), three(work, row + 3, k), three(work, row + 6, k)
    return a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2]


@njit(**FAST_LANEWISE)
def put_nine(work, row, k, values):  # type: ignore[no-untyped-def]
    """Write a tensor into nine rows."""
    put_three(work, row, k, (values[0], values[1], values[2]))
    put_three(work, row + 3, k, (values[3], values[4], values[5]))
    put_three(work, row + 6, k, (values[6], values[7], values[8]))


@njit(**FAST_LANEWISE)
def greatest(work, row):  # type: ignore[no-untyped-def]
    """Greatest number of a row; within another loop it would keep that from becoming vectors."""
    largest = work[row * LANES]
    for k in range(1, LANES):
        largest = max(largest, work[row * LANES + k])
    return largest


@njit(**FAST_LANEWISE)
def least(work, row):  # type: ignore[no-untyped-def]
    """Least number of a row."""
    smallest = work[row * LANES]
    for k in range(1, LANES):
        smallest = min(smallest, work[row * LANES + k])
    return smallest
