"""Slopes at a wall."""

from numba import njit

from quintet.components.shared.numba_options import INNER


@njit(**INNER)
def wall_slope(at_wall, first, second, near, far):  # type: ignore[no-untyped-def]
    """Slope at a wall of the parabola through it and two values above it.

    Parameters
    ----------
    at_wall, first, second : float
        Values on the wall and at the two distances.
    near, far : float, m

    Returns
    -------
    float, 1/m times the value's unit
        Of first order where there is no second, 0 where there is none.
    """
    if not far > near:
        return (first - at_wall) / near if near > 0.0 else 0.0
    return ((first - at_wall) * far / near - (second - at_wall) * near / far) / (far - near)
