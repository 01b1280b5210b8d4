"""Fields of continua that nodes sample: filled between the nodes, over a triangulation.

Matplotlib is loaded by the functions that draw: a run without pictures does not need it.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from quintet.coupler.report.view_steps import Quantity, Shown
from quintet.interfaces.component import Array

LONGEST = 3.0  # edge of a triangle over the spacing of its nodes; longer ones span a hole
THIN = 2.0  # depth of a cloud along y, over the spacing, up to which it is a plane of nodes
FEWEST = 3  # nodes of a triangle


def is_field(shown: Shown) -> bool:
    """Whether points are nodes of one plane that sample a continuum, and have values."""
    if shown.spacing is None or shown.values is None or len(shown.points) < FEWEST:
        return False
    return bool(np.ptp(shown.points[:, 1]) <= THIN * float(np.median(shown.spacing)))


def draw_field(panel: Any, shown: Shown, scales: Mapping[Quantity, Any]) -> None:
    """Fill the space between nodes with the colours of their values."""
    # A run without pictures does not load matplotlib.
    from matplotlib.tri import Triangulation

    if shown.quantity is None or shown.quantity not in scales or shown.spacing is None:
        return
    triangles = Triangulation(shown.points[:, 0], shown.points[:, 2])
    triangles.set_mask(spans_a_hole(shown.points, shown.spacing, triangles.triangles))
    scale = scales[shown.quantity]
    panel.tripcolor(
        triangles, shown.values, cmap=scale.cmap, norm=scale.norm, shading="gouraud",
        rasterized=True, zorder=1,
    )  # fmt: skip


def spans_a_hole(points: Array, spacing: Array, triangles: Array) -> Array:
    """Find triangles between nodes that are no neighbours.

    Parameters
    ----------
    points : (n, 3) float array, m
    spacing : (n,) float array, m
        Distance of each node from its nearest.
    triangles : (t, 3) int array

    Returns
    -------
    (t,) bool array
    """
    corners = points[triangles][:, :, [0, 2]]
    edges = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)
    return np.asarray(edges.max(axis=1) > LONGEST * spacing[triangles].max(axis=1))
