"""All arrays of a structure: what stays as it was built, and what moves."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Whole = NDArray[np.int64]
Index = NDArray[np.uint32]  # half the bytes of others, and no number from the end
Flags = NDArray[np.uint8]  # 1 or 0

LANES = 16  # points of a block, which kernels advance side by side
# Rows of the state at quadrature points.
DEVIATOR = 0  # to 5: xx yy zz xy yz zx, Pa
PRESSURE, VISCOUS = 6, 7  # Pa; that of the bulk viscosity
ENERGY, STRAIN, TEMPERATURE, DAMAGE = 8, 9, 10, 11  # J/kg; plastic; K; 1
ACTIVE = 12  # 1, and 0 once it has failed
DILATION = 13  # of eight points: how much its volume has grown beyond that of its element
POINT_ROWS = 14
# Rows of the springs that hold the hourglass patterns of elements with one point.
SPRING, SPRING_ENERGY = 0, 12  # 12 rows N, J
SPRING_ROWS = 13
# Of tetrahedra with ten nodes: of the element's mass at each node.
NODE_SHARES = np.array([1.0 / 36.0] * 4 + [4.0 / 27.0] * 6)
FEW = 0.25  # of all points: their numbers are taken one by one, without a copy of the whole row


class Model(NamedTuple):
    """What never changes; n nodes, e elements, b blocks of points.

    Each part's elements fill whole blocks: unused places repeat its last element and
    load no node.
    """

    corner: Index  # (places, c) nodes, c = 8 of hexahedra and 10 of tetrahedra
    target: Index  # (places or more, c) rows of forces: these corners, then others' rows
    acts: Index  # (b,) first row in `target` of what a block's corners act on
    filled: Index  # (b,) places of a block that are used
    volume: Array  # (b LANES,) m3, of points at the start
    depth: float  # m, along y, of elements in a plane; 0 of solids
    inverse_mass: Array  # (n,) 1/kg, with what hangs on the nodes
    free: Flags  # (n, 3) whether a node moves along an axis
    gravity: Array  # (3,) m/s2
    walls: Array  # (w, 4) unit normal and offset of rigid walls: normal·x ≥ offset
    moving: int  # nodes that this rank moves, the first ones; others are copies


class Parted(NamedTuple):
    """Nodes whose elements are shared out among threads: each of their corners has its own row."""

    node: Whole  # (p,)
    begin: Whole  # (p + 1,) rows of forces at node[i]: begin[i] ... begin[i + 1] - 1


class Span(NamedTuple):
    """Blocks of one part that stand one after another."""

    part: int
    first: int
    last: int  # and one


class Resistance(NamedTuple):
    """What acts on all elements beside their material."""

    hourglass: float  # stiffness of the stabilisation over the element's own
    linear: float  # C₁ of the bulk viscosity
    quadratic: float  # C₀ of it
    damping: float  # s, β of the stiffness damping


class State(NamedTuple):
    """What moves. Rows of points and springs, and their units, stand above."""

    position: Array  # (n, 3) m
    velocity: Array  # (n, 3) m/s
    mean_velocity: Array  # (n, 3) m/s, displacement of the last step over it
    forces: Array  # (rows, 3) N, of the elements: on the nodes, then on corners by themselves
    load: Array  # (n, 3) N, from outside
    points: Array  # (b, POINT_ROWS, LANES), stresses and all that belongs to the material
    springs: Array  # (b or 0, SPRING_ROWS, LANES), of the hourglass patterns
    load_work: Array  # (n,) J, of the loads so far
    partner_work: Array  # (n or 0,) J, of it that of partners' loads, where pressures act too
    damped: Array  # (n or 0,) J, that mass damping took so far
    wall_impulse: Array  # (n or 0, w) N s, on each rigid wall so far
    wall_work: Array  # (n or 0,) J, of rigid walls so far

    @property
    def internal(self) -> Array:
        """Force [N] of the elements on the nodes (n, 3)."""
        return self.forces[: len(self.position)]

    def to_save(self) -> dict[str, Array]:
        """All that moves; of the forces those on nodes: the others are none between steps."""
        return {**self._asdict(), "forces": self.internal}

    def works(self, nodes: int) -> list[Array]:
        """Works (nodes or 0,) J on the first nodes: of loads, of walls, of damping (negative)."""
        return [self.load_work[:nodes], self.wall_work[:nodes], -self.damped[:nodes]]


@dataclass(slots=True)
class Accumulated:
    """Sums over a run."""

    time: float = 0.0  # s
    brought: float = 0.0  # J, of motion that added mass brought
    steps: int = 0


class Sizes(NamedTuple):
    """Rows of what not every structure has; 0 if it is absent."""

    springs: int  # blocks with springs
    forces: int  # rows of forces, on nodes and on corners
    walls: int  # rigid walls
    pressed: int  # nodes, where pressures act
    damped: int  # nodes, with mass damping


def state_at_rest(nodes: Array, blocks: int, sizes: Sizes) -> State:
    """State at rest at nodes (n, 3) m, with some blocks of points."""
    still = np.zeros_like(nodes)
    walled = len(nodes) if sizes.walls else 0
    points = np.zeros((blocks, POINT_ROWS, LANES))
    points[:, ACTIVE] = 1.0
    return State(
        position=nodes.copy(),
        velocity=still.copy(),
        mean_velocity=still.copy(),
        forces=np.zeros((sizes.forces, 3)),
        load=still.copy(),
        points=points,
        springs=np.zeros((sizes.springs, SPRING_ROWS, LANES)),
        load_work=np.zeros(len(nodes)),
        partner_work=np.zeros(sizes.pressed),
        damped=np.zeros(sizes.damped),
        wall_impulse=np.zeros((walled, sizes.walls)),
        wall_work=np.zeros(walled),
    )


def node_shares(nodes: int) -> Array:
    """Shares (nodes,) of an element's mass at its nodes: equal ones, but of ten nodes."""
    return NODE_SHARES if nodes == len(NODE_SHARES) else np.full(nodes, 1.0 / nodes)


