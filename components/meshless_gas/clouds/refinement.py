"""Finer nodes in parts of a box: cells that are halved along each axis, level by level."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from quintet.interfaces.component import Array

Rows = NDArray[np.int64]
Flags = NDArray[np.bool_]


class FinePart(NamedTuple):
    """A part of a box, within which cells are halved so many times."""

    lowest: Array  # (3,) m
    highest: Array  # (3,) m
    levels: int
    width: float  # 1, of each level in between, in its own spacings


class Cells(NamedTuple):
    """Cells of nodes, each halved along all axes as often as its level says."""

    origin: Rows  # (n,) cell of the lattice that each is a part of
    positions: Array  # (n, 3) m
    widths: Array  # (n, 3) m
    level: Rows  # (n,)


def transition(levels: int, depth: int, width: float, spacing: float) -> float:
    """Distance [m] from a fine part within which cells of a level are halved.

    Parameters
    ----------
    levels : int
        Of the part.
    depth : int
        Level of the cells.
    width : float, 1
        Of each level in between, in its own spacings.
    spacing : float, m
        Of the lattice, level 0.
    """
    return sum(width * spacing / 2**level for level in range(depth + 1, levels))


def wrong_part(
    part: FinePart, box: tuple[Array, Array], spacing: float, faces: Mapping[str, str]
) -> str | None:
    """What is wrong with a part of a box, if anything.

    Parameters
    ----------
    part : FinePart
    box : (3,) and (3,) m
        Its corners.
    spacing : float, m
    faces
        What is at each face, ``x-`` to ``z+`` or without y: those with nodes of their own keep
        the spacing.
    """
    away = transition(part.levels, 0, part.width, spacing)
    for face, kind in faces.items():
        d, side = "xyz".index(face[0]), 1 if face[1] == "+" else 0
        low, high = part.lowest[d], part.highest[d]
        if low >= high:
            return f"the highest corner must lie beyond the lowest along {face[0]}. Correct it."
        if low >= box[1][d] or high <= box[0][d]:
            return f"a finer part lies outside of the box along {face[0]}. Correct its corners."
        is_whole = low <= box[0][d] and high >= box[1][d]
        if kind == "symmetry" or (kind == "periodic" and (is_whole or part.levels == 1)):
            continue
        free = (high + away - box[1][d]) if side else (box[0][d] - low + away)
        if free > (0.0 if kind == "periodic" else -spacing):
            return (
                f"a finer part and the levels around it, {away:.4g} m, come too near to the face "
                f"{face}, whose nodes keep the spacing. Move its corners, or take fewer levels."
            )
    return None


def halved(
    positions: Array,
    widths: Array,
    is_divisible: Flags,
    spacing: float,
    parts: Sequence[FinePart],
    axes: tuple[int, ...],
) -> Cells:
    """Halve the cells of a lattice in fine parts, and around them level by level.

    Parameters
    ----------
    positions, widths : (n, 3) m
        Of the lattice's cells.
    is_divisible : (n,)
        Not at faces that have nodes.
    spacing : float, m
    parts
    axes
        Along which cells are halved.
    """
    count = len(positions)
    cells = Cells(np.arange(count), positions, widths, np.zeros(count, np.int64))
    for depth in range(max((part.levels for part in parts), default=0)):
        chosen = np.zeros(len(cells.level), bool)
        for part in parts:
            if part.levels > depth:
                away = transition(part.levels, depth, part.width, spacing)
                held = (cells.positions >= part.lowest - away) & (
                    cells.positions <= part.highest + away
                )
                chosen |= held[:, axes].all(axis=1)
        cells = _halved(cells, chosen & (cells.level == depth) & is_divisible[cells.origin], axes)
    return cells


def _halved(cells: Cells, chosen: Flags, axes: tuple[int, ...]) -> Cells:
    """Replace some cells by their halves along each axis; rows stay in order."""
    children = np.where(chosen, 2 ** len(axes), 1)
    rows = np.repeat(np.arange(len(chosen)), children)
    child = np.arange(len(rows)) - np.repeat(np.cumsum(children) - children, children)
    positions, widths = cells.positions[rows], cells.widths[rows]
    split = chosen[rows]
    for bit, d in enumerate(axes):
        side = ((child >> bit) & 1) - 0.5
        widths[split, d] *= 0.5
        positions[split, d] += (side * widths[:, d])[split]
    return Cells(cells.origin[rows], positions, widths, cells.level[rows] + split)
