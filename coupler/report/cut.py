"""What is left out of a picture, so that one sees into a cloud of particles or a solid."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from quintet.coupler.report.field_drawing import is_field
from quintet.coupler.report.view_steps import Shown, spacing
from quintet.interfaces.component import Array

THICK = 3.0  # depth of a cloud over the spacing of its particles, from which it hides things

Depths = tuple[float, float]


def is_body(shown: Shown) -> bool:
    """Whether a component shows bodies: spheres, or faces that have a plain colour."""
    return bool(shown.radius.any()) or bool(shown.faces and shown.face_values is None)


def depth_of_bodies(view: Sequence[Shown]) -> float | None:
    """Mean depth [m] of bodies that particles in front of them would hide; None if nothing does.

    The view is turned (`Viewpoint.turned_view`): its second axis points into the picture.
    """
    bodies = [_depths(shown) for shown in view if is_body(shown)]
    clouds = [
        shown for shown in view if len(shown.points) and not (is_body(shown) or is_field(shown))
    ]
    sizes = [(np.ptp(shown.points[:, 1]), spacing(shown.points)) for shown in clouds]
    if not bodies or not any(depth > THICK * size > 0.0 for depth, size in sizes):
        return None
    depths = np.concatenate(bodies)
    depths = depths[np.isfinite(depths)]
    return 0.5 * float(depths.min() + depths.max()) if len(depths) else None


def _depths(shown: Shown) -> Array:
    """Depths (n,) m of the points, and of the corners of the faces, of a component."""
    return np.concatenate([shown.points[:, 1], *(face[:, 1] for face in shown.faces)])


def cut_and_sorted(shown: Shown, between: Depths, keeps_bodies: bool = False) -> Shown:
    """Leave out what is nearer or farther than some depths [m]; sort all, the farthest first.

    With `keeps_bodies` spheres, and points that are too few to hide anything, stay. Plain faces
    stay; faces that show a field are cut as particles are, so that solids that show the faces of
    all their elements are seen from within.
    """
    near, far = between
    within = np.isfinite(shown.points).all(axis=1)
    if not (keeps_bodies and (shown.radius.any() or not spacing(shown.points))):
        within &= (shown.points[:, 1] >= near) & (shown.points[:, 1] <= far)
    points = np.flatnonzero(within)
    points = points[np.argsort(-shown.points[points, 1], kind="stable")]
    depth = np.array([float(face[:, 1].mean()) for face in shown.faces])
    faces = np.argsort(-depth, kind="stable")
    if shown.face_values is not None:
        faces = faces[(depth[faces] >= near) & (depth[faces] <= far)]
    return replace(
        shown,
        points=shown.points[points],
        radius=shown.radius[points],
        values=None if shown.values is None else shown.values[points],
        faces=[shown.faces[k] for k in faces],
        face_values=None if shown.face_values is None else shown.face_values[faces],
        spacing=None if shown.spacing is None else shown.spacing[points],
    )