class Places(NamedTuple):
    """Where each element's points stand among all points."""

    point: Whole  # (e, q), of each of its q points
    share: Array  # (e, q) 1, of the element's mass

    def subset(self, elements: Whole | slice) -> "Places":
        """Those of some elements, by their rows here."""
        return Places(self.point[elements], self.share[elements])

    def of(self, state: State, row: int) -> Array:
        """Mean of a row over the points of each element (e,)."""
        return np.asarray((at_points(state.points, row, self.point) * self.share).sum(axis=1))

    def rows(self, state: State, first: int, count: int) -> Array:
        """Means of some rows over the points of each element (count, e)."""
        return np.stack([self.of(state, first + k) for k in range(count)])

    def active(self, state: State) -> Array:
        """1 of each element that is left, 0 of an eroded one (e,): any of its points failed."""
        return np.asarray(at_points(state.points, ACTIVE, self.point).min(axis=1))

    def spring_energy(self, state: State) -> Array:
        """Energy (e,) J of the springs of each element."""
        if not len(state.springs):  # eight points need none
            return np.zeros(len(self.point))
        return at_points(state.springs, SPRING_ENERGY, self.point[:, 0])


def at_points(blocks: Array, row: int, point: Whole) -> Array:
    """Numbers of a row of blocks (b, rows, LANES) at some of their points, of any shape."""
    if point.size > FEW * len(blocks) * LANES:
        return np.asarray(blocks[:, row].ravel()[point])
    before = point // LANES * ((blocks.shape[1] - 1) * LANES)  # numbers of other rows
    return blocks.reshape(-1).take(before + (point + row * LANES))


def first_rows(array: Array, count: int) -> Array:
    """First rows (count, ...) of an array; rows beyond its end are 0."""
    rows = np.zeros((count, *array.shape[1:]))
    rows[: len(array)] = array[:count]
    return rows
