"""Bodies filled with lattices of particles."""

import math
from typing import NamedTuple

import numpy as np

from quintet.components.shared.lattice import cell_centres, lattice_points
from quintet.components.sph_solid.params import Body, SphSolidParams
from quintet.components.sph_solid.state import Array


class Filling(NamedTuple):
    """Particles of one body."""

    points: Array  # (n, 3) m
    volume: Array  # (n,) m3, of each


def filling(body: Body, params: SphSolidParams) -> Filling:
    """Fill a body: cells of a box of its own, half a spacing from the middle of round ones.

    Particles share the body's volume, what planes of symmetry cut off included.
    """
    points = _box(body, params) if body.shape == "box" else _round(body, params)
    share: Array = np.ones(len(points))
    if params.axisymmetric:
        points = points[points[:, 0] > 0.0]
        share = points[:, 0]  # of a ring, by its circumference
    volume = body.volume(params.dimensions, params.axisymmetric) * share / max(share.sum(), 1e-300)
    for plane in params.symmetry:
        beyond = points[:, "xyz".index(plane.axis)]
        kept = (beyond > plane.position) == (plane.side == "+")
        points, volume = points[kept], volume[kept]
    return Filling(points, volume)


def _box(body: Body, params: SphSolidParams) -> Array:
    axes = [
        cell_centres(low, high, max(1, round((high - low) / params.spacing)))
        for low, high in zip(*body.box, strict=True)
    ]
    if params.dimensions == 2:
        axes[1] = np.zeros(1)
    return lattice_points(axes)


def _round(body: Body, params: SphSolidParams) -> Array:
    """Points of a lattice about the centre that are in a sphere or cylinder."""
    low, high = body.box
    radius, along = 0.5 * (body.diameter or 0.0), "xyz".index(body.axis)
    centre = np.array(low) / 2.0 + np.array(high) / 2.0
    axes = []
    for axis in range(3):
        if body.shape == "cylinder" and axis == along:
            edge = high[axis] - low[axis]
            axes.append(cell_centres(-0.5 * edge, 0.5 * edge, max(1, round(edge / params.spacing))))
        else:
            half = math.ceil(radius / params.spacing)
            axes.append(cell_centres(-half * params.spacing, half * params.spacing, 2 * half))
    if params.dimensions == 2:
        axes[1], centre[1] = np.zeros(1), 0.0
    points = lattice_points(axes)
    squares = points**2
    if body.shape == "cylinder":
        squares[:, along] = 0.0
    return points[squares.sum(axis=1) <= radius * radius] + centre
