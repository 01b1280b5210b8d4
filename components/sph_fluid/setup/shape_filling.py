"""Particles of fluid in other shapes than boxes; imported only by a scene that has some.

A shape is cut into the cells of the box around it, as boxes are; a sphere, and a cylinder across
its axis, into cells of the spacing. It gets as many particles as it has volumes of a cell, in the
cells of which it has the largest part.
"""

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.geometry.lattice import cell_centres, lattice_points
from quintet.components.sph_fluid.setup.prisms import inside_polygon
from quintet.components.sph_fluid.setup.shapes import ACROSS, FluidShape

Array = NDArray[np.float64]
FINE = 4  # places along each edge of a cell that are looked at
TURN = 0.5 * (5.0**0.5 - 1.0)  # scatters cells of which a shape has equal parts


class Edge(NamedTuple):
    """Cells along one axis."""

    low: float  # m
    high: float  # m
    cells: int

    @property
    def step(self) -> float:
        """Length of a cell [m]."""
        return (self.high - self.low) / self.cells


def edges(shape: FluidShape, spacing: float, planar: bool) -> list[Edge]:
    """Cells that a shape is cut into; `planar`: one along y."""
    found = []
    for axis, low, high in zip("xyz", *shape.box, strict=True):
        if shape.shape == "sphere" or (shape.shape == "cylinder" and axis != shape.axis):
            count = math.ceil((high - low) / spacing)
            middle, half = 0.5 * (low + high), 0.5 * count * spacing
            found.append(Edge(middle - half, middle + half, count))
        else:
            count = 1 if planar and axis == "y" else max(1, round((high - low) / spacing))
            found.append(Edge(low, high, count))
    return found


def particle_count(shape: FluidShape, spacing: float, planar: bool) -> int:
    """Particles that fill a shape."""
    cell = math.prod(edge.step for edge in edges(shape, spacing, planar))
    return max(1, round(shape.volume / cell))


@lru_cache(maxsize=16)
def fill_shape(shape: FluidShape, spacing: float, planar: bool) -> Array:
    """Middles (n, 3) m of the cells that a shape fills, x fastest."""
    cut = edges(shape, spacing, planar)
    axes = [cell_centres(*edge) for edge in cut]
    part = _parts(shape, cut, axes, planar)
    order = np.lexsort((np.mod(np.arange(part.size) * TURN, 1.0), -part))
    kept = np.sort(order[: particle_count(shape, spacing, planar)])
    return lattice_points(axes)[kept]


def _parts(shape: FluidShape, cut: list[Edge], axes: list[Array], planar: bool) -> Array:
    """Part of each cell that is inside, x fastest; one layer of cells after another."""
    inner = (np.arange(FINE) + 0.5) / FINE - 0.5
    finer = [
        (place[:, np.newaxis] + inner * edge.step).ravel()
        for place, edge in zip(axes, cut, strict=True)
    ]
    if planar:
        finer[1] = axes[1]
    shares = len(axes[0]), FINE, len(axes[1]), 1 if planar else FINE, FINE
    found = []
    for layer in range(cut[2].cells):
        z = finer[2][layer * FINE : (layer + 1) * FINE]
        some = inside_lattice(shape, (finer[0], finer[1], z)).reshape(shares)
        found.append(some.mean(axis=(1, 3, 4)).T.ravel())
    return np.concatenate(found)


def inside_lattice(shape: FluidShape, axes: tuple[Array, Array, Array]) -> NDArray[np.bool_]:
    """Whether places of a lattice are in a shape; (nx, ny, nz), from its (nx,), (ny,), (nz,) m."""
    if shape.shape == "mesh":
        # The reader of meshes is left out of scenes without any.
        from quintet.components.sph_fluid.setup.mesh_shapes import inside_mesh, read_mesh

        assert shape.file is not None
        return inside_mesh(axes, read_mesh(shape.file, shape.scale, shape.position).triangles)
    x, y, z = np.meshgrid(*axes, indexing="ij", sparse=True)
    return np.broadcast_to(inside(shape, x, y, z), tuple(map(len, axes)))


def inside(shape: FluidShape, x: Array, y: Array, z: Array) -> NDArray[np.bool_]:
    """Whether places [m] are in a sphere, cylinder or prism."""
    places = x, y, z
    one, other = (places[axis] for axis in ACROSS[shape.axis])
    along = places["xyz".index(shape.axis)]
    if shape.corners is not None and shape.ends is not None:
        within = (along > shape.ends[0]) & (along < shape.ends[1])
        return within & inside_polygon(one, other, np.array(shape.corners))
    assert shape.centre is not None and shape.diameter is not None
    radius2 = 0.25 * shape.diameter**2
    a, b = (shape.centre[axis] for axis in ACROSS[shape.axis])
    c = shape.centre["xyz".index(shape.axis)]
    aside2 = (one - a) ** 2 + (other - b) ** 2
    if shape.shape == "sphere":
        return np.asarray(aside2 + (along - c) ** 2 < radius2)
    return (np.abs(along - c) < 0.5 * (shape.height or 0.0)) & (aside2 < radius2)
