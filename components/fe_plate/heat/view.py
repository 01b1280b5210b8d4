"""What a picture shows of a conducting body: its outer faces, by temperature."""

import numpy as np

from quintet.components.fe_plate.meshes.arrays import Array
from quintet.components.fe_plate.meshes.mesh import Mesh
from quintet.interfaces.component import Fields


def view(mesh: Mesh, temperature: Array) -> Fields:
    """Corners of the outer faces, with temperatures (n,) K."""
    node, cells = np.unique(mesh.side, return_inverse=True)
    return {
        "points": mesh.node[node],
        "cells": cells.reshape(-1, 4),
        "temperature": temperature[node],
    }
