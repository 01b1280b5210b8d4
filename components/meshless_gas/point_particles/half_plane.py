"""Particles about an axis of symmetry, turned into the half-plane of nodes and back.

Where the flow has an axis, each particle stands for grains that are spread evenly round the circle
on which it is: its parcel is that of the whole ring, as volumes of nodes are.
"""

import numpy as np

from quintet.interfaces.component import Array


def azimuths_of(position: Array, axis: Array) -> Array:
    """Cosine and sine (p, 2) of the azimuth about x, from the half-plane z > 0, y = 0.

    Parameters
    ----------
    position : (p, 3) m
    axis : (3,) m
        A point of it.
    """
    y, z = (position - axis)[:, 1:].T
    radius = np.hypot(y, z)
    apart = radius > 0.0
    safe = np.where(apart, radius, 1.0)
    return np.stack([np.where(apart, z / safe, 1.0), np.where(apart, y / safe, 0.0)], axis=1)


def to_half_plane(azimuths: Array, vectors: Array) -> Array:
    """Vectors (p, 3) as they are seen from the half-plane."""
    cosine, sine = azimuths.T
    x, y, z = vectors.T
    return np.stack([x, cosine * y - sine * z, sine * y + cosine * z], axis=1)


def from_half_plane(azimuths: Array, vectors: Array) -> Array:
    """Vectors (p, 3) of the half-plane where the particles are."""
    return to_half_plane(azimuths * np.array([1.0, -1.0]), vectors)
