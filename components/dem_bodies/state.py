"""All arrays of the bodies: what stays as it was built, what moves, and what touches.

Named tuples, because kernels take each as a whole. A body that is one sphere is called a ball: it
needs neither axes nor a world inertia, and its contacts have a list of their own. What is listed
per body is in rows: balls come first, sorted in space whenever pairs are listed, so that what
touches is near in memory too; then all other bodies; and last the ground, which never moves and
takes up what the planes bear. Only ports know bodies by the numbers that the scene gives them.
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
    """What never changes but for the order of its rows; m bodies and the ground are n = m + 1."""

    inverse_mass: Numbers  # (n,) 1/kg
    inverse_inertia: Numbers  # (n, 6) 1/(kg m2), body axes: xx yy zz xy xz yz
    inverse_turn: Numbers  # (n,) 1/(kg m2), that of balls
    isotropic: NDArray[np.bool_]  # (n,) whether inertia is the same about all axes
    ball: NDArray[np.bool_]  # (n,) whether the body is one sphere
    others: Whole  # (o,) rows of the bodies that are no balls
    half: Numbers  # (n, 3) m, half edges of a box less its rounding; 0 for others
    rounding: Numbers  # (n,) m, of a box's edges; 0 for others
    reach: Numbers  # (m,) m, radius of a sphere about the centre that holds the body
    material: Whole  # (n,) number of the material
    kind: Whole  # (n,) number that bodies of one radius, mass and material share
    sphere_from: Whole  # (n + 1,) spheres of row i: sphere_from[i] ... sphere_from[i + 1] - 1
    sphere_body: Whole  # (s,) row; that of a ball's sphere has its own number
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

    body: Whole  # (n,) body of each row
    row: Whole  # (n,) row of each body
    # Position [m], radius [m]; velocity and angular velocity; both as foreseen at the step's end.
    motion: Numbers  # (n, 16)
    orientation: Numbers  # (n, 4) w x y z, body -> world
    spin: Numbers  # (n, 3) kg m2/s, angular momentum about the centre; of balls not kept up
    contact: Numbers  # (n, 6) N and N m: force and torque of all contacts at the present time
    before: Numbers  # (n, 6) N and N m, that of the last step's beginning, where it is asked for
    load: Numbers  # (n, 6) N and N m, given from outside
    axes: Numbers  # (n, 9) rotation matrices, by rows; of balls not kept up
    mobility: Numbers  # (n, 6) 1/(kg m2), inverse inertia in world axes
    centre: Numbers  # (s, 3) m, of the spheres; of balls kept up only beside other bodies
    listed: Numbers  # (s, 3) m, where they were when pairs were last listed
    report: Numbers  # (11,) on the last step, see below

    @property
    def position(self) -> Numbers:
        """Positions (n, 3) [m]."""
        return self.motion[:, :3]

    @property
    def velocity(self) -> Numbers:
        """Velocities (n, 3) [m/s]."""
        return self.motion[:, V : V + 3]

    @property
    def angular_velocity(self) -> Numbers:
        """Angular velocities (n, 3) [rad/s]."""
        return self.motion[:, W : W + 3]


class Balls(NamedTuple):
    """Pairs of a ball and a ball of a later row, or a plane, that may touch; by the ball's row.

    What a pair does to a row of a later block is kept and gathered afterwards, so that threads
    share out the blocks without meeting, and sums have one order.
    """

    begin: Whole  # (b + 1,) pairs of row a: begin[a] ... begin[a + 1] - 1
    row: Short  # (pairs,)
    partner: Short  # (pairs,) row of the other ball, or n + number of the plane
    law: Short  # (pairs,) row of the constants
    constants: Numbers  # (laws, 7) see laws
    held: Numbers  # (pairs, 4) elastic tangential force on the ball [N], 1/√δ; 0 if apart
    roll: Numbers  # (pairs, 3) N m, elastic moment against rolling; (0, 3) if nothing resists it
    force: Numbers  # (pairs, 3) N, on the ball; (0, 3) if nothing asks for it
    push: Numbers  # (pushes, 6) N and N m, on partners in later blocks, in the order of the pairs
    leave: Whole  # (blocks + 1,) pushes of block b: leave[b] ... leave[b + 1] - 1
    come: Whole  # (n + 1,) those on row a: coming[come[a]] ... coming[come[a + 1] - 1]
    coming: Short  # (pushes,)


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
WHICH = 3  # pair of that, numbered after those of balls; of balls any; -1 if nothing touches
ELASTIC = 4  # J, held by all contacts
WORK = 5  # J, done by contacts on bodies in the step
FASTEST = 6  # m/s, bound of the speed of any point
HARDEST = 7  # m/s2, bound of the acceleration of any point by gravity and load
GIVEN = 8  # J, work of the loads in the step
WAY = 9  # m2, square of the longest way of any sphere since pairs were listed
TOUCHING = 10  # number of contacts that touch, those of balls not counted

# What else a block of rows tallies: squares of the largest speeds and accelerations; force and
# torque on the ground.
MOVING, SPINNING, PULLED, SPUN, CURVED = range(11, 16)
BORNE, TALLIES = 16, 22
BLOCK = 512  # rows
V, W, END_V, END_W, COLUMNS = 4, 7, 10, 13, 16  # of motion: where each begins, and their number


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


def arrange(model: Model, state: State, order: Whole) -> None:
    """Put the rows of the balls in a new order, given by their present rows (b,)."""
    of_model = (
        model.inverse_mass, model.inverse_inertia, model.inverse_turn, model.reach,
        model.material, model.kind, model.sphere_radius,
    )  # fmt: skip
    of_state = (
        state.body, state.motion, state.orientation, state.contact, state.before, state.load,
        state.mobility, state.centre,
    )  # fmt: skip
    for array in of_model + of_state:
        array[: len(order)] = array[order]
    state.row[state.body] = np.arange(len(state.body))
