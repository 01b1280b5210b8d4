"""Where the buffers of inflows and outflows are, and where their particles begin."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.geometry.lattice import cells_along
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.setup.geometry import Face
from quintet.components.sph_fluid.setup.inflow_outflow import Inflow, buffer_layers
from quintet.components.sph_fluid.setup.tait import TAIT
from quintet.components.sph_fluid.state import Array


class Zone(NamedTuple):
    """A buffer behind a face of the tank."""

    name: str  # "inflow x-"
    axis: int
    inward: float  # 1 or -1, along the axis
    face: float  # m, along the axis
    length: float  # m, from the face inwards
    step: float  # m, between its layers

    def depth(self, points: Array) -> Array:
        """How far (n,) m points (n, 3 or more) m are inside the tank, from the face."""
        return np.asarray(self.inward * (points[:, self.axis] - self.face))

    def holds(self, points: Array) -> NDArray[np.bool_]:
        """Which points (n, 3 or more) m lie in it, or beyond its face."""
        return np.asarray(self.depth(points) < self.length)


def sites(params: SphFluidParams, inflow: Inflow) -> Array:
    """Places (n, 3) m in the face of an inflow at which particles enter, a spacing apart."""
    axes, (axis, _, face) = _cells(params, inflow), _place(params, inflow.face)
    axes[axis] = np.array([face])
    x, y, z = np.meshgrid(*axes, indexing="ij")
    return np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)


def _cells(params: SphFluidParams, inflow: Inflow) -> list[Array]:
    """Middles [m] of the cells of a tank along x, y and z, up to the level of an inflow."""
    assert params.boundary.tank is not None
    low, high = (list(corner) for corner in params.boundary.tank)
    if inflow.level is not None:
        high[2] = inflow.level
    axes = [cells_along(a, b, params.spacing) for a, b in zip(low, high, strict=True)]
    if params.dimensions == 2:
        axes[1] = np.array([0.5 * (low[1] + high[1])])
    return axes


def _place(params: SphFluidParams, face: Face) -> tuple[int, float, float]:
    """Axis, direction inwards and place [m] of a face of the tank."""
    assert params.boundary.tank is not None
    axis, upper = "xyz".index(face[0]), face[1] == "+"
    return axis, -1.0 if upper else 1.0, params.boundary.tank[upper][axis]


def inflow_zone(params: SphFluidParams, inflow: Inflow) -> Zone:
    """Buffer of an inflow: of layers so thick that its particles have the fluid's mass."""
    assert params.boundary.tank is not None
    axis, inward, face = _place(params, inflow.face)
    low, high = params.boundary.tank
    top = high[2] if inflow.level is None else inflow.level
    edges = [b - a for a, b in zip(low, (*high[:2], top), strict=True)]
    if params.dimensions == 2:
        edges[1] = 1.0
    edges[axis] = 1.0
    step = params.particle_volume * len(sites(params, inflow)) / math.prod(edges)
    return Zone(
        f"inflow {inflow.face}", axis, inward, face, buffer_layers(params.smoothing) * step, step
    )


def outflow_zone(params: SphFluidParams, face: Face) -> Zone:
    """Buffer of an outflow."""
    length = buffer_layers(params.smoothing) * params.spacing
    return Zone(f"outflow {face}", *_place(params, face), length, params.spacing)


def zones(params: SphFluidParams) -> list[Zone]:
    """Buffers of all inflows, then of all outflows."""
    edge = params.boundary
    entrances = [inflow_zone(params, inflow) for inflow in edge.inflow]
    return entrances + [outflow_zone(params, outflow.face) for outflow in edge.outflow]


def at_rest(points: Array, level: float, params: SphFluidParams) -> Array:
    """Density (n,) kg/m3 of fluid at rest below a level [m], at points (n, 3) m."""
    weight = params.density * abs(params.gravity[2])  # N/m3
    return under_pressure(weight * np.maximum(level - points[:, 2], 0.0), params)


def under_pressure(pressure: Array, params: SphFluidParams) -> Array:
    """Density (n,) kg/m3 of fluid under a pressure (n,) Pa, by Tait's equation."""
    stiffness = params.sound_speed**2 * params.density / TAIT
    return np.asarray(params.density * (1.0 + pressure / stiffness) ** (1.0 / TAIT))
