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

VALUES = ("von_mises", "pressure", "plastic_strain", "temperature", "damage")  # of elements


def von_mises(places: Places, state: State) -> Array:
    """Equivalent stress (e,) Pa of the elements' mean deviators."""
    xx, yy, zz, xy, yz, zx = places.rows(state, DEVIATOR, 6)
    squares = 1.5 * (xx * xx + yy * yy + zz * zz) + 3.0 * (xy * xy + yz * yz + zx * zx)
    return np.asarray(np.sqrt(squares))


def shown(places: Places, state: State) -> Array:
    """What a view shows of elements (e, 6): whether they are left, and the values of `VALUES`."""
    means = [places.of(state, row) for row in (PRESSURE, STRAIN, TEMPERATURE, DAMAGE)]
    return np.column_stack([places.active(state), von_mises(places, state), *means])


def view(mesh: Mesh, motion: Array, elements: Array) -> Fields:
    """Corners of the outer faces of what is left, in a plane of its elements; means at each.

    Parameters
    ----------
    mesh
    motion : (n, 6) float array, m and m/s
        Positions and velocities of the nodes.
    elements : (e, 6) float array
        As of `shown`.
    """
    live = np.flatnonzero(elements[:, 0])
    planar = bool((mesh.side[:1, 2] < 0).any())
    side = mesh.corner[live][:, 3::-1] if planar else outer_sides(mesh.corner[live])[0]
    corners = 3 if mesh.has_tetrahedra else 4
    node, cells = np.unique(side[:, :corners], return_inverse=True)
    corner = mesh.corner[live].ravel()
    count = np.maximum(np.bincount(corner, minlength=len(mesh.node)), 1)

    def mean(values: Array) -> Array:
        """Mean over the elements that meet at each node."""
        summed = np.bincount(corner, np.repeat(values[live], mesh.corner.shape[1]), len(mesh.node))
        return np.asarray((summed / count)[node])

    return {
        "points": motion[node, :3],
        "cells": cells.reshape(-1, corners),
        "velocity": motion[node, 3:],
        **{name: mean(elements[:, 1 + k]) for k, name in enumerate(VALUES)},
        "displacement": motion[node, :3] - mesh.node[node],
    }
