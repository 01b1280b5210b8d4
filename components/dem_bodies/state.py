"""All arrays of the bodies: what stays as it was built, what moves, and what touches.

Named tuples, because kernels take each as a whole. The last row of what is listed per body is
the ground: it never moves, and takes up what the planes bear.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]
Whole = NDArray[np.int64]

PLANE, SPHERE, BOX, EDGE = range(4)  # kinds of contact: of a sphere with ..., of two edges
KIND, FIRST = 60, 30  # bits of a pair's key: kind, first, second; sorted keys keep kinds together


class Model(NamedTuple):
    """What never changes; m bodies and the ground make n = m + 1 rows."""

    inverse_mass: Numbers  # (n,) 1/kg
    inverse_inertia: Numbers  # (n, 6) 1/(kg m2), body axes: xx yy zz xy xz yz
    isotropic: NDArray[np.bool_]  # (n,) whether inertia is the same about all axes
    half: Numbers  # (n, 3) m, half edges of a box less its rounding; 0 for others
    rounding: Numbers  # (n,) m, of a box's edges; 0 for others
    reach: Numbers  # (m,) m, radius of a sphere about the centre that holds the body
    material: Whole  # (n,) number of the material
    sphere_from: Whole  # (n + 1,) spheres of body i: sphere_from[i] ... sphere_from[i + 1] - 1
    sphere_body: Whole  # (s,)
    sphere_centre: Numbers  # (s, 3) m, body axes
    sphere_radius: Numbers  # (s,) m
    edge_from: Whole  # (n + 1,) as sphere_from, of edges
    edge_ends: Whole  # (e, 2) spheres at the ends of each edge
    plane: Numbers  # (p, 4) unit normal and offset: normal·x = offset
    plane_material: Whole  # (p,)
    law: Numbers  # (materials, materials, 4) E* Pa, G* Pa, ζ, μ
    gravity: Numbers  # (3,) m/s2


class State(NamedTuple):
    """What moves."""

    position: Numbers  # (n, 3) m
    velocity: Numbers  # (n, 3) m/s
    orientation: Numbers  # (n, 4) w x y z, body -> world
    spin: Numbers  # (n, 3) kg m2/s, angular momentum about the centre
    angular_velocity: Numbers  # (n, 3) rad/s
    contact: Numbers  # (n, 6) N and N m: force and torque of all contacts at the present time
    before: Numbers  # (n, 6) the same at the beginning of the step
    load: Numbers  # (n, 6) N and N m, given from outside
    axes: Numbers  # (n, 9) rotation matrices, by rows
    mobility: Numbers  # (n, 6) 1/(kg m2), inverse inertia in world axes
    rates: Numbers  # (n, 12) velocity, angular velocity: mean of the step, and foreseen at its end
    centre: Numbers  # (s, 3) m, of the spheres
    listed: Numbers  # (s, 3) m, where they were when pairs were last listed
    report: Numbers  # (10,) on the last step, see below


class Contacts(NamedTuple):
    """Pairs that may touch before they are listed anew, and those that do."""

    key: Whole  # (pairs,) sorted
    begin: Whole  # (5,) where each kind begins
    ends: Whole  # (pairs, 2) sphere and plane, two spheres, sphere and body, or two edges
    # Elastic tangential force [N] 3; depth [m] at the last step; depth [m] that bears nothing,
    # because the pair was already that deep when it came into being.
    history: Numbers  # (pairs, 5)
    touching: Whole  # (pairs, 4) pair, body, body, law
    geometry: Numbers  # (pairs, 8) normal, point [m], depth [m], R* [m]


# What stands in the report.
GAP = 0  # m, smallest distance of any pair
STIFFEST = 1  # (rad/s)2, largest S_n/m* of any contact
DEEPEST = 2  # largest depth over contact radius
WHICH = 3  # pair of that
ELASTIC = 4  # J, held by all contacts
WORK = 5  # J, done by contacts on bodies in the step
FASTEST = 6  # m/s, bound of the speed of any point
HARDEST = 7  # m/s2, bound of the acceleration of any point by gravity and load
GIVEN = 8  # J, work of the loads in the step
WAY = 9  # m2, square of the longest way of any sphere since pairs were listed


def empty_contacts(pairs: int) -> Contacts:
    """Make room for a number of pairs without history."""
    return Contacts(
        key=np.zeros(pairs, np.int64),
        begin=np.zeros(5, np.int64),
        ends=np.zeros((pairs, 2), np.int64),
        history=np.zeros((pairs, 5)),
        touching=np.zeros((pairs, 4), np.int64),
        geometry=np.zeros((pairs, 8)),
    )
