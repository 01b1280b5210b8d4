"""All arrays of the bodies: what stays as it was built, what moves, and what touches.

Named tuples, because kernels take each as a whole. The last row of what is listed per body is
the ground: it never moves, and takes up what the planes bear. A body that is one sphere is called
a ball: it needs neither axes nor a world inertia, and its contacts have a list of their own.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]
Whole = NDArray[np.int64]
Short = NDArray[np.uint32]

PLANE, SPHERE, BOX, EDGE = range(4)  # kinds of contact: of a sphere with ..., of two edges
KIND, FIRST = 60, 30  # bits of a pair's key: kind, first, second; sorted keys keep kinds together


class Model(NamedTuple):
    """What never changes; m bodies and the ground make n = m + 1 rows."""

    inverse_mass: Numbers  # (n,) 1/kg
    inverse_inertia: Numbers  # (n, 6) 1/(kg m2), body axes: xx yy zz xy xz yz
    inverse_turn: Numbers  # (n,) 1/(kg m2), that of balls
    isotropic: NDArray[np.bool_]  # (n,) whether inertia is the same about all axes
    ball: NDArray[np.bool_]  # (n,) whether the body is one sphere
    others: Whole  # (o,) bodies that are no balls
    half: Numbers  # (n, 3) m, half edges of a box less its rounding; 0 for others
    rounding: Numbers  # (n,) m, of a box's edges; 0 for others
    reach: Numbers  # (m,) m, radius of a sphere about the centre that holds the body
    material: Whole  # (n,) number of the material
    kind: Whole  # (n,) number that bodies of one radius, mass and material share
    sphere_from: Whole  # (n + 1,) spheres of body i: sphere_from[i] ... sphere_from[i + 1] - 1
    sphere_body: Whole  # (s,)
    sphere_centre: Numbers  # (s, 3) m, body axes
    sphere_radius: Numbers  # (s,) m
    edge_from: Whole  # (n + 1,) as sphere_from, of edges
    edge_ends: Whole  # (e, 2) spheres at the ends of each edge
    plane: Numbers  # (p, 4) unit normal and offset: normal·x = offset
    plane_material: Whole  # (p,)
    law: Numbers  # (materials, materials, 5) E* Pa, G* Pa, ζ, μ, μ_r
    fall: Numbers  # (1, 3) m/s2, gravity


class State(NamedTuple):
    """What moves."""

    position: Numbers  # (n, 3) m
    velocity: Numbers  # (n, 3) m/s
    orientation: Numbers  # (n, 4) w x y z, body -> world
    spin: Numbers  # (n, 3) kg m2/s, angular momentum about the centre
    angular_velocity: Numbers  # (n, 3) rad/s
    contact: Numbers  # (n, 6) N and N m: force and torque of all contacts at the present time
    load: Numbers  # (n, 6) N and N m, given from outside
    axes: Numbers  # (n, 9) rotation matrices, by rows; of balls not kept up
    mobility: Numbers  # (n, 6) 1/(kg m2), inverse inertia in world axes
    centre: Numbers  # (s, 3) m, of the spheres; of balls kept up only beside other bodies
    listed: Numbers  # (s, 3) m, where they were when pairs were last listed
    report: Numbers  # (11,) on the last step, see below


class Scratch(NamedTuple):
    """What kernels hand to one another within a step, by rows: balls sorted in space come first."""

    body: Short  # (n,) body of each row; those that are no balls come last, and then the ground
    row: Short  # (n,) row of each body
    # Position [m], radius [m]; velocity and angular velocity: the step's mean, foreseen at its end.
    motion: Numbers  # (n, 16)
    sums: Numbers  # (n, 6) N and N m, contact forces that rows' own pairs brought them
    tally: Numbers  # (blocks, TALLIES) what a block of rows adds to the report


class Balls(NamedTuple):
    """Pairs of a ball and a ball of a later row, or a plane, that may touch; by the ball's row.

    What a pair does to its later row is kept beside it and gathered afterwards, so that threads
    share out the rows without meeting, and sums have one order.
    """

    begin: Whole  # (b + 1,) pairs of row a: begin[a] ... begin[a + 1] - 1
    row: Short  # (pairs,)
    partner: Short  # (pairs,) row of the other ball, or n + number of the plane
    law: Short  # (pairs,) row of the constants
    constants: Numbers  # (laws, 7) see laws
    held: Numbers  # (pairs, 4) elastic tangential force on the ball [N], 1/√δ; 0 if apart
    roll: Numbers  # (pairs, 3) N m, elastic moment against rolling; (0, 3) if nothing resists it
    push: Numbers  # (pairs, 6) N and N m, force and torque on the partner
    come: (
        Whole  # (n + 1,) pairs whose partner is row a: coming[come[a]] ... coming[come[a + 1] - 1]
    )
    coming: Short  # (pairs,)


class Contacts(NamedTuple):
    """All other pairs that may touch before they are listed anew, and those that do."""

    key: Whole  # (pairs,) sorted
    begin: Whole  # (5,) where each kind begins
    ends: Whole  # (pairs, 2) sphere and plane, two spheres, sphere and body, or two edges
    # Elastic tangential force [N] 3; depth [m] at the last step; depth [m] that bears nothing,
    # because the pair was already that deep when it came into being.
    history: Numbers  # (pairs, 5)
    touching: Whole  # (pairs, 4) pair, body, body, law
    geometry: Numbers  # (pairs, 11) normal, point [m], depth [m], R* [m], force [N]


# What stands in the report.
GAP = 0  # m, smallest distance of any pair
STIFFEST = 1  # (rad/s)2, largest S_n/m* of any contact
DEEPEST = 2  # largest depth over contact radius
WHICH = 3  # pair of that: of the balls, or after them of the other contacts
ELASTIC = 4  # J, held by all contacts
WORK = 5  # J, done by contacts on bodies in the step
FASTEST = 6  # m/s, bound of the speed of any point
HARDEST = 7  # m/s2, bound of the acceleration of any point by gravity and load
GIVEN = 8  # J, work of the loads in the step
WAY = 9  # m2, square of the longest way of any sphere since pairs were listed
TOUCHING = 10  # number of contacts that touch, those of balls not counted

# What else a block tallies: squares of the largest speeds and accelerations.
MOVING, SPINNING, PULLED, SPUN, CURVED = range(11, 16)
TALLIES = 16
BLOCK = 512  # rows


def blocks_of(rows: int) -> int:
    """Number of blocks; it must not depend on the threads, for each block's sums are rounded."""
    return -(-rows // BLOCK)


def empty_contacts(pairs: int) -> Contacts:
    """Make room for a number of pairs without history."""
    return Contacts(
        key=np.zeros(pairs, np.int64),
        begin=np.zeros(5, np.int64),
        ends=np.zeros((pairs, 2), np.int64),
        history=np.zeros((pairs, 5)),
        touching=np.zeros((pairs, 4), np.int64),
        geometry=np.zeros((pairs, 11)),
    )


def empty_scratch(model: Model) -> Scratch:
    """Rows in the order of the bodies, balls first."""
    n = len(model.ball)
    body = np.concatenate([np.flatnonzero(model.ball), model.others, [n - 1]]).astype(np.uint32)
    return Scratch(
        body=body,
        row=np.argsort(body).astype(np.uint32),
        motion=np.zeros((n, 16)),
        sums=np.zeros((n, 6)),
        tally=np.zeros((blocks_of(n), TALLIES)),
    )
