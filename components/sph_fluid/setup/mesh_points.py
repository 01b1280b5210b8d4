"""Wall particles behind surfaces from files, in layers as those of moving bodies.

Imported only by a scene that has some.
"""

import math
from functools import lru_cache, partial

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from quintet.components.shared.geometry.surface_samples_closed import (
    Body,
    Depths,
    fill_closed,
)
from quintet.components.sph_fluid.setup.boundary_meshes import BoundaryMesh, Filling
from quintet.components.sph_fluid.setup.mesh_surfaces import FAR, SAME, Surface
from quintet.interfaces.component import Array

GAP = 0.75  # spacings: places of a layer further than this from all particles get one


@lru_cache(maxsize=16)
def surface(mesh: BoundaryMesh, filling: Filling) -> Surface:
    """Make a surface ready to be measured."""
    return Surface(mesh, filling.spacing, filling.reach, filling.dry)


@lru_cache(maxsize=16)
def mesh_points(mesh: BoundaryMesh, filling: Filling) -> tuple[Array, Array]:
    """Particles (n, 3) m behind a surface, x fastest, and their images (n, 3) m in it.

    There are none in the tank's walls, which have their own.
    """
    mesh_surface, spacing = surface(mesh, filling), filling.spacing
    corner = mesh_surface.triangles.corner
    low, high = corner.min(axis=(0, 1)), corner.max(axis=(0, 1))
    inset, depths = (filling.offset - 0.5) * spacing, mesh_surface.depths
    if mesh.is_solid:
        low, high = _whole_spacings(low, high, spacing)
        volume = mesh_surface.triangles.volume
    else:
        low, high = _around(low, high, mesh_surface.reach, spacing)
        layers = math.ceil((filling.reach - inset) / spacing - SAME)
        depths = partial(_down_to, mesh_surface, inset + layers * spacing)
        volume = _volume_behind(depths, low, high, spacing)
    body = Body(depths, low, high, volume)
    (points, _, _, images), _ = fill_closed(body, spacing, filling.reach - inset, inset)
    if not mesh.is_solid:
        points, images = _with_gaps_filled(points, images, mesh_surface, filling)
    outside = ~_in_walls(points, filling)
    points, images = points[outside], images[outside]
    order = np.lexsort(np.round(points / (1e-6 * spacing)).T)
    return points[order], images[order]


def _in_walls(points: Array, filling: Filling) -> NDArray[np.bool_]:
    """Whether points (n, 3) m lie in the walls of the tank."""
    if filling.tank is None or filling.around is None:
        return np.zeros(len(points), bool)
    (low, high), (lowest, highest) = np.array(filling.tank), np.array(filling.around)
    is_beyond = (points < low) | (points > high)
    is_around = (points > lowest) & (points < highest)
    return np.asarray(is_beyond.any(axis=1) & is_around.all(axis=1))


def _with_gaps_filled(
    points: Array, images: Array, mesh_surface: Surface, filling: Filling
) -> tuple[Array, Array]:
    """Add particles in gaps of bent layers, through which fluid would leave a tank."""
    spacing, depth = filling.spacing, filling.offset * filling.spacing
    while depth < filling.reach:
        places = mesh_surface.piece - depth * mesh_surface.normal[mesh_surface.owner]
        surface_depth, normal = mesh_surface.depths(places)
        places = places[np.abs(surface_depth - depth) < SAME * spacing]
        normal = normal[np.abs(surface_depth - depth) < SAME * spacing]
        distance, _ = cKDTree(points).query(places)
        order = np.argsort(-distance, kind="stable")
        added: list[int] = []
        for k in order[distance[order] > GAP * spacing].tolist():
            gap = np.linalg.norm(places[added] - places[k], axis=1)
            if gap.min(initial=np.inf) > GAP * spacing:
                added.append(k)
        points = np.concatenate([points, places[added]])
        images = np.concatenate([images, places[added] + 2.0 * depth * normal[added]])
        depth += spacing
    return points, images


def _whole_spacings(low: Array, high: Array, spacing: float) -> tuple[Array, Array]:
    """Corners (3,) m of a box, exact along axes on which it is nearly whole spacings long."""
    middle, length = 0.5 * (low + high), high - low
    rounded = spacing * np.round(length / spacing)
    half = 0.5 * np.where(np.abs(length - rounded) < SAME * spacing, rounded, length)
    return middle - half, middle + half


def _around(low: Array, high: Array, reach: float, spacing: float) -> tuple[Array, Array]:
    """Corners (3,) m of a box about another one, whole spacings long, so far [m] beyond it."""
    middle = 0.5 * (low + high)
    half = 0.5 * spacing * np.ceil((high - low + 2.0 * reach) / spacing)
    return middle - half, middle + half


def _down_to(mesh_surface: Surface, deepest: float, points: Array) -> tuple[Array, Array]:
    """Depths and normals behind a surface, as if what is deeper [m] were before it."""
    below, normal = mesh_surface.depths(points)
    return np.where(below < deepest, below, -FAR), normal


def _volume_behind(depths: Depths, low: Array, high: Array, spacing: float) -> float:
    """Volume [m3] of whole layers behind a surface, by places of a lattice."""
    axes = [np.arange(a + 0.25 * spacing, b, 0.5 * spacing) for a, b in zip(low, high, strict=True)]
    count = 0
    for z in axes[2]:  # all at once would take gigabytes
        places = np.stack(np.meshgrid(*axes[:2], [z], indexing="ij"), axis=-1).reshape(-1, 3)
        below, _ = depths(places)
        count += int((below > 0.0).sum())
    return count * (0.5 * spacing) ** 3
