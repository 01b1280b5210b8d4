"""Flight of spheres over a step, and impulses where they touch each other or walls.

Flight has symplectic stages, and rotation of fourth order.

An impact is detected at the end of a step and has its own time within it: with constant
accelerations the relative motion since then follows, and so do the velocities at contact.
"""

import math

from numba import njit

from quintet.components.particle_dynamics.spheres.laws import (
    impact_of_spheres,
    impact_on_wall,
)
from quintet.components.shared.numba_options import EXACT
from quintet.components.shared.rotations import Vector, dot, rotated
from quintet.components.shared.search.cells import Whole
from quintet.interfaces.component import Array


@njit(**EXACT)
def difference(vectors: Array, i: int, j: int) -> Vector:
    """Row i less row j of vectors (n, 3)."""
    x = vectors[i, 0] - vectors[j, 0]
    return x, vectors[i, 1] - vectors[j, 1], vectors[i, 2] - vectors[j, 2]


@njit(**EXACT)
def add_along(vectors: Array, i: int, length: float, normal: Vector) -> None:
    """Add a length along a unit vector to row i of vectors (n, 3)."""
    for k in range(3):
        vectors[i, k] += length * normal[k]


@njit(**EXACT)
def fly(
    dt: float, end: float, stages: Array, gravity: Array, launch: Array, flying: Array,
    start: Array, mass: Array, inertia: Array, tether: Array, force: Array, torque: Array,
    position: Array, velocity: Array, orientation: Array, spin: Array,
) -> None:  # fmt: skip
    """Advance spheres that have been launched; those launched within the step for its rest.

    Parameters
    ----------
    dt, end : float, s
        Length of the step, and when it ends.
    stages : (s,) float array
        Shares of the step: 1, or Yoshida's three.
    gravity : (3,) float array, m/s2
    launch, flying : (n,) float array, s, and (n,) bool array
        When each is launched; whether it was before the step.
    start : (n, 3) float array, m
        To which tethers pull.
    mass, inertia, tether : (n,) float array, kg, kg m2, N/m
    force, torque : (n, 3) float array, N and N m
        Constant over the step.
    position, velocity, orientation, spin : (n, 3 or 4) float array, m, m/s, 1, rad/s
        Written. Angular velocities change linearly in time, for which the rotation vector
        ∫ω dt + dt³/12 (dω/dt × ω) is of fourth order.

    References
    ----------
    Yoshida, Phys. Lett. A 150 (1990) 262 (stages). Iserles et al., Acta Numer. 9 (2000) 215 (the
    second term of Magnus's series).
    """
    for i in range(position.shape[0]):
        span = dt if flying[i] else min(max(end - launch[i], 0.0), dt)
        if launch[i] > end:
            continue
        square = tether[i] / mass[i]  # 1/s2
        for stage in stages:
            h = stage * span
            for k in range(3):
                pushed = force[i, k] / mass[i] + gravity[k]
                velocity[i, k] += 0.5 * h * (pushed - square * (position[i, k] - start[i, k]))
                position[i, k] += h * velocity[i, k]
                velocity[i, k] += 0.5 * h * (pushed - square * (position[i, k] - start[i, k]))
        ax, ay, az = torque[i, 0] / inertia[i], torque[i, 1] / inertia[i], torque[i, 2] / inertia[i]
        ox, oy, oz = spin[i, 0], spin[i, 1], spin[i, 2]
        half, cubic = 0.5 * span * span, span**3 / 12.0
        x = span * ox + half * ax + cubic * (ay * oz - az * oy)
        y = span * oy + half * ay + cubic * (az * ox - ax * oz)
        z = span * oz + half * az + cubic * (ax * oy - ay * ox)
        q = (orientation[i, 0], orientation[i, 1], orientation[i, 2], orientation[i, 3])
        orientation[i, 0], orientation[i, 1], orientation[i, 2], orientation[i, 3] = rotated(
            q, x, y, z
        )
        spin[i, 0], spin[i, 1], spin[i, 2] = ox + span * ax, oy + span * ay, oz + span * az


