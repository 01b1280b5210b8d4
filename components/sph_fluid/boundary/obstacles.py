"""Boxes that stand still in the water, filled with wall particles as deep as water feels them.

A box that ends on a plane of symmetry is half of one that the plane cuts: its particles are half
of those that the whole box has, beginning half a step from the plane, where the other half's are
their images. (A whole box that would have particles on the plane itself gets a row more or less.)
"""

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.shared.geometry.lattice import lattice_points
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.setup.boundary_meshes import BoundaryMesh
from quintet.components.sph_fluid.setup.geometry import ROUNDING, Face
from quintet.components.sph_fluid.state import Array

FELT = 2.0  # smoothing lengths, the radius of the kernel
MOST_ROWS = 1e6  # along an axis, that are looked at one by one


def obstacle_points(params: SphFluidParams, boxes: Sequence[Bounds] | None = None) -> Array:
    """Particles (n, 3) m of all obstacles, the outermost `wall_offset` spacings inside their faces.

    Of some of them, with `boxes`.

    A face that lies on a wall of the tank never meets water: there the particles go on to half a
    spacing from the wall, so that no gap is left in the corner.
    """
    boxes = params.boundary.solids if boxes is None else boxes
    parts = [_points(box, params)[0] for box in boxes]
    return np.concatenate([np.zeros((0, 3)), *parts])


def count_obstacle_points(params: SphFluidParams) -> int:
    """Count them without making them: rows along the axes, less those that water does not feel."""
    count = 0
    for box in params.boundary.solids:
        steps, low, _, step, wet = _rows(box, params)
        if max(steps) > MOST_ROWS:  # no machine holds as many; all of them, then
            count += math.prod(int(n) + 1 for n in steps)
            continue
        total, unfelt = 1, 1
        for axis, rows in enumerate(steps):
            row = low[axis] + np.arange(int(rows) + 1) * step[axis]
            distances = [row - box[0][axis], box[1][axis] - row]
            nearest = np.min(
                [np.where(wet[end, axis], distances[end], np.inf) for end in (0, 1)], axis=0
            )
            total *= len(row)
            unfelt *= int((nearest >= FELT * params.smoothing_length).sum())
        count += total - unfelt
    return count


def obstacle_mirrors(params: SphFluidParams, boxes: Sequence[Bounds] | None = None) -> Array:
    """Images (n, 3) m of the particles of obstacles, mirrored in the nearest wet face."""
    parts = [np.zeros((0, 3))]
    for box in params.boundary.solids if boxes is None else boxes:
        points, depth = _points(box, params)
        # On edges and corners, in all the faces that are equally near.
        nearest = depth <= depth.min(axis=(0, 2))[:, np.newaxis] + ROUNDING * params.spacing
        below, above = 2.0 * np.where(nearest, depth, 0.0)
        parts.append(points - below + above)
    return np.concatenate(parts)


def from_meshes(
    params: SphFluidParams, meshes: Sequence[BoundaryMesh] | None = None
) -> tuple[Array, Array]:
    """Particles (n, 3) m behind surfaces from files, all or some, and their images (n, 3) m."""
    empty = np.zeros((0, 3))
    meshes = params.boundary.meshes if meshes is None else meshes
    if not meshes:
        return empty, empty
    # Left out of scenes without boundaries from files.
    from quintet.components.sph_fluid.setup.mesh_points import mesh_points

    moving_meshes = params.boundary.moved_meshes
    filling = params.mesh_filling
    pairs = [
        mesh_points(mesh, filling.of_moved if mesh in moving_meshes else filling) for mesh in meshes
    ]
    points, images = (np.concatenate(arrays) for arrays in zip(*pairs, strict=True))
    return points, images


def _points(box: Bounds, params: SphFluidParams) -> tuple[Array, Array]:
    """Particles (n, 3) m of one obstacle, and how deep below each wet face [m]; (2, n, 3)."""
    steps, low, high, _, wet = _rows(box, params)
    counts = steps.astype(int) + 1
    axes = [np.linspace(a, b, n) for a, b, n in zip(low, high, counts, strict=True)]
    points = lattice_points(axes)
    below = [points - np.array(box[0]), np.array(box[1]) - points]
    depth = np.where(wet[:, np.newaxis], below, np.inf)
    felt = depth.min(axis=(0, 2)) < FELT * params.smoothing_length
    return points[felt], depth[:, felt]


def _rows(
    box: Bounds, params: SphFluidParams
) -> tuple[Array, Array, Array, Array, NDArray[np.bool_]]:
    """Steps (3,) along each axis, first and last place and length of a step (3,) m; wet faces."""
    wet = _wet(box, params)  # (2, 3)
    plane = ~wet & _named(params.boundary.symmetry)
    gap = np.where(plane, 0.0, np.where(wet, params.boundary.wall_offset, 0.5)) * params.spacing
    low, high = np.array(box[0]) + gap[0], np.array(box[1]) - gap[1]
    fewest = np.where(plane.any(axis=0), 0, 1)  # steps
    if params.dimensions == 2:
        low[1] = high[1] = 0.5 * (box[0][1] + box[1][1])
        fewest[1] = 0
    half = 0.5 * plane  # (2, 3) of a step, from the plane to the first particle
    steps = np.maximum(fewest, np.round((high - low) / params.spacing - half.sum(axis=0)))
    intervals = steps + half.sum(axis=0)
    step = np.divide(high - low, intervals, out=np.zeros(3), where=intervals > 0.0)
    return steps, low + half[0] * step, high - half[1] * step, step, wet


def _wet(box: Bounds, params: SphFluidParams) -> NDArray[np.bool_]:
    """Which faces do not lie on a wall of the tank, or beyond it; lower ones, upper ones; (2, 3).

    Those of a piston beyond a wall are wet, too.
    """
    if params.boundary.tank is None:
        return _in_space(np.ones((2, 3), bool), params)
    tolerance = ROUNDING * params.spacing
    lower = np.array(box[0]) > np.array(params.boundary.tank[0]) + tolerance
    upper = np.array(box[1]) < np.array(params.boundary.tank[1]) - tolerance
    if box in params.boundary.moved_solids:  # parts beyond a wall may enter the tank later
        lower |= np.array(box[0]) < np.array(params.boundary.tank[0]) - tolerance
        upper |= np.array(box[1]) > np.array(params.boundary.tank[1]) + tolerance
    return _in_space(np.stack([lower, upper]) | _named(params.boundary.open_faces), params)


def _in_space(wet: NDArray[np.bool_], params: SphFluidParams) -> NDArray[np.bool_]:
    """Wet faces (2, 3), of which those along y are dry in two dimensions."""
    if params.dimensions == 2:
        wet[:, 1] = False
    return wet


def _named(faces: Sequence[Face]) -> NDArray[np.bool_]:
    """Which faces are among these: lower ones, upper ones; (2, 3)."""
    return np.array([[f"{axis}{end}" in faces for axis in "xyz"] for end in "-+"])
