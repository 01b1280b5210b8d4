"""Cylinders of elements: a rounded square in the middle, and rings around it."""

import numpy as np

from quintet.components.fe_plate.meshes.arrays import Array, Whole
from quintet.components.fe_plate.meshes.params import MeshedPart
from quintet.components.shared.geometry.shapes import Cylinder

CORE = 0.5  # half the width of the square, as a share of the radius
ROUND = 0.5  # how far its rim goes from a square (0) to a circle (1)
ALONG = ((1, 2, 0), (2, 0, 1), (0, 1, 2))  # places of the disc's axes and of the cylinder's


def cylinder(part: MeshedPart) -> tuple[Array, Whole]:
    """Nodes (n, 3) m and corners (e, 8) of a cylinder, or of its quarter."""
    shape, (core, rings, layers) = part.geometry, part.counts
    assert isinstance(shape, Cylinder)
    flat, quad = quarter_disc(core, rings)
    if not part.quarter:
        flat, quad = whole_disc(flat, quad)
    flat = shape.radius * flat
    height = np.linspace(0.0, shape.length, layers + 1)
    node = np.empty((layers + 1, len(flat), 3))
    first, second, along = ALONG[shape.axis]
    node[:, :, first], node[:, :, second] = flat[:, 0], flat[:, 1]
    node[:, :, along] = height[:, None]
    level = len(flat) * np.arange(layers)[:, None, None]
    corner = np.concatenate([quad + level, quad + level + len(flat)], axis=2)
    return node.reshape(-1, 3) + shape.base, corner.reshape(-1, 8)


def quarter_disc(core: int, rings: int) -> tuple[Array, Whole]:
    """Nodes (n, 2) and corners (q, 4), anticlockwise, of a quarter of a disc of radius 1."""
    u = np.arange(core + 1) / core
    x, y = np.meshgrid(u, u, indexing="ij")
    square = np.stack([x, y], axis=-1)
    middle = CORE * _rounded(square, ROUND * np.maximum(x, y)[..., None])
    rim = np.concatenate([square[-1], square[-2::-1, -1]])  # from the x axis to the y axis
    inner, outer = CORE * _rounded(rim, ROUND), _rounded(rim, 1.0)
    share = np.arange(1, rings + 1)[:, None, None] / rings
    around = (1.0 - share) * inner + share * outer
    node = np.concatenate([middle.reshape(-1, 2), around.reshape(-1, 2)])
    number = np.arange((core + 1) ** 2).reshape(core + 1, core + 1)
    edge = np.concatenate([number[-1], number[-2::-1, -1]])
    more = number.size + np.arange(rings * len(edge)).reshape(rings, -1)
    ring = np.concatenate([edge[None], more])
    return node, np.concatenate([_quads(number), _quads(ring)])


def _rounded(square: Array, share: Array | float) -> Array:
    """Points of a square of half width 1, moved towards circles by a share."""
    size = np.abs(square).max(axis=-1, keepdims=True)
    least = np.abs(square).min(axis=-1, keepdims=True)
    angle = 0.25 * np.pi * np.divide(least, size, out=np.zeros_like(size), where=size > 0.0)
    wide = square[..., :1] >= square[..., 1:]
    circle = size * np.where(
        wide,
        np.concatenate([np.cos(angle), np.sin(angle)], axis=-1),
        np.concatenate([np.sin(angle), np.cos(angle)], axis=-1),
    )
    return np.asarray((1.0 - share) * square + share * circle)


def _quads(number: Whole) -> Whole:
    """Corners of the squares of a grid of nodes."""
    a, b = number[:-1, :-1].ravel(), number[1:, :-1].ravel()
    c, d = number[1:, 1:].ravel(), number[:-1, 1:].ravel()
    return np.stack([a, b, c, d], axis=1)


def whole_disc(node: Array, quad: Whole) -> tuple[Array, Whole]:
    """Four quarters, each turned by a right angle, with the nodes between them once."""
    turned, every = node, [node]
    for _ in range(3):
        turned = np.stack([-turned[:, 1], turned[:, 0]], axis=1)
        every.append(turned)
    points = np.concatenate(every)
    _, first, number = np.unique(
        np.round(points, 9) + 0.0, axis=0, return_index=True, return_inverse=True
    )
    number = number.ravel()
    quads = np.concatenate([quad + k * len(node) for k in range(4)])
    return points[first], number[quads]
