"""Flight of spheres over a step, and impulses where they touch each other or walls.

Flight has symplectic stages, and rotation of fourth order.

An impact is found at the end of a step and given its own time within it: with constant
accelerations the relative motion since then follows, and so do the velocities at contact. An
impulse Δp at a time t before the end of the step changes a velocity by Δp/m and a place by t Δp/m.
What rests on another (its velocity at contact is none) is stopped, and put where it touches.
"""

import math

from numba import njit

from quintet.components.particle_dynamics.spheres.laws import time_since_contact
from quintet.components.shared.numba_options import EXACT
from quintet.components.shared.rotations import rotated
from quintet.components.shared.search.cells import Whole
from quintet.interfaces.component import Array


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
def bounce_from_walls(
    dt: float, position: Array, velocity: Array, acceleration: Array, radius: Array, mass: Array,
    moves: Array, walls: Array, restitution: float,
) -> tuple[float, int]:  # fmt: skip
    """Turn back spheres that reach into a wall and approach it, without friction.

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
        Whether a sphere has been launched.
    walls : (w, 4) float array
        Unit normals and offsets [m].
    restitution : float

    Returns
    -------
    float
        Kinetic energy [J] that was lost.
    int
        Number of impacts.
    """
    lost, impacts = 0.0, 0
    for i in range(position.shape[0]):
        for w in range(walls.shape[0]):
            height, speed, pull = -walls[w, 3], 0.0, 0.0
            for k in range(3):
                height += walls[w, k] * position[i, k]
                speed -= walls[w, k] * velocity[i, k]
                pull -= walls[w, k] * acceleration[i, k]
            depth = radius[i] - height
            if depth <= 0.0 or speed <= 0.0 or not moves[i]:
                continue
            impacts += 1
            square = speed * speed - 2.0 * pull * depth  # (m/s)², at contact
            at_contact = math.sqrt(max(square, 0.0))
            since = 2.0 * depth / (speed + at_contact)
            if square <= 0.0:
                change, shift = speed, min(depth, 0.5 * abs(pull) * dt * dt)
                lost += 0.5 * mass[i] * max(speed * speed - 2.0 * pull * shift, 0.0)
            else:
                if since > dt:  # it has been in the wall since before the step
                    at_contact, since = speed, 0.0
                change = (1.0 + restitution) * at_contact
                shift = change * since
                lost += 0.5 * mass[i] * at_contact**2 * (1.0 - restitution * restitution)
            for k in range(3):
                velocity[i, k] += change * walls[w, k]
                position[i, k] += shift * walls[w, k]
    return lost, impacts


@njit(**EXACT)
def deepest_overlap(position: Array, radius: Array, begin: Whole, other: Whole) -> float:
    """Largest overlap of two spheres over the smaller diameter [1]; 0 if none overlap."""
    deepest = 0.0
    for i in range(position.shape[0]):
        for place in range(begin[i], begin[i + 1]):
            j, square = other[place], 0.0
            for k in range(3):
                square += (position[i, k] - position[j, k]) ** 2
            reach = radius[i] + radius[j]
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
            inverse = moves[i] / mass[i] + moves[j] / mass[j]
            x, y, z = (position[i, 0] - position[j, 0], position[i, 1] - position[j, 1],
                       position[i, 2] - position[j, 2])  # fmt: skip
            u, v, w = (velocity[i, 0] - velocity[j, 0], velocity[i, 1] - velocity[j, 1],
                       velocity[i, 2] - velocity[j, 2])  # fmt: skip
            square, along = x * x + y * y + z * z, x * u + y * v + z * w
            reach = radius[i] + radius[j]
            if square >= reach * reach or along >= 0.0 or inverse == 0.0:
                continue
            impacts += 1
            ax, ay, az = (acceleration[i, 0] - acceleration[j, 0],
                          acceleration[i, 1] - acceleration[j, 1],
                          acceleration[i, 2] - acceleration[j, 2])  # fmt: skip
            t = time_since_contact(x, y, z, u, v, w, ax, ay, az, reach)
            if not 0.0 < t <= dt:  # they have overlapped since before the step
                t = 0.0
            nx, ny, nz = (x - t * (u - 0.5 * t * ax), y - t * (v - 0.5 * t * ay),
                          z - t * (w - 0.5 * t * az))  # fmt: skip
            r = math.sqrt(nx * nx + ny * ny + nz * nz)
            nx, ny, nz = nx / r, ny / r, nz / r
            speed = -(nx * (u - t * ax) + ny * (v - t * ay) + nz * (w - t * az))
            change, shift = (1.0 + restitution) * speed, (1.0 + restitution) * speed * t
            loss = 0.5 * speed * speed * (1.0 - restitution * restitution)
            if speed <= 0.0:  # one rests on the other
                r = math.sqrt(square)
                nx, ny, nz = x / r, y / r, z / r
                pull = -(nx * ax + ny * ay + nz * az)
                change, shift = -along / r, min(reach - r, 0.5 * abs(pull) * dt * dt)
                loss = max(0.5 * change * change - pull * shift, 0.0)
            lost += loss / inverse
            for k in range(3):
                n = nx if k == 0 else ny if k == 1 else nz
                share_i, share_j = moves[i] / mass[i] / inverse, moves[j] / mass[j] / inverse
                velocity[i, k] += share_i * change * n
                velocity[j, k] -= share_j * change * n
                position[i, k] += share_i * shift * n
                position[j, k] -= share_j * shift * n
    return lost, impacts
