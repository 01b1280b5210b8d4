"""All arrays of a structure: what stays as it was built, and what moves."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.fe_plate.kernels.blocks import (
    ACTIVE,
    LANES,
    POINT_ROWS,
    SPRING_ENERGY,
    SPRING_ROWS,
)

Array = NDArray[np.float64]
Whole = NDArray[np.int64]


class Model(NamedTuple):
    """What never changes; n nodes, e elements, b blocks of points.

    Each part's elements fill whole blocks: places that are left over repeat its last element and
    load no node.
    """

    corner: Whole  # (places, 8) nodes
    volume: Array  # (b LANES,) m3, of points at the start
    depth: float  # m, along y, of elements in a plane; 0 of solids
    inverse_mass: Array  # (n,) 1/kg, with what hangs on the nodes
    free: Array  # (n, 3) 1 or 0: whether a node moves along an axis
    begin: Whole  # (n + 1,) corners at node i: at[begin[i]] ... at[begin[i + 1] - 1]
    at: Whole  # (8 e,) place among all corners
    gravity: Array  # (3,) m/s2
    walls: Array  # (w, 4) unit normal and offset of rigid walls: normal·x ≥ offset


class Resistance(NamedTuple):
    """What acts on all elements beside their material."""

    hourglass: float  # stiffness of the stabilisation over the element's own
    linear: float  # C₁ of the bulk viscosity
    quadratic: float  # C₀ of it
    damping: float  # s, β of the stiffness damping


class State(NamedTuple):
    """What moves. Rows of points and springs, and their units, stand in `kernels.blocks`."""

    position: Array  # (n, 3) m
    velocity: Array  # (n, 3) m/s
    mean_velocity: Array  # (n, 3) m/s, displacement of the last step over it
    internal: Array  # (n, 3) N, force of the elements on the nodes
    load: Array  # (n, 3) N, from outside
    points: Array  # (b, POINT_ROWS, LANES), stresses and all that belongs to the material
    springs: Array  # (b or 0, SPRING_ROWS, LANES), of the hourglass patterns
    corner_force: Array  # (places, 8, 3) N, of elements on their corners
    wall_impulse: Array  # (w,) N s, on each rigid wall so far


def state_at_rest(nodes: Array, blocks: int, springs: int, places: int, walls: int) -> State:
    """State at rest at nodes (n, 3) m."""
    still = np.zeros_like(nodes)
    points = np.zeros((blocks, POINT_ROWS, LANES))
    points[:, ACTIVE] = 1.0
    return State(
        position=nodes.copy(),
        velocity=still.copy(),
        mean_velocity=still.copy(),
        internal=still.copy(),
        load=still.copy(),
        points=points,
        springs=np.zeros((springs, SPRING_ROWS, LANES)),
        corner_force=np.zeros((places, 8, 3)),
        wall_impulse=np.zeros(walls),
    )


class Places(NamedTuple):
    """Where each element's points stand among all points."""

    point: Whole  # (e, q), of each of its q points
    share: Array  # (e, q) 1, of the element's mass

    def of(self, state: State, row: int) -> Array:
        """Mean of a row over the points of each element (e,)."""
        return np.asarray((state.points[:, row].ravel()[self.point] * self.share).sum(axis=1))

    def rows(self, state: State, first: int, count: int) -> Array:
        """Means of some rows over the points of each element (count, e)."""
        return np.stack([self.of(state, first + k) for k in range(count)])

    def active(self, state: State) -> Array:
        """1 of each element that is left, 0 of an eroded one (e,): any of its points failed."""
        return np.asarray(state.points[:, ACTIVE].ravel()[self.point].min(axis=1))

    def spring_energy(self, state: State) -> Array:
        """Energy (e,) J of the springs of each element."""
        if not len(state.springs):  # eight points need none
            return np.zeros(len(self.point))
        return np.asarray(state.springs[:, SPRING_ENERGY].ravel()[self.point[:, 0]])
