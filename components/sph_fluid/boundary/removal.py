"""Removing the fluid in which bodies stand; numpy alone, imported only by a scene that asks.

A body displaces its volume of fluid: as many particles are removed as the samples' cells in the
fluid hold, those in the midst of the samples first. So the fluid keeps its volume, and pushes the
body up by its own weight, whatever its shape and wherever the lattice of particles lies.
"""

import numpy as np
from numpy.typing import NDArray

from quintet.components.sph_fluid.boundary.samples import Samples
from quintet.components.sph_fluid.constants import constants
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import Array, State


def remove(state: State, samples: Samples, position: Array, params: SphFluidParams) -> list[str]:
    """Remove the fluid that bodies of links with samples at (k, 3) m displace; say how much."""
    # Samples of pistons come after those of links; a scene has no fluid where pistons are.
    body, volume = samples.body[: len(position)], samples.volume[: len(position)]
    axes = [0, 2] if params.dimensions == 2 else [0, 1, 2]
    points, position = state.position_density[: state.fluid, axes], position[:, axes]
    is_removed, notes = np.zeros(len(points), bool), []
    mass = constants(params).mass * params.slab_thickness
    for number in np.unique(body):
        of_body = body == number
        rows_left = np.flatnonzero(~is_removed)
        rows = rows_left[
            displaced(points[rows_left], position[of_body], volume[of_body], params.spacing)
        ]
        if len(rows):
            notes.append(
                f"body {number:g} stood in the fluid: {len(rows)} particles inside it, "
                f"{len(rows) * mass:.4g} kg, were removed"
            )
        is_removed[rows] = True
    state.removed += int((is_removed & (state.role == 0) if len(state.role) else is_removed).sum())
    state.keep(np.flatnonzero(~is_removed), np.arange(len(state.sample)))
    samples.find_rows(state)
    return notes


def displaced(points: Array, position: Array, volume: Array, spacing: float) -> NDArray[np.int64]:
    """Numbers of the particles that a body displaces.

    Parameters
    ----------
    points : (n, d) float array, m
        Of fluid, on a lattice.
    position : (k, d) float array, m
        Of samples that fill the body.
    volume : (k,) float array, m3, or m2 of a plane
        That they stand for.
    spacing : float, m
        Of the lattice.
    """
    count = round(float(filled(points, position, volume, spacing).sum()))
    # In a wider cube corners of a body count more than what lies beside its faces.
    order = np.argsort(-filled(points, position, volume, 2.0 * spacing), kind="stable")
    return np.asarray(order[:count], np.int64)


def filled(points: Array, position: Array, volume: Array, width: float) -> Array:
    """Share (n,) of a cube of a width [m] around each point that cells of samples fill."""
    # Left out of scenes whose fluid has room for the bodies.
    from scipy.spatial import cKDTree

    dimensions = points.shape[1]
    edge = volume ** (1.0 / dimensions)  # (k,) m
    reach = 0.5 * (width + float(edge.max()))
    pairs = cKDTree(points).sparse_distance_matrix(
        cKDTree(position), reach, p=np.inf, output_type="ndarray"
    )
    i, j = pairs["i"], pairs["j"]
    distance = np.abs(points[i] - position[j])
    common = 0.5 * (width + edge[j])[:, np.newaxis] - distance  # m, of two intervals side by side
    common = np.clip(common, 0.0, np.minimum(width, edge[j])[:, np.newaxis])
    shares = common.prod(axis=1) / width**dimensions
    return np.bincount(i, shares, len(points)).astype(np.float64)
