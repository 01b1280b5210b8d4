"""Stabilisation of Flanagan and Belytschko: stiffness against what one quadrature point misses.

Of the patterns h_I a linear field leaves no trace: γ_I = h_I - Σ (h_I·x) ∇N. What is left of the
velocities, q = γ_I·v, loads a spring Q each, turned with the element; forces are γ_I Q.
"""

from numba import njit

from quintet.components.fe_plate.kernels.geometry import INLINED, LANES


@njit(**INLINED)
def patterns(values, out):  # type: ignore[no-untyped-def]
    """Write h_I·values (12, lanes), row 3I + d, of corner values (24, lanes)."""
    for d in range(3):
        for k in range(LANES):
            a, b, c, e = values[d, k], values[3 + d, k], values[6 + d, k], values[9 + d, k]
            f, g, h, i = values[12 + d, k], values[15 + d, k], values[18 + d, k], values[21 + d, k]
            out[d, k] = a + b - c - e - f - g + h + i
            out[3 + d, k] = a - b - c + e - f + g + h - i
            out[6 + d, k] = a - b + c - e + f - g + h - i
            out[9 + d, k] = b - a - c + e + f - g + h - i


@njit(**INLINED)
def add_patterns(forces, out):  # type: ignore[no-untyped-def]
    """Add Σ h_I Q_I to corner values (24, lanes), the transpose of `patterns`."""
    for d in range(3):
        for k in range(LANES):
            p, q, r, s = forces[d, k], forces[3 + d, k], forces[6 + d, k], forces[9 + d, k]
            out[d, k] += p + q + r - s
            out[3 + d, k] += p - q - r + s
            out[6 + d, k] += -p - q + r - s
            out[9 + d, k] += -p + q - r + s
            out[12 + d, k] += -p - q + r + s
            out[15 + d, k] += -p + q - r - s
            out[18 + d, k] += p + q + r + s
            out[21 + d, k] += p - q - r - s
