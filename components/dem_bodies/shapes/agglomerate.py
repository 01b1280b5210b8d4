"""Agglomerates P(dim, R): a shape from a file, its surface covered by equal spheres.

Centres stand on a lattice of `dim` places along the longest edge of the box that holds the shape,
set in by R, so that the outermost spheres touch its faces from within. Along the other edges
there are as few places as leave them no further from each other. Of these centres are kept, the
first first, and none that is closer to a kept one than half the lattice's distance:

    - those that lie at the depth R below the surface;
    - those nearer to the surface or a little outside, moved along the normal to the depth R, so
      that spheres touch curved and slanted faces and those that fall between two places;
    - those up to one distance of the lattice deeper. What lies deeper still touches nothing, as
      spheres of one layer overlap or touch.

Parts of a shape that are thinner than 2 R get no spheres. Mass, centre and inertia are those of the
shape itself, exact for what the file describes, not those of the spheres, which overlap and leave
corners empty.
"""

import math
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from quintet.components.shared.geometry.lattice import lattice_points, spread_evenly
from quintet.components.shared.geometry.mesh_files import Solid, inside, nearest
from quintet.components.shared.geometry.shapes import read_solid
from quintet.interfaces.component import Array

MOST = 2000  # spheres of one body
PLACES = 15  # of the lattice for each sphere, at most; more would take long to sort out
ROUNDS = 4  # in which a centre is moved to its depth
CLOSE = 1e-3  # of R, by which a depth may differ
UNITS = {"m": 1.0, "mm": 1e-3, "cm": 1e-2}  # m, of files


class Agglomerate(NamedTuple):
    """A body of equal spheres, about its centre of mass."""

    volume: float  # m3
    centre: Array  # (3,) m, of mass, from the origin of the file
    inertia: Array  # (3, 3) m5, at unit density
    centres: Array  # (n, 3) m
    radius: float  # m
    size: Array  # (3,) m, edges of the box that holds it


