"""Points on rectangular lattices: boxes filled with particles, samples or copies."""

from collections.abc import Sequence

import numpy as np

from quintet.interfaces.component import Array


def cell_centres(low: float, high: float, count: int, before: int = 0, after: int = 0) -> Array:
    """Centres (n,) m of `count` equal cells from `low` to `high` [m], and of more beyond the ends.

    Parameters
    ----------
    low, high : float, m
        Ends of an edge.
    count : int
        Cells between them.
    before, after : int
        Cells of the same length below `low` and above `high`.
    """
    return low + (np.arange(-before, count + after) + 0.5) * (high - low) / count


def cells_between(low: float, high: float, spacing: float) -> int:
    """Whole number of cells nearest to a spacing [m] from `low` to `high` [m], one or more."""
    return max(1, round((high - low) / spacing))


def cells_along(low: float, high: float, spacing: float) -> Array:
    """Centres (n,) m of the cells from `low` to `high` [m] whose length is nearest to a spacing."""
    return cell_centres(low, high, cells_between(low, high, spacing))


def fill_box(
    box: tuple[Sequence[float], Sequence[float]],
    counts: Sequence[int],
    beyond: Sequence[tuple[int, int]] = ((0, 0),) * 3,
) -> Array:
    """Centres (n, 3) m of the cells of a box, x fastest, and of so many layers beyond its faces.

    Parameters
    ----------
    box : two sequences of three floats, m
        Lowest and highest corner.
    counts : three ints
        Cells along each edge.
    beyond : three pairs of ints
        Layers of cells below and above the box, along each axis.
    """
    edges = zip(*box, counts, beyond, strict=True)
    return lattice_points([cell_centres(low, high, n, *more) for low, high, n, more in edges])


def spread_evenly(low: float, high: float, count: int) -> Array:
    """Places (count,) m from `low` to `high` [m], both included; a single one in the middle."""
    return np.linspace(low, high, count) if count > 1 else np.array([0.5 * (low + high)])


def lattice_points(axes: Sequence[Array], x_fastest: bool = True) -> Array:
    """All points (n, 3) m of a lattice, from its places (nx,), (ny,), (nz,) m along the axes.

    Rows go along x first and along z last, or the other way round.
    """
    if x_fastest:
        z, y, x = np.meshgrid(*axes[::-1], indexing="ij")
    else:
        x, y, z = np.meshgrid(*axes, indexing="ij")
    return np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)
