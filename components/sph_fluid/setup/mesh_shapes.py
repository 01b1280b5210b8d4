"""Fluid that fills a closed surface from a file; imported only by a scene that has one."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.geometry import mesh_files
from quintet.components.sph_fluid.setup.geometry import Box
from quintet.interfaces.params import Vector

Array = NDArray[np.float64]


class Mesh(NamedTuple):
    """A closed surface of triangles."""

    triangles: Array  # (t, 3, 3) m
    volume: float  # m3
    box: Box


@lru_cache(maxsize=16)
def read_mesh(file: str, scale: float, position: Vector) -> Mesh:
    """Read a surface; one unit of length in the file stands for `scale` [m]."""
    shape = mesh_files.read(file, scale)
    triangles = shape.triangles + np.array(position)
    low, high = triangles.min(axis=(0, 1)).tolist(), triangles.max(axis=(0, 1)).tolist()
    return Mesh(triangles, shape.volume, ((low[0], low[1], low[2]), (high[0], high[1], high[2])))


def inside_mesh(axes: tuple[Array, Array, Array], triangles: Array) -> NDArray[np.bool_]:
    """Whether places of a lattice are inside; (nx, ny, nz), from its (nx,), (ny,), (nz,) m.

    A ray along x through each row of it leaves the surface where it has entered it.
    """
    x, y, z = axes
    found = np.zeros((len(x), len(y), len(z)), bool)
    low, high = triangles[:, :, 1:].min(axis=1), triangles[:, :, 1:].max(axis=1)
    # A little off the lattice, so that no ray meets an edge.
    aside = mesh_files.AWRY * float(np.ptp(triangles, axis=(0, 1)).max()) * np.sqrt([2.0, 3.0])
    for k, above in enumerate(z + aside[1]):
        layer = np.flatnonzero((low[:, 1] <= above) & (above <= high[:, 1]))
        for j, beside in enumerate(y + aside[0]):
            row = layer[(low[layer, 0] <= beside) & (beside <= high[layer, 0])]
            found[:, j, k] = _along_ray(x, beside, above, triangles[row])
    return found


def _along_ray(x: Array, beside: float, above: float, triangles: Array) -> NDArray[np.bool_]:
    """Which places (n,) m on a ray along x are inside the surface of some triangles."""
    y, z = triangles[:, :, 1].T - beside, triangles[:, :, 2].T - above
    part = np.stack([y[i] * z[j] - z[i] * y[j] for i, j in mesh_files.PAIRS])
    whole = part.sum(axis=0)
    through = (part * whole > 0.0).all(axis=0)
    met = (part * triangles[:, :, 0].T).sum(axis=0)[through] / whole[through]  # m, along x
    turns = np.sign(whole[through])
    # Of a surface that looks outwards, those met beyond a place add up to one more outwards.
    return np.asarray(((met > x[:, np.newaxis]) * turns).sum(axis=1) > 0.0)
