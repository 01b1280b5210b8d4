"""From where a picture is seen: which axes of the scene point right, into the picture and up."""

from dataclasses import dataclass, replace

import numpy as np

from quintet.coupler.report.view_steps import Shown, Still
from quintet.interfaces.component import Array

Box = tuple[tuple[float, float, float], tuple[float, float, float]]


@dataclass(frozen=True, slots=True)
class Viewpoint:
    """Axes of the scene (0, 1, 2 for x, y, z) in a picture; the three are right-handed.

    Attributes
    ----------
    right, up : int
        Axes that point to the right and up.
    depth : int
        The axis along which one looks.
    ahead : float
        1 where one looks along this axis, -1 where one looks against it.
    """

    name: str
    right: int
    depth: int
    up: int
    ahead: float

    @property
    def looks_along(self) -> str:
        """The axis of the scene along which one looks."""
        return "xyz"[self.depth]

    @property
    def names(self) -> tuple[str, str]:
        """Of the horizontal and of the vertical axis of a panel."""
        return "xyz"[self.right], "xyz"[self.up]

    def turned(self, points: Array) -> Array:
        """Turn points (..., 3) m of the scene: to the right, into the picture, up."""
        axes = np.asarray(points)[..., [self.right, self.depth, self.up]]
        return axes * np.array([1.0, self.ahead, 1.0])

    def turned_box(self, box: Box) -> tuple[Array, Array]:
        """Lowest and highest corner (3,) m of a box of the scene, turned."""
        corners = self.turned(np.array(box))
        return corners.min(axis=0), corners.max(axis=0)

    def turned_view(self, shown: Shown) -> Shown:
        """Turn what a component shows."""
        faces = [self.turned(face) for face in shown.faces]
        return replace(shown, points=self.turned(shown.points), faces=faces)

    def turned_wall(self, wall: Still) -> Still:
        """Turn a face that stands still."""
        return wall._replace(corners=self.turned(wall.corners))


SIDE = Viewpoint("side", 0, 1, 2, 1.0)
VIEWPOINTS = {
    "side": SIDE,
    "front": Viewpoint("front", 1, 0, 2, -1.0),
    "top": Viewpoint("top", 0, 2, 1, -1.0),
}
