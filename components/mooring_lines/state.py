"""What changes of mooring lines: the motion of the bodies they hold, and their pull."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

BELOW = 1e-6  # of a line's length, by which its fairlead may be below the bed


class Lines(NamedTuple):
    """What never changes, of k lines."""

    anchor: Array  # (k, 3) m
    body: NDArray[np.int64]  # (k,)
    length: Array  # (k,) m
    stiffness: Array  # (k,) N
    weight: Array  # (k,) N/m
    has_bed: NDArray[np.bool_]  # (k,)


class State(NamedTuple):
    """All that is remembered, of k lines and b bodies."""

    fairlead: Array  # (k, 3) m, as the run began, in the world
    arm: Array  # (k, 3) m, from a body's centre of mass to the fairlead, in the axes of the body
    position: Array  # (b, 3) m, of centres of mass in the middle of the last step
    velocity: Array  # (b, 3) m/s
    orientation: Array  # (b, 4) 1, w x y z
    angular_velocity: Array  # (b, 3) rad/s
    load: Array  # (b, 6) N, N m, mean force and torque of the last step
    pull: Array  # (k, 2) N, H and V, last computed: where the next search begins
    clock: Array  # (2,) s, time and length of the last step
