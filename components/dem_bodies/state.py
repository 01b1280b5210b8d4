"""All arrays of the bodies: what stays as it was built, what moves, and what touches.

Named tuples, because kernels take each as a whole. A body that is one sphere is called a ball: it
needs neither axes nor a world inertia, and its contacts have a list of their own. What is listed
per body is in rows: balls come first, sorted in space whenever pairs are listed, so that what
touches is near in memory too; then all other bodies; and last the ground, which never moves and
takes up the forces on the planes. Only ports know bodies by the numbers that the scene gives them.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]
Whole = NDArray[np.int64]
Short = NDArray[np.uint32]

# Kinds of contact: of a sphere with a plane, a sphere, a box or polygon; of two edges.
SPHERE_PLANE, SPHERE_SPHERE, SPHERE_BOX, EDGE_EDGE = range(4)
KIND, FIRST = 60, 30  # bits of a pair's key: kind, first, second; sorted keys keep kinds together


class Model(NamedTuple):
    """What never changes but for the order of its rows; m bodies and the ground are n = m + 1."""

    inverse_mass: Numbers  # (n,) 1/kg
    inverse_inertia: Numbers  # (n, 6) 1/(kg m2), body axes: xx yy zz xy xz yz
    inertia: Numbers  # (n, 6) kg m2, body axes, likewise
    inverse_moment: Numbers  # (n,) 1/(kg m2), that of balls about any axis
    isotropic: NDArray[np.bool_]  # (n,) whether inertia is the same about all axes
    ball: NDArray[np.bool_]  # (n,) whether the body is one sphere
    free: Numbers  # (n, 6) 1 or 0: translation along, rotation about x, y, z; 0 where locked
    locked: NDArray[np.bool_]  # (n,) whether any of these is
    others: Whole  # (o,) rows of the bodies that are no balls
    half_extent: Numbers  # (n, 3) m, half edges of a box less its edge radius; 0 for others
    edge_radius: Numbers  # (n,) m, of a box or polygon; 0 for others
    body_contact_radius: Numbers  # (n,) m, of edges and faces in contact; 0 for others
    half_thickness: Numbers  # (n,) m, half the least width of a box or polygon; ∞ for others
    sharp: NDArray[np.bool_]  # (n,) whether contacts may be deeper than its edges are round
    polygon: NDArray[np.bool_]  # (n,) whether the body is a polygon, whose spheres are its corners
    bounding_radius: Numbers  # (m,) m, radius of a sphere about the centre that holds the body
    material: Whole  # (n,) number of the material
    kind: Whole  # (n,) number that bodies of one radius, mass and material share
    sphere_begin: Whole  # (n + 1,) spheres of row i: sphere_begin[i] ... sphere_begin[i + 1] - 1
    sphere_row: Whole  # (s,) row; that of a ball's sphere has its own number
    sphere_centre: Numbers  # (s, 3) m, body axes
    sphere_radius: Numbers  # (s,) m
    contact_radius: Numbers  # (s,) m, of contacts: the same, larger at sharp corners
    edge_begin: Whole  # (n + 1,) as sphere_begin, of edges
    edge_ends: Whole  # (e, 2) spheres at the ends of each edge
    plane: Numbers  # (p, 4) unit normal and offset: normal·x = offset
    plane_material: Whole  # (p,)
    material_pairs: Numbers  # (materials, materials, 5) E* Pa, G* Pa, ζ, μ, μ_r
    gravity: Numbers  # (3,) m/s2


class State(NamedTuple):
    """What moves."""

    body: Whole  # (n,) body of each row
    row: Whole  # (n,) row of each body
    # Position [m], radius [m]; velocity and angular velocity; both as predicted for the step's end.
    motion: Numbers  # (n, 16)
    orientation: Numbers  # (n, 4) w x y z, body -> world
    angular_momentum: Numbers  # (n, 3) kg m2/s, about the centre; of balls not kept up
    contact_load: Numbers  # (n, 6) N and N m: force and torque of all contacts at the present time
    previous_contact_load: Numbers  # (n, 6) N and N m, at the last step's beginning, if recorded
    load: Numbers  # (n, 6) N and N m, given from outside
    axes: Numbers  # (n, 9) rotation matrices, by rows; of balls not kept up
    world_inverse_inertia: Numbers  # (n, 6) 1/(kg m2), in world axes
    centre: Numbers  # (s, 3) m, of the spheres; of balls kept up only beside other bodies
    listed_centre: Numbers  # (s, 3) m, where they were when pairs were last listed
    report: Numbers  # (11,) on the last step, see below

    @property
    def position(self) -> Numbers:
        """Positions (n, 3) [m]."""
        return self.motion[:, :3]

    @property
    def velocity(self) -> Numbers:
        """Velocities (n, 3) [m/s]."""
        return self.motion[:, VELOCITY : VELOCITY + 3]

    @property
    def angular_velocity(self) -> Numbers:
        """Angular velocities (n, 3) [rad/s]."""
        return self.motion[:, OMEGA : OMEGA + 3]


class BallPairs(NamedTuple):
    """Pairs of a ball and a ball of a later row, or a plane, that may touch; by the ball's row.

    The load of a pair on a row of a later block is kept and added afterwards, so that threads
    share out the blocks without meeting, and sums have one order.
    """

    begin: Whole  # (b + 1,) pairs of row a: begin[a] ... begin[a + 1] - 1
    row: Short  # (pairs,)
    partner: Short  # (pairs,) row of the other ball, or n + number of the plane
    constants_row: Short  # (pairs,)
    constants: Numbers  # (kinds of pairs, 7) see laws
    history: Numbers  # (4, pairs) elastic tangential force on the ball [N], 1/√δ; 0 without contact
    rolling_moment: Numbers | None  # (pairs, 3) N m, elastic, on the ball; None if none resists
    force: Numbers  # (pairs, 3) N, on the ball; (0, 3) if not recorded
    outgoing: Numbers  # (sent, 6) N and N m, on partners in later blocks, in the order of the pairs
    outgoing_begin: Whole  # (blocks + 1,) block b sends outgoing_begin[b] ... [b + 1] - 1
    incoming_begin: Whole  # (n + 1,) row a gets those in incoming[incoming_begin[a] : ... [a + 1]]
    incoming: Short  # (sent,) rows of outgoing
    earliest: Whole  # (blocks,) first block that sends to this one, or itself


class BodyPairs(NamedTuple):
    """All other pairs that may touch before the next listing, and those that do."""

    key: Whole  # (pairs,) sorted
    begin: Whole  # (5,) where each kind begins
    ends: Whole  # (pairs, 2) sphere and plane, two spheres, sphere and body, or two edges
    # Elastic tangential force [N] 3; depth [m] at the last step; depth [m] without load,
    # because the pair was already that deep when it came into being.
    history: Numbers  # (pairs, 5)
    touching: Whole  # (pairs, 4) pair, body, body, pair of materials
    geometry: Numbers  # (pairs, 11) normal, point [m], depth [m], R* [m], force [N]


GONE = -1e15  # m, offset of a plane that has vanished: everything is far above it

# Columns of motion.
RADIUS, VELOCITY, OMEGA, END_VELOCITY, END_OMEGA, COLUMNS = 3, 4, 7, 10, 13, 16
# Arrays of `State` that go with a row that moves to another rank, with their widths.
MOVED = {
    "motion": COLUMNS, "orientation": 4, "contact_load": 6, "previous_contact_load": 6, "load": 6,
    "world_inverse_inertia": 6,
}  # fmt: skip

# What stands in the report, and in the sums of each block of rows.
SMALLEST_GAP = 0  # m, of any pair
STIFFEST = 1  # (rad/s)2, largest S_n/m* of any contact
DEEPEST = 2  # largest depth over contact radius
DEEPEST_PAIR = 3  # numbered after those of balls; of balls any; -1 if nothing touches
ELASTIC_ENERGY = 4  # J, of all contacts
CONTACT_WORK = 5  # J, done by contacts on bodies in the step
LARGEST_SPEED = 6  # m/s, bound of the speed of any point
LARGEST_ACCELERATION = 7  # m/s2, bound for any point, by gravity and load
LOAD_WORK = 8  # J, done by loads in the step
TRAVEL = 9  # m2, square of the largest displacement of any sphere since pairs were listed
TOUCHING = 10  # number of contacts that touch, those of balls not counted
REPORTED = 11

# What stands only in the sums of a block: squares of the largest velocity, of that of points due
# to rotation, of acceleration by loads and of that due to rotation; the largest ω² r; and the
# force and torque on the ground.
VELOCITY2, ROTATION2, ACCELERATION2, SPIN_UP2, CENTRIPETAL = range(11, 16)
GROUND_LOAD, SUMS = 16, 22
BLOCK = 512  # rows


def blocks_of(rows: int) -> int:
    """Number of blocks; it must not depend on the threads, for each block's sums are rounded."""
    return -(-rows // BLOCK)


def body_pairs(pairs: int) -> BodyPairs:
    """Make room for a number of pairs without history."""
    return BodyPairs(
        key=np.zeros(pairs, np.int64),
        begin=np.zeros(5, np.int64),
        ends=np.zeros((pairs, 2), np.int64),
        history=np.zeros((pairs, 5)),
        touching=np.zeros((pairs, 4), np.int64),
        geometry=np.zeros((pairs, 11)),
    )


def sort_rows(model: Model, state: State, order: Whole) -> None:
    """Put the rows of the balls in a new order, given by their present rows (b,)."""
    if np.array_equal(order, np.arange(len(order))):
        return
    of_model = (
        model.inverse_mass, model.inverse_inertia, model.inverse_moment, model.bounding_radius,
        model.material, model.kind, model.sphere_radius,
    )  # fmt: skip
    of_state = (
        state.body, state.motion, state.orientation, state.contact_load,
        state.previous_contact_load, state.load, state.world_inverse_inertia, state.centre,
    )  # fmt: skip
    for array in of_model + of_state:
        array[: len(order)] = array[order]
    state.row[state.body] = np.arange(len(state.body))
