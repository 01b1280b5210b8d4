"""Loads on a structure that follow its motion."""

import numpy as np

from quintet.components.fe_plate.meshes.mesh import Mesh
from quintet.components.fe_plate.meshes.tetrahedra import FACE_SLOPES, FACE_WEIGHTS, PIECES
from quintet.components.fe_plate.state import State, Whole


def add_pressure(mesh: Mesh, state: State, faces: Whole, pressure: float) -> None:
    """Add the load of a pressure on outer faces, shared out evenly to the corners of each.

    Of faces with six nodes it is ∫ N n dA of their shape functions, which leaves the corners of
    flat ones without a share.

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
    if mesh.has_tetrahedra:
        _press_six_nodes(state, side.reshape(-1, len(PIECES), 4), pressure)
        return
    a, b, c, d = np.moveaxis(state.position[side], 1, 0)
    area = 0.5 * np.cross(c - a, d - b)  # (f, 3) m2, outwards
    np.add.at(state.load, side, -0.25 * pressure * area[:, None, :])


def _press_six_nodes(state: State, pieces: Whole, pressure: float) -> None:
    """Add the load on faces, each given by its four triangles (f, 4, 4) as of `Mesh.side`."""
    corners, middles = [pieces[:, k, k] for k in range(3)], [pieces[:, 3, k] for k in range(3)]
    node = np.stack(corners + middles, axis=1)  # (f, 6)
    x = state.position[node]
    for slopes, weights in zip(FACE_SLOPES, FACE_WEIGHTS, strict=True):
        along, across = np.einsum("fad,ai->ifd", x, slopes)
        area = np.cross(along, across) / 6.0  # (f, 3) m2, outwards, of one of three points
        np.add.at(state.load, node, -pressure * weights[:, None] * area[:, None, :])
