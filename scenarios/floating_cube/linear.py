"""Heave period of the cube in its tank: ``python scenarios/floating_cube/linear.py``.

Linear theory (Newman, Marine Hydrodynamics, 1977, chapter 6): ∇²φ = 0, ∂φ/∂n = 0 on floor and
walls, the cube's speed on its lower face, ∂φ/∂z = ω²φ/g on the surface. The water's pressure on
the lower face is that of an added mass A(ω), which holds all that walls and floor do; from a
closed tank no wave leaves, and there is no damping. The period is the root of

    ω² (m + A(ω)) = ρ g a²,    T = 2π √(d/g (1 + Ca)),    Ca = A/m.

Finite volumes on cubes, over a quarter of the tank; at the edges φ is singular, and the error
falls with the 4/3rd power of the width: by it the last two are carried on to zero. As ω rises and
walls recede, Ca must come to that of half of a square prism 2d long in infinite water: 0.46,
between 0.68 and 0.36 of DNV-RP-C205, appendix D, for prisms as long as wide and twice as long.

In two dimensions (`planar`) the tank is a slice as deep as the cube, of 1 m: the square of
`scenarios/floating_square`. There Ca must come to that of half of a rectangle in infinite water.
"""

import math

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

G, SIDE, DRAUGHT = 9.81, 0.15, 0.12  # m/s2, m, m
TANK, DEPTH = 0.45, 0.3  # m
PLANAR_DEPTH = 0.31  # m, of the water in two dimensions with the square at rest in it


def added(tank: float, depth: float, width: float, steep: float, planar: bool = False) -> float:
    """Ca, on cells of a width [m]; steep: ω²/g [1/m], infinite for motion too fast for waves."""
    across, high, half, deep = (
        round(length / width) for length in (0.5 * tank, depth, 0.5 * SIDE, DRAUGHT)
    )
    wet = np.ones((across, 1 if planar else across, high), bool)
    wet[:half, :half, high - deep :] = False
    number = np.where(wet, np.cumsum(wet).reshape(wet.shape) - 1, -1)
    count = int(wet.sum())
    diagonal = np.zeros(count)
    rows, columns = [np.arange(count)], [np.arange(count)]
    for axis in range(3):
        layers = np.moveaxis(number, axis, 0)
        i, j = layers[:-1].ravel(), layers[1:].ravel()
        joined = (i >= 0) & (j >= 0)
        i, j = i[joined], j[joined]
        rows, columns = [*rows, i, j], [*columns, j, i]
        diagonal += np.bincount(i, minlength=count) + np.bincount(j, minlength=count)
    top = number[:, :, -1][number[:, :, -1] >= 0]
    # From the middle of a cell to the surface, half a width away, φ is linear.
    still = math.isinf(steep)
    diagonal[top] += 2.0 if still else -steep * width / (1.0 - 0.5 * steep * width)
    values = np.concatenate([diagonal, -np.ones(sum(map(len, rows)) - count)])
    matrix = coo_matrix((values, (np.concatenate(rows), np.concatenate(columns)))).tocsc()
    under = number[:half, :half, high - deep - 1].ravel()
    source = np.zeros(count)
    source[under] = width  # the lower face moves at 1 m/s
    potential = splu(matrix).solve(source)[under] + 0.5 * width
    # Of a quarter of the cube, or of half the square on 1 m.
    share = 2.0 * width / SIDE if planar else 4.0 * width**2 / SIDE**2
    return float(share * potential.sum() / DRAUGHT)


def period(width: float, planar: bool = False) -> tuple[float, float]:
    """Period [s] and Ca on cells of a width [m]."""
    ca, depth = 0.4, PLANAR_DEPTH if planar else DEPTH
    # A hardly depends on ω, but where the level rises and falls by much.
    for _ in range(40 if planar else 4):
        ca = added(TANK, depth, width, 1.0 / (DRAUGHT * (1.0 + ca)), planar)
    return 2.0 * math.pi * math.sqrt(DRAUGHT / G * (1.0 + ca)), ca


def main() -> None:
    """Print them."""
    print(f"wide tank, fast motion: Ca = {added(6 * SIDE, 4 * SIDE, 0.015, math.inf):.3f}")
    (coarse, _), (fine, ca) = period(0.015), period(0.0075)
    print(f"this tank: Ca = {ca:.3f}; T = {coarse:.4f} s, {fine:.4f} s", end=" ")
    print(f"-> {carried_on(coarse, fine):.4f} s")
    (coarse, _), (fine, ca) = period(0.0025, True), period(0.00125, True)
    print(f"in two dimensions: Ca = {ca:.3f}; T = {coarse:.4f} s, {fine:.4f} s", end=" ")
    print(f"-> {carried_on(coarse, fine):.4f} s")


def carried_on(coarse: float, fine: float) -> float:
    """Value on cells without width, from those on cells of a width and of half of it."""
    return fine + (fine - coarse) / (2.0 ** (4.0 / 3.0) - 1.0)


if __name__ == "__main__":
    main()
