"""Bodies filled with lattices of particles."""

import itertools
import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from quintet.components.shared.geometry.lattice import (
    cell_centres,
    cells_along,
    cells_between,
    lattice_points,
)
from quintet.components.shared.geometry.shapes import Cylinder, Mesh, Sphere
from quintet.components.sph_solid.body import Body
from quintet.components.sph_solid.params import SphSolidParams, SymmetryPlane
from quintet.components.sph_solid.state import Array
from quintet.interfaces.errors import SceneError

CUT = 0.25  # spacings from a plane of symmetry, within which it cuts through particles


class Filling(NamedTuple):
    """Particles of one body."""

    points: Array  # (n, 3) m
    volume: Array  # (n,) m3, of each


def filling(body: Body, params: SphSolidParams) -> Filling:
    """Fill a body: cells of a box of its own, half a spacing from the middle of round ones.

    The cells of a box begin at planes of symmetry that cut it. Particles of other bodies share the
    volume of the whole, what planes cut off included.

    Raises
    ------
    SceneError
        Where a layer of a round body or a mesh lies on a plane, and would count whole or not.
    """
    points, share = (_tube if body.inner_radius else FILLINGS[body.shape])(body, params)
    if params.axisymmetric:
        points = points[points[:, 0] > 0.0]
        share = points[:, 0]  # of a ring, by its circumference
    volume = body.volume(params.dimensions, params.axisymmetric) * share / max(share.sum(), 1e-300)
    if body.shape == "box":
        volume *= math.prod(computed_shares(body, params.symmetry))
    for plane in params.symmetry:
        beyond = points[:, "xyz".index(plane.axis)]
        if body.shape != "box" and not body.inner_radius:
            _refuse_cut_layers(beyond, plane, params.spacing)
        computed = (beyond > plane.position) == (plane.side == "+")
        points, volume = points[computed], volume[computed]
    return Filling(points, volume)


def computed_corners(body: Body, planes: Sequence[SymmetryPlane]) -> tuple[Array, Array]:
    """Lowest and highest corner (3,) m of what planes of symmetry leave of a body's box.

    The lowest is beyond the highest where nothing is left.
    """
    low, high = (np.array(corner) for corner in body.bounds)
    for plane in planes:
        k = "xyz".index(plane.axis)
        if plane.side == "+":
            low[k] = max(low[k], plane.position)
        else:
            high[k] = min(high[k], plane.position)
    return low, high


def computed_shares(body: Body, planes: Sequence[SymmetryPlane]) -> list[float]:
    """Shares of the edges (3,) of a body's box that planes of symmetry leave."""
    whole = zip(*body.bounds, strict=True)
    part = zip(*computed_corners(body, planes), strict=True)
    return [
        max(end - begin, 0.0) / (high - low)
        for (low, high), (begin, end) in zip(whole, part, strict=True)
    ]


def _refuse_cut_layers(places: Array, plane: SymmetryPlane, spacing: float) -> None:
    """Refuse particles (n,) m that a plane of symmetry halves: their images lie in them."""
    nearest = float(np.abs(places - plane.position).min(initial=math.inf))
    if nearest < CUT * spacing:
        raise SceneError(
            f"a plane of symmetry must lie between layers of particles, {CUT:g} spacings from each "
            f"at least; that at {plane.axis} = {plane.position:g} m is {nearest:.3g} m from one. "
            "Move the body or the plane, or take a spacing with another number of layers."
        )


def _box(body: Body, params: SphSolidParams) -> tuple[Array, Array]:
    ends = body.bounds if body.shape == "mesh" else computed_corners(body, params.symmetry)
    if 0.0 in computed_shares(body, params.symmetry):  # all is behind a plane
        return np.zeros((0, 3)), np.zeros(0)
    axes = [cells_along(low, high, params.spacing) for low, high in zip(*ends, strict=True)]
    if params.dimensions == 2:
        axes[1] = np.zeros(1)
    points = lattice_points(axes)
    return points, np.ones(len(points))


def _round(body: Body, params: SphSolidParams) -> tuple[Array, Array]:
    """Points of a lattice about the centre that are in a sphere or cylinder."""
    low, high = body.bounds
    shape = body.geometry
    assert isinstance(shape, Sphere | Cylinder)
    radius, along = shape.radius, shape.axis if isinstance(shape, Cylinder) else None
    centre = np.array(low) / 2.0 + np.array(high) / 2.0
    axes = []
    for axis in range(3):
        if axis == along:
            edge = high[axis] - low[axis]
            axes.append(cells_along(-0.5 * edge, 0.5 * edge, params.spacing))
        else:
            half = math.ceil(radius / params.spacing)
            axes.append(cell_centres(-half * params.spacing, half * params.spacing, 2 * half))
    if params.dimensions == 2:
        axes[1], centre[1] = np.zeros(1), 0.0
    points = lattice_points(axes)
    squares = points**2
    if along is not None:
        squares[:, along] = 0.0
    points = points[squares.sum(axis=1) <= radius * radius] + centre
    return points, np.ones(len(points))


def _tube(body: Body, params: SphSolidParams) -> tuple[Array, Array]:
    """Points on circles, alike before the two planes through the axis, and volumes of each."""
    shape = body.geometry
    assert isinstance(shape, Cylinder) and shape.inner_radius is not None
    low, high = shape.bounds
    along, inner, outer = shape.axis, shape.inner_radius, shape.radius
    layers = cells_between(inner, outer, params.spacing)
    edges = np.linspace(inner, outer, layers + 1)
    circles, shares = [], []
    for a, b in itertools.pairwise(edges):
        radius = 0.5 * (a + b)
        count = 4 * max(1, round(0.5 * math.pi * radius / params.spacing))
        angle = 2.0 * math.pi * (np.arange(count) + 0.5) / count
        circles.append(radius * np.stack([np.cos(angle), np.sin(angle)], axis=1))
        shares.append(np.full(count, (b * b - a * a) / count))
    circle, share = np.concatenate(circles), np.concatenate(shares)
    heights = cells_along(low[along], high[along], params.spacing)
    if params.dimensions == 2:
        heights = np.zeros(1)
    points = np.empty((len(heights), len(circle), 3))
    points[:, :, along] = heights[:, None]
    for column, axis in enumerate(axis for axis in range(3) if axis != along):
        points[:, :, axis] = circle[:, column] + 0.5 * (low[axis] + high[axis])
    return points.reshape(-1, 3), np.tile(share, len(heights))


def _mesh(body: Body, params: SphSolidParams) -> tuple[Array, Array]:
    """Points of a lattice in a closed surface."""
    shape = body.geometry
    assert isinstance(shape, Mesh)
    points, share = _box(body, params)
    within = shape.contains(*points.T)
    return points[within], share[within]


FILLINGS = {"box": _box, "sphere": _round, "cylinder": _round, "mesh": _mesh}


def starting_velocity(body: Body, points: Array) -> Array:
    """Velocity (n, 3) m/s at points (n, 3) m: of the middle, of rotation and of strain about it."""
    low, high = body.bounds
    arms = points - 0.5 * (np.array(low) + np.array(high))
    strain = arms @ np.array(body.velocity_gradient).T
    return np.array(body.velocity) + np.cross(np.array(body.angular_velocity), arms) + strain
