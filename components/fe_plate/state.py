"""All arrays of a structure: what stays as it was built, and what moves."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Whole = NDArray[np.int64]


class Model(NamedTuple):
    """What never changes; n nodes, e elements, with rows of elements padded to whole blocks."""

    corner: Whole  # (e, 8) nodes
    volume: Array  # (e,) m3, at the start
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
    """What moves. Of elements one number stands beside the next element's, for vectors."""

    position: Array  # (n, 3) m
    velocity: Array  # (n, 3) m/s
    mean_velocity: Array  # (n, 3) m/s, displacement of the last step over it
    internal: Array  # (n, 3) N, force of the elements on the nodes
    load: Array  # (n, 3) N, from outside
    deviator: Array  # (6, e) Pa, xx yy zz xy yz zx
    pressure: Array  # (e,) Pa
    viscous: Array  # (e,) Pa, of the bulk viscosity
    energy: Array  # (e,) J/kg
    strain: Array  # (e,) plastic
    temperature: Array  # (e,) K
    damage: Array  # (e,)
    active: Array  # (e,) 1, 0 once it is eroded
    hourglass: Array  # (12, e) N, of four patterns along three axes
    hourglass_energy: Array  # (e,) J
    corner_force: Array  # (e, 8, 3) N, of elements on their corners
    wall_impulse: Array  # (w,) N s, on each rigid wall so far


def state_at_rest(nodes: Array, elements: int, walls: int) -> State:
    """State at rest at nodes (n, 3) m."""
    still = np.zeros_like(nodes)
    numbers = {name: np.zeros(elements) for name in ("pressure", "viscous", "energy", "strain")}
    return State(
        position=nodes.copy(),
        velocity=still.copy(),
        mean_velocity=still.copy(),
        internal=still.copy(),
        load=still.copy(),
        deviator=np.zeros((6, elements)),
        **numbers,
        temperature=np.zeros(elements),
        damage=np.zeros(elements),
        active=np.ones(elements),
        hourglass=np.zeros((12, elements)),
        hourglass_energy=np.zeros(elements),
        corner_force=np.zeros((elements, 8, 3)),
        wall_impulse=np.zeros(walls),
    )
