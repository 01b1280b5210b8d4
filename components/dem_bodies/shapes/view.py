"""What a picture shows of bodies: corners, faces, centres of spheres."""

from collections.abc import Sequence

import numpy as np

from quintet.components.dem_bodies.build import CORNERS, Solid
from quintet.components.dem_bodies.params import Body
from quintet.components.dem_bodies.shapes import planar
from quintet.components.dem_bodies.state import State
from quintet.components.shared.polygons import in_space
from quintet.interfaces.component import Array, Fields

# Corners around each face of a box, seen from outside.
FACES = np.array(
    [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
)


def view(bodies: Sequence[Body], solids: Sequence[Solid], state: State) -> Fields:
    """Corners and faces of boxes and polygons, centres of spheres, with number and velocity."""
    points: list[Array] = []
    owners: list[int] = []
    faces: list[Array] = []
    for k, (body, solid, a) in enumerate(zip(bodies, solids, state.row, strict=False)):
        corners = solid.centres
        if body.size is not None:
            corners = CORNERS * 0.5 * np.array(body.size)
            faces.append(FACES + len(owners))
        elif body.corners is not None:
            corners = in_space(planar.corners(body))
            faces.append(planar.triangles(len(corners)) + len(owners))
        axes = state.axes[a].reshape(3, 3)
        points.append(state.position[a] + corners @ axes.T)
        owners += [k] * len(corners)
    where, owner = np.vstack(points), np.array(owners)
    row = state.row[owner]
    turning = np.cross(state.angular_velocity[row], where - state.position[row])
    shown = {"points": where, "body": owner, "velocity": state.velocity[row] + turning}
    return shown | ({"cells": np.vstack(faces)} if faces else {})
