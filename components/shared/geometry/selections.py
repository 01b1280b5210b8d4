"""Selections: what of a solver's nodes, particles or faces a box in a scene means."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from quintet.interfaces.component import Array
from quintet.interfaces.params import Vector, parameters


@parameters
class ByBox:
    """What lies in a box along the axes at the start.

    Parameters
    ----------
    lowest, highest : m
        Corners of the box.
    """

    lowest: Vector
    highest: Vector


@parameters
class ByBoxOrSet:
    """What lies in a box along the axes at the start, or belongs to a named set.

    Parameters
    ----------
    lowest, highest : m
        Corners of the box.
    node_set
        In place of the box: a set of `node_sets`, or of a mesh's file.
    """

    lowest: Vector | None = None
    highest: Vector | None = None
    node_set: str = ""

    def __post_init__(self) -> None:
        self.require_one(self.node_set)

    @property
    def cure(self) -> str:
        """What to do about a selection that holds nothing."""
        return f"Correct the set {self.node_set}." if self.node_set else "Correct the box."

    def _named(self) -> str:
        """Keys that are given, other than names of its own of a derived class."""
        names = ("lowest", "highest", "node_set", "element_set")
        return " and ".join(name for name in names if getattr(self, name, None))

    def require_one(self, name: str) -> None:
        """Refuse a selection that is not either by the box or by the name of a set."""
        corners = sum(corner is not None for corner in (self.lowest, self.highest))
        if corners != (0 if name else 2):
            raise ValueError(
                "a selection must have either lowest and highest, the corners of a box, or the "
                f"name of a set; found {self._named() or 'neither'}. Give the one or the other."
            )


def in_box(
    points: Array, box: ByBox | ByBoxOrSet, margin: float = 0.0, axes: Sequence[int] = (0, 1, 2)
) -> NDArray[np.bool_]:
    """Which of points (n, 3) m lie in a box, or so near [m]; only along some axes."""
    assert box.lowest is not None and box.highest is not None
    low, high = np.array(box.lowest) - margin, np.array(box.highest) + margin
    within = (points >= low) & (points <= high)
    return np.asarray(within[:, list(axes)].all(axis=1))
