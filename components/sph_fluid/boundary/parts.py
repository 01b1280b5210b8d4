"""Parts of walls, obstacles and meshes that stand, and parts that move as pistons."""

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.geometry.box_faces import box
from quintet.components.sph_fluid.boundary.obstacles import (
    from_meshes,
    obstacle_mirrors,
    obstacle_points,
)
from quintet.components.sph_fluid.boundary.walls import wall_mirrors, wall_points
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.setup.geometry import FACES
from quintet.components.sph_fluid.setup.pistons import Piston
from quintet.components.sph_fluid.state import Array

Points = tuple[Array, Array]  # particles (n, 3) m and their images (n, 3) m


def standing(params: SphFluidParams) -> Points:
    """Particles of all that stands, and their images in its faces."""
    edge = params.boundary
    points, images = wall_points(params), wall_mirrors(params)
    stays = np.ones(len(points), bool)
    for piston in edge.pistons:
        if piston.face:
            stays &= ~_behind(points, piston.face, params)
    walls = points[stays], images[stays]
    moving_numbers = {piston.number("obstacles") for piston in edge.pistons}
    still_boxes = [box for number, box in enumerate(edge.solids) if number not in moving_numbers]
    boxes = obstacle_points(params, still_boxes), obstacle_mirrors(params, still_boxes)
    moving_numbers = {piston.number("meshes") for piston in edge.pistons}
    meshes = from_meshes(params, [m for n, m in enumerate(edge.meshes) if n not in moving_numbers])
    return _joined(walls, boxes, meshes)


def moving(params: SphFluidParams, piston: Piston) -> Points:
    """Particles of a piston as it stands in the scene, and their images in its faces."""
    edge = params.boundary
    if piston.face:
        points = wall_points(params)
        is_behind = _behind(points, piston.face, params)
        return points[is_behind], wall_mirrors(params)[is_behind]
    if (number := piston.number("obstacles")) >= 0:
        boxes = [edge.solids[number]]
        return obstacle_points(params, boxes), obstacle_mirrors(params, boxes)
    return from_meshes(params, [edge.meshes[piston.number("meshes")]])


def part_faces(params: SphFluidParams, piston: Piston) -> list[Array]:
    """Corners (k, 3) m of the faces of a piston as it stands in the scene."""
    edge = params.boundary
    if piston.face and edge.tank:
        return box(*edge.tank, [piston.face])
    if (number := piston.number("obstacles")) >= 0:
        sides = [face for face in FACES if params.dimensions == 3 or face[0] != "y"]
        return box(*edge.solids[number], sides)
    # Left out of scenes without boundaries from files.
    from quintet.components.sph_fluid.setup.mesh_surfaces import placed

    return list(placed(edge.meshes[piston.number("meshes")]).corner)


def _behind(points: Array, face: str, params: SphFluidParams) -> NDArray[np.bool_]:
    """Which wall particles (n, 3) m are behind a face, and beside no other one."""
    assert params.boundary.tank is not None
    low, high = np.array(params.boundary.tank)
    axis = "xyz".index(face[0])
    is_beyond = points[:, axis] > high[axis] if face[1] == "+" else points[:, axis] < low[axis]
    other_axes = [k for k in range(3) if k != axis]
    inside = (
        (points[:, other_axes] > low[other_axes]) & (points[:, other_axes] < high[other_axes])
    ).all(axis=1)
    return np.asarray(is_beyond & inside)


def _joined(*parts: Points) -> Points:
    points, images = zip(*parts, strict=True)
    return np.concatenate(points), np.concatenate(images)
