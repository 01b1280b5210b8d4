"""Loads on a structure that follow its motion."""

import numpy as np

from quintet.components.fe_plate.meshes.mesh import Mesh
from quintet.components.fe_plate.state import State, Whole


def add_pressure(mesh: Mesh, state: State, faces: Whole, pressure: float) -> None:
    """Add the load of a pressure on outer faces, shared out evenly to the corners of each.

    Parameters
    ----------
    mesh, state
    faces : (f,) int array
        Numbers of outer faces.
    pressure : float, Pa
        Along their normals as they are now; positive pushes.
    """
    side = mesh.side[faces]
    if len(side) and side[0, 2] < 0:  # edges, 1 m deep along y
        first, last = state.position[side[:, 0]], state.position[side[:, 1]]
        x, _, z = (last - first).T
        outwards = np.stack([z, np.zeros_like(x), -x], axis=1)  # m2
        np.add.at(state.load, side[:, :2], -0.5 * pressure * outwards[:, None, :])
        return
    a, b, c, d = np.moveaxis(state.position[side], 1, 0)
    area = 0.5 * np.cross(c - a, d - b)  # (f, 3) m2, outwards
    np.add.at(state.load, side, -0.25 * pressure * area[:, None, :])
