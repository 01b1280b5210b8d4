"""What a picture shows of a structure: its outer faces, with what its elements bear."""

import numpy as np

from quintet.components.fe_plate.meshes.mesh import Mesh, outer_sides
from quintet.components.fe_plate.state import (
    DAMAGE,
    DEVIATOR,
    PRESSURE,
    STRAIN,
    TEMPERATURE,
    Array,
    Places,
    State,
)
from quintet.interfaces.component import Fields


def von_mises(places: Places, state: State) -> Array:
    """Equivalent stress (e,) Pa of the elements' mean deviators."""
    xx, yy, zz, xy, yz, zx = places.rows(state, DEVIATOR, 6)
    squares = 1.5 * (xx * xx + yy * yy + zz * zz) + 3.0 * (xy * xy + yz * yz + zx * zx)
    return np.asarray(np.sqrt(squares))


def view(mesh: Mesh, places: Places, state: State) -> Fields:
    """Corners of the outer faces of what is left, in a plane of its elements; means at each."""
    live = np.flatnonzero(places.active(state))
    planar = bool((mesh.side[:1, 2] < 0).any())
    side = mesh.corner[live][:, 3::-1] if planar else outer_sides(mesh.corner[live])[0]
    node, cells = np.unique(side, return_inverse=True)
    corner = mesh.corner[live].ravel()
    count = np.maximum(np.bincount(corner, minlength=len(mesh.node)), 1)

    def mean(values: Array) -> Array:
        """Mean over the elements that meet at each node."""
        summed = np.bincount(corner, np.repeat(values[live], 8), len(mesh.node))
        return np.asarray((summed / count)[node])

    return {
        "points": state.position[node],
        "cells": cells.reshape(-1, 4),
        "velocity": state.velocity[node],
        "von_mises": mean(von_mises(places, state)),
        "pressure": mean(places.of(state, PRESSURE)),
        "plastic_strain": mean(places.of(state, STRAIN)),
        "temperature": mean(places.of(state, TEMPERATURE)),
        "damage": mean(places.of(state, DAMAGE)),
        "displacement": state.position[node] - mesh.node[node],
    }
