"""Particles of the tank's walls: layers outside its closed faces; numpy alone."""

import math

import numpy as np

from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.shared.geometry.lattice import fill_box
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.setup.geometry import FACES, cells
from quintet.components.sph_fluid.state import Array


def wall_box(params: SphFluidParams) -> Bounds | None:
    """Box around the tank on whose outside, half a cell off, the wall particles lie."""
    if params.boundary.tank is None:
        return None
    (x, y, z), (u, v, w) = params.boundary.tank
    beyond = (params.boundary.wall_offset - 0.5) * params.spacing
    out = dict.fromkeys(FACES, 0.0) | dict.fromkeys(params.closed_faces, beyond)
    return (
        (x - out["x-"], y - out["y-"], z - out["z-"]),
        (u + out["x+"], v + out["y+"], w + out["z+"]),
    )


def layers_beyond(params: SphFluidParams) -> list[tuple[int, int]]:
    """Layers of wall particles beyond the lower and the upper face, along each axis.

    One layer of dynamic particles repels; of others there are as many as a kernel meets.
    """
    layers = 1 if params.boundary.method == "dbc" else math.ceil(2.0 * params.smoothing)
    beyond = dict.fromkeys(FACES, 0) | dict.fromkeys(params.closed_faces, layers)
    return [(beyond[f"{x}-"], beyond[f"{x}+"]) for x in "xyz"]  # type: ignore[index]


def count_wall_points(params: SphFluidParams) -> int:
    """Count wall particles without making them."""
    box = wall_box(params)
    if box is None:
        return 0
    inside = cells(box, params.spacing, params.dimensions)
    outside = [n + sum(shut) for n, shut in zip(inside, layers_beyond(params), strict=True)]
    return math.prod(outside) - math.prod(inside)


def wall_points(params: SphFluidParams) -> Array:
    """Layers of particles, the first `wall_offset` spacings outside the tank's faces; (n, 3) m.

    Half a spacing out, the lattice of a fluid that touches a wall goes on into it; but moving
    fluid keeps off dynamic particles by more than that, the more so where the wall was dry.
    """
    box = wall_box(params)
    if box is None:
        return np.zeros((0, 3))
    points = fill_box(box, cells(box, params.spacing, params.dimensions), layers_beyond(params))
    low, high = np.array(box)
    return points[((points < low) | (points > high)).any(axis=1)]


def wall_mirrors(params: SphFluidParams) -> Array:
    """Mirror points (n, 3) m of all wall particles, through the nearest point of their wall."""
    points = wall_points(params)
    if params.boundary.tank is None:
        return points
    low, high = np.array(params.boundary.tank)
    for axis in range(3):
        low[axis] = low[axis] if FACES[2 * axis] in params.closed_faces else -np.inf
        high[axis] = high[axis] if FACES[2 * axis + 1] in params.closed_faces else np.inf
    return 2.0 * np.clip(points, low, high) - points


def wall_velocity(wall: Array, params: SphFluidParams) -> Array:
    """Velocity (n, 3) m/s of wall particles (n, 3) m, which stay where they are."""
    velocities = np.zeros_like(wall)
    for face, velocity in params.boundary.wall_velocity.items():
        assert params.boundary.tank is not None
        (low, high), axis = params.boundary.tank, "xyz".index(face[0])
        beyond = wall[:, axis] > high[axis] if face[1] == "+" else wall[:, axis] < low[axis]
        velocities[beyond] = velocity
    return velocities


def wall_volume(params: SphFluidParams) -> float:
    """Volume [m3] of a cell of the walls, area [m2] in two dimensions; spacing's without any."""
    box = wall_box(params)
    if box is None:
        return float(params.spacing**params.dimensions)
    counts = cells(box, params.spacing, params.dimensions)
    edges = [(b - a) / n for a, b, n in zip(*box, counts, strict=True)]
    if params.dimensions == 2:
        edges[1] = 1.0
    return math.prod(edges)