@njit(**EXACT)
def largest(vectors: Array) -> float:
    """Largest absolute value of the components of vectors (n, 3)."""
    greatest = 0.0
    for i in range(vectors.shape[0]):
        for k in range(3):
            greatest = max(greatest, abs(vectors[i, k]))
    return greatest


@njit(**EXACT)
def sum_rounded(vectors: Array, unit: float) -> tuple[float, float, float]:
    """Sums of vectors (n, 3), each component rounded to the last bit of a larger number."""
    x, y, z = 0.0, 0.0, 0.0
    for i in range(vectors.shape[0]):
        x += (vectors[i, 0] + unit) - unit
        y += (vectors[i, 1] + unit) - unit
        z += (vectors[i, 2] + unit) - unit
    return x, y, z


@njit(**EXACT)
def furthest_from(vectors: Array, middle: Array) -> float:
    """Largest distance of vectors (n, 3) from one (3,)."""
    square = 0.0
    for i in range(vectors.shape[0]):
        x, y = vectors[i, 0] - middle[0], vectors[i, 1] - middle[1]
        z = vectors[i, 2] - middle[2]
        square = max(square, x * x + y * y + z * z)
    return math.sqrt(square)


@njit(**EXACT)
def fastest_into_walls(rates: Array, walls: Array) -> float:
    """Largest component of rates (n, 3) towards a wall (w, 4); 0 if all point away."""
    fastest = 0.0
    for i in range(rates.shape[0]):
        for w in range(walls.shape[0]):
            speed = 0.0
            for k in range(3):
                speed -= walls[w, k] * rates[i, k]
            fastest = max(fastest, speed)
    return fastest


@njit(**EXACT)
def deepest_in_walls(position: Array, radius: Array, walls: Array) -> float:
    """Largest depth of a sphere in a wall (w, 4) over its diameter [1]; 0 if none is in one."""
    deepest = 0.0
    for i in range(position.shape[0]):
        for w in range(walls.shape[0]):
            height = -walls[w, 3]
            for k in range(3):
                height += walls[w, k] * position[i, k]
            deepest = max(deepest, 0.5 - height / (2.0 * radius[i]))
    return deepest


@njit(**EXACT)
def mark_impacts(
    position: Array, velocity: Array, radius: Array, mass: Array, moves: Array, walls: Array,
    begin: Whole, other: Whole, marks: Array,
) -> int:  # fmt: skip
    """Mark spheres that `bounce_from_walls` or `bounce` would change first.

    Parameters
    ----------
    position, velocity, radius, mass, moves
        As of `bounce`; of this rank's spheres, then of copies.
    walls : (w, 4) float array, 1 and m
    begin, other : (m + 1,) and (any,) int array
        Pairs of the m spheres of this rank, as of `bounce`.
    marks : (n,) bool array
        Written, where True.

    Returns
    -------
    int
        Number of impacts.
    """
    impacts = 0
    for i in range(begin.shape[0] - 1):
        for w in range(walls.shape[0]):
            height, speed = -walls[w, 3], 0.0
            for k in range(3):
                height += walls[w, k] * position[i, k]
                speed -= walls[w, k] * velocity[i, k]
            if radius[i] - height > 0.0 and speed > 0.0 and moves[i]:
                marks[i] = True
                impacts += 1
        for place in range(begin[i], begin[i + 1]):
            j, reach = other[place], radius[i] + radius[other[place]]
            r, v = difference(position, i, j), difference(velocity, i, j)
            if dot(r, r) < reach * reach and dot(r, v) < 0.0:
                if moves[i] / mass[i] + moves[j] / mass[j] > 0.0:
                    marks[i] = marks[j] = True
                    impacts += 1
    return impacts


@njit(**EXACT)
def list_marked(begin: Whole, other: Whole, marks: Array, first: Whole, second: Whole) -> int:
    """Write pairs (any,) with a marked sphere; return how many there are, also beyond the room."""
    count = 0
    for i in range(begin.shape[0] - 1):
        for place in range(begin[i], begin[i + 1]):
            if marks[i] or marks[other[place]]:
                if count < first.shape[0]:
                    first[count], second[count] = i, other[place]
                count += 1
    return count