@lru_cache(maxsize=16)
def agglomerate(file: str, scale: float, dim: int, radius: float) -> Agglomerate:
    """Cover the shape in a file with spheres.

    Parameters
    ----------
    file : str
        STL, OBJ, PLY, or voxels as .npy.
    scale : float, m
        What one unit of length in the file, or one voxel, stands for.
    dim : int
        Places of the lattice along the longest edge.
    radius : float, m
    """
    shape = read_solid(file, scale)
    low, high = shape.triangles.min(axis=(0, 1)), shape.triangles.max(axis=(0, 1))
    size = high - low
    require_fit(file, scale, size, dim, radius)
    spacing = (size.max() - 2.0 * radius) / (dim - 1)
    counts = np.ceil((size - 2.0 * radius) / spacing - 1e-9).astype(int) + 1
    require_few(file, dim, radius, int(counts.prod()) // PLACES)
    axes = [
        spread_evenly(a + radius, b - radius, n) for a, b, n in zip(low, high, counts, strict=True)
    ]
    places = lattice_points(axes, x_fastest=False)
    centres = covering(places, shape, radius, spacing)
    require_few(file, dim, radius, len(centres))
    if not len(centres):
        raise ValueError(
            f"file {Path(file).name}: the shape must have room for a sphere within; at "
            f"sphere_radius {radius:g} m it has none. Make sphere_radius smaller."
        )
    return Agglomerate(
        shape.volume, shape.centre, shape.inertia, centres - shape.centre, radius, size
    )


def require_few(file: str, dim: int, radius: float, count: int) -> None:
    """Refuse more spheres than are of use to a body."""
    if count > MOST:
        raise ValueError(
            f"file {Path(file).name}: an agglomerate must have at most {MOST} spheres; dim {dim} "
            f"and sphere_radius {radius:g} m give more. Make dim smaller."
        )


def require_fit(file: str, scale: float, size: Array, dim: int, radius: float) -> None:
    """Refuse spheres that do not fit into the shape, or leave gaps between them."""
    edges = " x ".join(f"{edge:.4g}" for edge in size)
    size_text = f"found {radius:g} m for {Path(file).name} of {edges} m at scale {scale:g}."
    if does_not_fit(size, radius):
        raise ValueError(
            "sphere_radius must be at most half the shortest edge of the box around the shape, "
            f"{0.5 * size.min():.4g} m; {size_text} Make it smaller, or "
            f"{scale_remedy(scale, size, dim, radius)}."
        )
    if dim < fewest_places(size, radius):
        raise ValueError(
            "the spheres must touch, which dim * 2 * sphere_radius >= the longest edge of the box "
            f"around the shape gives; {size_text} dim is {dim}. Make dim "
            f"{fewest_places(size, radius)} or larger, or sphere_radius larger, or "
            f"{scale_remedy(scale, size, dim, radius)}."
        )


def does_not_fit(size: Array, radius: float) -> bool:
    """Whether a sphere is wider than a shape."""
    return bool(2.0 * radius > size.min() * (1.0 + 1e-9))


def fewest_places(size: Array, radius: float) -> int:
    """Places of the lattice along the longest edge with which spheres touch."""
    return max(2, math.ceil(0.5 * float(size.max()) / radius - 1e-9))


def scale_remedy(scale: float, size: Array, dim: int, radius: float) -> str:
    """Advise the scale of a common unit with which the spheres fit, if there is any."""
    for unit, metres in UNITS.items():
        scaled = size * (metres / scale)
        if does_not_fit(scaled, radius) or dim < fewest_places(scaled, radius):
            continue
        edges = " x ".join(f"{edge:.4g}" for edge in scaled)
        if metres == 1.0:
            return f"leave scale out: the shape of a file in m is {edges} m"
        return f"set scale = {metres:g} for a file in {unit}: its shape is {edges} m"
    return "correct scale, the length in m of one unit in the file"


def covering(places: Array, shape: Solid, radius: float, spacing: float) -> Array:
    """Centres (n, 3) m of the outermost layer: lattice places, and outer ones moved in."""
    foot, away = distances(places, shape)
    near = away < radius + spacing * (1.0 - CLOSE)  # others are too deep or outside
    places, foot = places[near], foot[near]
    depth = signed(places, away[near], shape)
    above, deep = depth < radius * (1.0 - CLOSE), depth > radius * (1.0 + CLOSE)
    outer = above & (depth > radius - spacing)
    moved = moved_in(places[outer], foot[outer], depth[outer], shape, radius)
    centres = np.zeros((0, 3))
    for centre in np.concatenate([places[~above & ~deep], moved, places[deep]]):
        if not len(centres) or np.linalg.norm(centres - centre, axis=1).min() > 0.5 * spacing:
            centres = np.vstack([centres, centre])
    return centres


def distances(points: Array, shape: Solid) -> tuple[Array, Array]:
    """Nearest points (n, 3) m of the surface, and how far (n,) m they are."""
    foot = nearest(points, shape.triangles)
    return foot, np.linalg.norm(points - foot, axis=1)


def signed(points: Array, away: Array, shape: Solid) -> Array:
    """Depths (n,) m of points so far away from the surface, negative outside."""
    return np.where(inside(points, shape.triangles), away, -away)


def moved_in(points: Array, foot: Array, depth: Array, shape: Solid, radius: float) -> Array:
    """Move points along their normals to a depth of R; return those that come to it."""
    placed = [np.zeros((0, 3))]
    for _ in range(ROUNDS):
        sound = np.abs(depth) > 1e-9 * radius  # on the surface itself there is no direction
        inward = (points[sound] - foot[sound]) / depth[sound, None]
        points = foot[sound] + radius * inward
        foot, away = distances(points, shape)
        depth = signed(points, away, shape)
        arrived = np.abs(depth - radius) <= CLOSE * radius
        placed.append(points[arrived])
        points, foot, depth = points[~arrived], foot[~arrived], depth[~arrived]
    return np.concatenate(placed)
