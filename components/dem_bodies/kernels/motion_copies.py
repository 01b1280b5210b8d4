"""Copies of the motion of bodies, in the scene's order, and in rows for another rank."""

from numba import njit

from quintet.components.dem_bodies.kernels.geometry import row_vector, set_row_vector
from quintet.components.dem_bodies.state import OMEGA, VELOCITY, Numbers, Whole
from quintet.components.shared.numba_options import EXACT

PACKED = 13  # numbers of a row: position, velocity, orientation, angular velocity


@njit(**EXACT)
def copy_motion(
    row: Whole, motion: Numbers, orientations: Numbers, position: Numbers, velocity: Numbers,
    orientation: Numbers, angular_velocities: Numbers,
) -> None:  # fmt: skip
    """Copy out the motion of all bodies, in the scene's order."""
    for k in range(position.shape[0]):
        i = row[k]
        set_row_vector(position, k, 0, row_vector(motion, i))
        set_row_vector(velocity, k, 0, row_vector(motion, i, VELOCITY))
        set_row_vector(angular_velocities, k, 0, row_vector(motion, i, OMEGA))
        for d in range(4):
            orientation[k, d] = orientations[i, d]


@njit(**EXACT)
def pack_motion(first: int, motion: Numbers, orientations: Numbers, packed: Numbers) -> None:
    """Write the motion of the rows from `first` on side by side, (k, PACKED)."""
    for k in range(packed.shape[0]):
        i = first + k
        set_row_vector(packed, k, 0, row_vector(motion, i))
        set_row_vector(packed, k, 3, row_vector(motion, i, VELOCITY))
        for d in range(4):
            packed[k, 6 + d] = orientations[i, d]
        set_row_vector(packed, k, 10, row_vector(motion, i, OMEGA))


@njit(**EXACT)
def copy_first_motion(
    row: Whole, last: int, motion: Numbers, orientations: Numbers, position: Numbers,
    velocity: Numbers, orientation: Numbers, angular_velocities: Numbers,
) -> None:  # fmt: skip
    """Copy out the motion of the bodies whose rows are before `last`."""
    for k in range(position.shape[0]):
        i = row[k]
        if i < last:
            set_row_vector(position, k, 0, row_vector(motion, i))
            set_row_vector(velocity, k, 0, row_vector(motion, i, VELOCITY))
            set_row_vector(angular_velocities, k, 0, row_vector(motion, i, OMEGA))
            for d in range(4):
                orientation[k, d] = orientations[i, d]


@njit(**EXACT)
def copy_packed_motion(
    row: Whole, first: int, packed: Numbers, position: Numbers, velocity: Numbers,
    orientation: Numbers, angular_velocities: Numbers,
) -> None:  # fmt: skip
    """Copy out the motion of the bodies whose rows are from `first` on, and are packed."""
    for k in range(position.shape[0]):
        i = row[k] - first
        if i >= 0:
            set_row_vector(position, k, 0, row_vector(packed, i))
            set_row_vector(velocity, k, 0, row_vector(packed, i, 3))
            set_row_vector(angular_velocities, k, 0, row_vector(packed, i, 10))
            for d in range(4):
                orientation[k, d] = packed[i, 6 + d]