@njit(**EXACT)
def bounce_from_walls(
    dt: float, position: Array, velocity: Array, acceleration: Array, radius: Array, mass: Array,
    moves: Array, walls: Array, restitution: float,
) -> tuple[float, int]:  # fmt: skip
    """Turn back spheres that reach into a wall (w, 4) and approach it; arguments as of `bounce`."""
    lost, impacts = 0.0, 0
    for i in range(position.shape[0]):
        for w in range(walls.shape[0]):
            normal = walls[w, 0], walls[w, 1], walls[w, 2]
            height, speed, pull = -walls[w, 3], 0.0, 0.0
            for k in range(3):
                height += walls[w, k] * position[i, k]
                speed -= walls[w, k] * velocity[i, k]
                pull -= walls[w, k] * acceleration[i, k]
            depth = radius[i] - height
            if depth <= 0.0 or speed <= 0.0 or not moves[i]:
                continue
            impacts += 1
            change, shift, loss = impact_on_wall(depth, speed, pull, mass[i], dt, restitution)
            lost += loss
            add_along(velocity, i, change, normal)
            add_along(position, i, shift, normal)
    return lost, impacts


@njit(**EXACT)
def deepest_overlap(position: Array, radius: Array, begin: Whole, other: Whole) -> float:
    """Largest overlap of two spheres over the smaller diameter [1]; 0 if none overlap."""
    deepest = 0.0
    for i in range(position.shape[0]):
        for place in range(begin[i], begin[i + 1]):
            j = other[place]
            r, reach = difference(position, i, j), radius[i] + radius[j]
            square = dot(r, r)
            if square < reach * reach:
                depth = (reach - math.sqrt(square)) / (2.0 * min(radius[i], radius[j]))
                deepest = max(deepest, depth)
    return deepest


@njit(**EXACT)
def bounce(
    dt: float, position: Array, velocity: Array, acceleration: Array, radius: Array, mass: Array,
    moves: Array, begin: Whole, other: Whole, backwards: bool, restitution: float,
) -> tuple[float, int]:  # fmt: skip
    """Give spheres that overlap and approach the impulse of a frictionless impact.

    Parameters
    ----------
    dt : float, s
        Length of the step: contacts are no older.
    position, velocity : (n, 3) float array, m and m/s
        Changed.
    acceleration : (n, 3) float array, m/s2
        In flight.
    radius, mass : (n,) float array, m and kg
    moves : (n,) bool array
        Whether a sphere has been launched; one that has not is as heavy as a wall.
    begin, other : (n + 1,) and (m,) int array
        Spheres that may overlap with each: ``other[begin[i]:begin[i + 1]]``.
    backwards : bool
        Whether the last pair is the first to be looked at.
    restitution : float

    Returns
    -------
    float
        Kinetic energy [J] that was lost.
    int
        Number of impacts.
    """
    lost, impacts, count = 0.0, 0, position.shape[0]
    for row in range(count):
        i = count - 1 - row if backwards else row
        for column in range(begin[i + 1] - begin[i]):
            j = other[begin[i + 1] - 1 - column] if backwards else other[begin[i] + column]
            inverse_i, inverse_j = moves[i] / mass[i], moves[j] / mass[j]
            inverse, reach = inverse_i + inverse_j, radius[i] + radius[j]
            r, v = difference(position, i, j), difference(velocity, i, j)
            if dot(r, r) >= reach * reach or dot(r, v) >= 0.0 or inverse == 0.0:
                continue
            impacts += 1
            a = difference(acceleration, i, j)
            normal, change, shift, loss = impact_of_spheres(r, v, a, reach, dt, restitution)
            lost += loss / inverse
            share_i, share_j = inverse_i / inverse, inverse_j / inverse
            add_along(velocity, i, share_i * change, normal)
            add_along(velocity, j, -share_j * change, normal)
            add_along(position, i, share_i * shift, normal)
            add_along(position, j, -share_j * shift, normal)
    return lost, impacts
