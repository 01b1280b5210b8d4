"""Where bodies may begin: within the tank, and beside the water and the obstacles in it.

They are known by the samples of their surfaces alone. A body that touches overlaps nothing: up to
half a spacing, neither particles nor samples meet.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.sph_fluid.setup.geometry import FACES
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError

TOUCH = 0.55  # spacings by which a body may overlap; samples are spread evenly, not to the spacing
MOST_TOLD = 5  # bodies
OUTSIDE_WATER = (
    "the water",
    "Move it, build the water from boxes around it, or set remove_inside_bodies = true.",
)
OUTSIDE_OBSTACLES = "the obstacles", "Move one of them."


class Room(NamedTuple):
    """Where a fluid begins, and what is around it; boxes are their lowest and highest corners."""

    tank: Bounds | None
    closed: Sequence[str]  # faces of the tank
    water: Sequence[Bounds]
    obstacles: Sequence[Bounds]
    axes: Sequence[int]  # of its dimensions


def refuse_misplaced(body: Array, position: Array, slack: float, room: Room) -> None:
    """Refuse bodies that begin where they must not.

    Parameters
    ----------
    body : (n,) float array
        Number of the body of each sample.
    position : (n, 3) float array, m
        Of the samples.
    slack : float, m
        By which a sample may lie inside what a body must not overlap.
    room : Room
    """
    texts_by_body: dict[float, str] = {}
    for boxes, texts in ((room.water, OUTSIDE_WATER), (room.obstacles, OUTSIDE_OBSTACLES)):
        for number, corners in enumerate(boxes):
            low, high = (np.array(corner) for corner in corners)
            depth = np.minimum(position - low, high - position)[:, room.axes].min(axis=1)
            for k in _deepest(body, depth, slack):
                texts_by_body.setdefault(
                    body[k],
                    f"must begin outside {texts[0]}; its sample at {_place(position[k])} is "
                    f"{depth[k]:.3g} m inside box {number} of {texts[0]}, "
                    f"{_extent(low, high, room.axes)}. {texts[1]}",
                )
    if room.tank is not None:
        _find_outside(texts_by_body, body, position, slack, room.tank, room)
    if texts_by_body:
        mistakes = [f"body {number:g} {text}" for number, text in sorted(texts_by_body.items())]
        raise SceneError(mistakes[:MOST_TOLD])


def _find_outside(
    texts_by_body: dict[float, str],
    body: Array,
    position: Array,
    slack: float,
    tank: Bounds,
    room: Room,
) -> None:
    """Find bodies beyond closed faces of the tank; not those that are to fall in, or have left."""
    low, high = (np.array(corner) for corner in tank)
    faces = [face for face in FACES if "xyz".index(face[0]) in room.axes]
    beyond = {
        face: position[:, axis] - high[axis] if face[1] == "+" else low[axis] - position[:, axis]
        for face in faces
        for axis in ("xyz".index(face[0]),)
    }
    numbers, owner = np.unique(body, return_inverse=True)
    is_outside = np.zeros(len(numbers), bool)
    for face in faces:
        if face not in room.closed:
            nearest = np.full(len(numbers), np.inf)
            np.minimum.at(nearest, owner, beyond[face])
            is_outside |= nearest >= 0.0
    for face in faces:
        if face in room.closed:
            for k in _deepest(body, np.where(is_outside[owner], 0.0, beyond[face]), slack):
                texts_by_body.setdefault(
                    body[k],
                    f"must begin within the tank, {_extent(low, high, room.axes)}; its sample at "
                    f"{_place(position[k])} is {beyond[face][k]:.3g} m beyond face {face}. "
                    "Move it, or open that face.",
                )


def _deepest(body: Array, depth: Array, slack: float) -> Array:
    """Numbers of the deepest samples, one of each body that has samples deeper than it may."""
    rows = np.flatnonzero(depth > slack)
    rows = rows[np.lexsort((-depth[rows], body[rows]))]
    return rows[np.unique(body[rows], return_index=True)[1]]


def _place(position: Array) -> str:
    return f"({', '.join(f'{x:.4g}' for x in position)}) m"


def _extent(low: Array, high: Array, axes: Sequence[int]) -> str:
    return ", ".join(f"{'xyz'[axis]} {low[axis]:g} to {high[axis]:g} m" for axis in axes)
