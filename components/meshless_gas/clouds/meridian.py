"""Clouds about an axis of symmetry: one half-plane of nodes, and ghosts turned out of it."""

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from quintet.components.meshless_gas.blunt_bodies import shock_radius
from quintet.components.meshless_gas.clouds.cloud import Whole
from quintet.components.meshless_gas.clouds.grading import geometric
from quintet.components.meshless_gas.clouds.layers import (
    Bounds,
    LayeredCloud,
    Sides,
    SurfaceGrid,
    kinds_of,
    layered,
    rotations,
)
from quintet.interfaces.component import Array

WIDEST = math.pi / 3.0  # rad, between a node near the axis and its ghosts


class Reach(NamedTuple):
    """How far a cloud round a body reaches, and how finely it is divided."""

    rays: int
    layers: int
    first: float  # m, thickness of the first layer
    sector: float  # rad, from the direction against the flow; π for all of the body
    margin: float  # distance of the last layer over that of the shock
    farthest: float  # m, of the last layer from the centre
    jitter: float = 0.0  # displacement over the distance of neighbours
    seed: int = 0
    weight: float = 2.0  # of the least squares
    is_cross: bool = False  # neighbours of other layers: only what is straight above and below


class SphereInStream(NamedTuple):
    """A sphere whose centre lies on the axis of a stream along x."""

    centre: Array  # (3,) m
    radius: float  # m
    mach: float  # above 1 a cloud follows the bow shock, else it is a shell


def sphere_meridian(sphere: SphereInStream, reach: Reach, sides: Sides) -> LayeredCloud:
    """Nodes round a sphere in the half-plane z > 0 of a flow along x.

    Parameters
    ----------
    sphere : SphereInStream
    reach : Reach
    sides : Sides
        The "wall", "far" and, where gas leaves, the "exit".

    Returns
    -------
    LayeredCloud
    """
    centre, radius, mach = sphere
    is_closed = reach.sector > math.pi - 1e-9
    step = reach.sector / (reach.rays if is_closed else reach.rays - 0.5)
    angle = (np.arange(reach.rays) + 0.5) * step  # the last lies on the edge of an open sector
    outward = np.stack([-np.cos(angle), np.zeros(reach.rays), np.sin(angle)], axis=1)
    outer = outer_radius(angle, radius, mach, reach)
    distance = geometric(reach.first, outer - radius, reach.layers)
    places = centre + outward * (radius + distance)[:, :, None]
    displace(places, reach)
    surface = _meridian_surface(angle, step, is_closed)
    bound = np.minimum(angle + 0.5 * step, reach.sector)
    ring = 2.0 * math.pi * (np.cos(angle - 0.5 * step) - np.cos(bound))
    bounds = Bounds(
        np.full(reach.rays, sides.patches["wall"], np.int32),
        last_patch(angle, outer, reach, sides.patches),
        np.where(surface.is_edge, sides.patches["exit"], 0).astype(np.int32),
        kinds_of(sides),
        outward,
        ring * (radius + distance) ** 2,
        _frusta(np.append(angle - 0.5 * step, bound[-1]), radius, mach, reach),
        _cone(angle[-1], radius + distance, surface),
        reach.weight,
    )
    return layered(places, surface, bounds, reach.is_cross)


def _frusta(angle: Array, radius: float, mach: float, reach: Reach) -> Array:
    """Areas (m, 3) m2 into the gas of the last layer between m + 1 angles, as whole rings."""
    outer = outer_radius(angle, radius, mach, reach)
    x, z = -outer * np.cos(angle), outer * np.sin(angle)
    along = math.pi * (z[1:] ** 2 - z[:-1] ** 2)
    across = -math.pi * (z[1:] + z[:-1]) * (x[1:] - x[:-1])
    return np.stack([along, np.zeros(len(along)), across], axis=1)


def _cone(angle: float, radii: Array, surface: SurfaceGrid) -> Array:
    """Areas (layers, m, 3) m2 into the gas of the cone that the last ray sweeps, layer by layer."""
    sides = np.zeros((*radii.shape, 3))
    if surface.is_edge[-1]:
        ends = np.concatenate(
            [radii[:1, -1], 0.5 * (radii[1:, -1] + radii[:-1, -1]), radii[-1:, -1]]
        )
        area = math.pi * math.sin(angle) * np.diff(ends**2)
        sides[:, -1] = area[:, None] * np.array([-math.sin(angle), 0.0, -math.cos(angle)])
    return sides


def last_patch(angle: Array, outer: Array, reach: Reach, patches: Mapping[str, int]) -> Whole:
    """Number (m,) of the boundary at the last layer: gas leaves downstream, within the shock."""
    leaves = (angle > 0.5 * math.pi) & (outer >= reach.farthest * (1.0 - 1e-9))
    return np.where(leaves, patches["exit"], patches["far"]).astype(np.int32)


def outer_radius(angle: Array, radius: float, mach: float, reach: Reach) -> Array:
    """Distance (n,) m of the last layer from the centre."""
    if mach <= 1.0:
        return np.full(len(angle), reach.farthest)
    gap = shock_radius(angle, mach) - 1.0
    wanted = radius * (1.0 + reach.margin * gap)
    return np.minimum(np.maximum(wanted, radius * 1.02), reach.farthest)


def _meridian_surface(angle: Array, step: float, is_closed: bool) -> SurfaceGrid:
    """Each ray has one before and one after it, and two of its own, turned about the axis."""
    count = len(angle)
    turn = np.minimum(step / np.sin(angle), WIDEST)
    source = np.concatenate([np.arange(count), np.arange(count), [0]])
    turns = np.concatenate([turn, -turn, [math.pi]])
    ray = np.arange(count)
    before, after = ray - 1, ray + 1
    before[0] = count + 2 * count  # the first, half a turn away
    if is_closed:
        source, turns = np.append(source, count - 1), np.append(turns, math.pi)
        after[-1] = count + 2 * count + 1
    else:
        after[-1] = -1
    neighbours = np.stack([before, after, ray + count, ray + 2 * count], axis=1)
    is_edge = np.zeros(count, bool)
    is_edge[-1] = not is_closed
    return SurfaceGrid(
        neighbours.astype(np.int32),
        source.astype(np.int32),
        rotations(turns),
        is_edge,
    )


def displace(places: Array, reach: Reach) -> None:
    """Move nodes between walls at random, along their ray and across it."""
    if reach.jitter == 0.0:
        return
    random = np.random.default_rng(reach.seed)
    along, across = random.uniform(-0.5, 0.5, (2, *places.shape[:2]))
    over = np.zeros_like(places)
    gap = np.diff(places, axis=0)
    thinner = (gap[1:] ** 2).sum(axis=2) < (gap[:-1] ** 2).sum(axis=2)
    over[1:-1] = np.where(thinner[:, :, None], gap[1:], gap[:-1])
    beside = np.zeros_like(places)
    beside[:, 1:-1] = 0.5 * (places[:, 2:] - places[:, :-2])
    moved = reach.jitter * (along[:, :, None] * over + across[:, :, None] * beside)
    places[1:-1, 1:-1] += moved[1:-1, 1:-1]
