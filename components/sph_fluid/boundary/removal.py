"""Removing the fluid that bodies stand in; numpy alone, imported only by a scene that asks.

Bodies that are sampled are convex: a point is inside if it lies behind the surface at each of the
outermost samples, whose mirror images say where the surface is and how it is turned.
"""

import math

import numpy as np
from numpy.typing import NDArray

from quintet.components.sph_fluid.boundary.samples import Samples
from quintet.components.sph_fluid.pairs.constants import constants
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.setup.geometry import slab_thickness
from quintet.components.sph_fluid.state import Array, State
from quintet.interfaces.component import Fields

OUTERMOST = 2.2  # spacings, between a sample of the first layer and its mirror image, at most
AT_ONCE = 4_000_000  # pairs of particles and samples


def remove(state: State, samples: Samples, fields: Fields, params: SphFluidParams) -> list[str]:
    """Remove fluid inside bodies, where their samples are; say how much."""
    position, mirror = fields["surface.position"], fields["surface.mirror"]
    points = state.position_density[: state.fluid, :3].copy()
    if params.dimensions == 2:
        points[:, 1] = position[:, 1].mean()
    found, told = np.zeros(len(points), bool), []
    mass = constants(params).mass * slab_thickness(params)
    for number in np.unique(samples.body):
        own = samples.body == number
        inside = inside_body(points, position[own], mirror[own], params.spacing) & ~found
        if count := int(inside.sum()):
            told.append(
                f"body {number:g} stood in the fluid: {count} particles inside it, "
                f"{count * mass:.4g} kg, were removed"
            )
        found |= inside
    state.keep(np.flatnonzero(~found), np.arange(len(state.sample)))
    samples.find_rows(state)
    return told


def inside_body(points: Array, position: Array, mirror: Array, spacing: float) -> NDArray[np.bool_]:
    """Whether points (n, 3) m are inside a convex body with these samples and images (k, 3) m."""
    across = mirror - position
    size = np.linalg.norm(across, axis=1)
    outermost = (size > 0.0) & (size < OUTERMOST * spacing)
    normal = across[outermost] / size[outermost, np.newaxis]
    found = np.zeros(len(points), bool)
    if not len(normal):
        return found
    level = (0.5 * (position + mirror)[outermost] * normal).sum(axis=1)  # m, along the normals
    low, high = position.min(axis=0) - spacing, position.max(axis=0) + spacing
    rows = np.flatnonzero(((points > low) & (points < high)).all(axis=1))
    parts = max(1, math.ceil(len(rows) * len(normal) / AT_ONCE))
    for some in np.array_split(rows, parts):
        found[some] = (points[some] @ normal.T < level).all(axis=1)
    return found
