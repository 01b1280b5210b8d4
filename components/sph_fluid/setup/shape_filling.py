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

from quintet.components.shared.geometry.lattice import cell_centres, cells_between, lattice_points
from quintet.components.shared.geometry.shapes import Cylinder, Sphere
from quintet.components.sph_fluid.setup.shapes import FluidRegion

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


def edges(shape: FluidRegion, spacing: float, planar: bool) -> list[Edge]:
    """Cells that a shape is cut into; `planar`: one along y."""
    body, axis_edges = shape.geometry, []
    for axis, low, high in zip(range(3), *body.bounds, strict=True):
        if isinstance(body, Sphere) or (isinstance(body, Cylinder) and axis != body.axis):
            count = math.ceil((high - low) / spacing)
            middle, half = 0.5 * (low + high), 0.5 * count * spacing
            axis_edges.append(Edge(middle - half, middle + half, count))
        else:
            count = 1 if planar and axis == 1 else cells_between(low, high, spacing)
            axis_edges.append(Edge(low, high, count))
    return axis_edges


def particle_count(shape: FluidRegion, spacing: float, planar: bool) -> int:
    """Particles that fill a shape."""
    cell = math.prod(edge.step for edge in edges(shape, spacing, planar))
    return max(1, round(shape.volume / cell))


@lru_cache(maxsize=16)
def fill_shape(shape: FluidRegion, spacing: float, planar: bool) -> Array:
    """Middles (n, 3) m of the cells that a shape fills, x fastest."""
    axis_edges = edges(shape, spacing, planar)
    axes = [cell_centres(*edge) for edge in axis_edges]
    part = _parts(shape, axis_edges, axes, planar)
    order = np.lexsort((np.mod(np.arange(part.size) * TURN, 1.0), -part))
    filled = np.sort(order[: particle_count(shape, spacing, planar)])
    return lattice_points(axes)[filled]


def _parts(shape: FluidRegion, axis_edges: list[Edge], axes: list[Array], planar: bool) -> Array:
    """Part of each cell that is inside, x fastest; one layer of cells after another."""
    inner = (np.arange(FINE) + 0.5) / FINE - 0.5
    finer = [
        (place[:, np.newaxis] + inner * edge.step).ravel()
        for place, edge in zip(axes, axis_edges, strict=True)
    ]
    if planar:
        finer[1] = axes[1]
    shares = len(axes[0]), FINE, len(axes[1]), 1 if planar else FINE, FINE
    body, sizes = shape.geometry, (len(finer[0]), len(finer[1]), FINE)
    parts = []
    for layer in range(axis_edges[2].cells):
        z = finer[2][layer * FINE : (layer + 1) * FINE]
        places = np.meshgrid(finer[0], finer[1], z, indexing="ij", sparse=True)
        is_inside = np.broadcast_to(body.contains(*places), sizes).reshape(shares)
        parts.append(is_inside.mean(axis=(1, 3, 4)).T.ravel())
    return np.concatenate(parts)
