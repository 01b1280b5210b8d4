"""Copies of the motion of bodies, in the scene's order."""

from numba import njit

from quintet.components.dem_bodies.kernels.geometry import row_vector, set_row_vector
from quintet.components.dem_bodies.state import OMEGA, VELOCITY, Numbers, Whole
from quintet.components.shared.numba_options import EXACT


@njit(**EXACT)
def write_motion(
    first: int, places: Whole, motion: Numbers, orientations: Numbers, position: Numbers,
    velocity: Numbers, orientation: Numbers, angular_velocities: Numbers,
) -> None:  # fmt: skip
    """Write the motion of the rows from `first` on into their places (k,).

    Rows are read one after another: reading them in the order of their places takes longer.
    """
    for n in range(places.shape[0]):
        i, k = first + n, places[n]
        set_row_vector(position, k, 0, row_vector(motion, i))
        set_row_vector(velocity, k, 0, row_vector(motion, i, VELOCITY))
        set_row_vector(angular_velocities, k, 0, row_vector(motion, i, OMEGA))
        for d in range(4):
            orientation[k, d] = orientations[i, d]
