"""Pairs of spheres of any sizes that overlap, for checks of scenes: without compiled code."""

from collections.abc import Iterator

import numpy as np

from quintet.interfaces.component import Array

BATCH = 1_000_000  # pairs that are looked at at a time
FEW = 1000  # spheres of which all pairs are compared


def overlapping(middle: Array, radius: Array) -> Iterator[tuple[Array, Array]]:
    """Pairs of spheres that overlap, each once, the first numbers and the second; (m,) twice.

    Spheres fall into classes of radii within a factor of two; each class is searched by all that
    are not larger.

    Parameters
    ----------
    middle : (n, 3) float array, m
    radius : (n,) float array, m
    """
    if len(radius) <= FEW:
        i, j = np.triu_indices(len(radius), 1)
        near = np.linalg.norm(middle[i] - middle[j], axis=1) < radius[i] + radius[j]
        if near.any():
            yield i[near], j[near]
        return
    # Left out of scenes of few bodies.
    from scipy.spatial import cKDTree

    size = np.floor(np.log2(radius / radius.min(initial=np.inf))) if len(radius) else radius
    for kind in np.unique(size)[::-1]:
        targets, seekers = np.flatnonzero(size == kind), np.flatnonzero(size <= kind)
        tree, reach = cKDTree(middle[targets]), 2.0 * radius[targets].max()
        count = tree.query_ball_point(middle[seekers], reach, return_length=True)
        ends = np.flatnonzero(np.diff(np.cumsum(count) // BATCH)) + 1
        for rows in np.split(seekers, ends):
            pairs = cKDTree(middle[rows]).sparse_distance_matrix(tree, reach, output_type="ndarray")
            i, j = rows[pairs["i"]], targets[pairs["j"]]
            once = (size[i] < size[j]) | (i < j)  # those of one class find each other twice
            near = once & (pairs["v"] < radius[i] + radius[j])
            if near.any():
                yield i[near], j[near]
