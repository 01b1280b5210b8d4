"""Checks of pistons; each mistake is one sentence."""

import itertools
import math

import numpy as np

from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.sph_fluid.setup.boundary import Boundary
from quintet.components.sph_fluid.setup.geometry import ROUNDING
from quintet.components.sph_fluid.setup.motion_checks import is_along
from quintet.components.sph_fluid.setup.piston_ways import meets, surface, surfaces_on_way
from quintet.components.sph_fluid.setup.pistons import Piston
from quintet.interfaces.component import Array

START = 0.02  # spacings: how far a part may be at the start from where the scene has it
BACK = 0.01  # of a spacing: how far out of the tank a face may go


def check_pistons(boundary: Boundary, dimensions: int, spacing: float) -> None:
    """Pistons are parts that are there, each once, and leave no gaps behind."""
    parts = [piston.part for piston in boundary.pistons]
    for number, piston in enumerate(boundary.pistons):
        label = f"boundary.pistons[{number}]"
        if parts.index(piston.part) < number:
            raise ValueError(
                f"{label} must move a part of its own; found {piston.part} twice. Remove one."
            )
        _check_part(label, piston, boundary, dimensions)
        _check_start(label, piston, boundary, spacing)
        if dimensions == 2 and not is_along(piston.path, "y"):
            raise ValueError(
                f"{label}.motion must stay in the plane of x and z in two dimensions: displaced by "
                "nothing along y, and turned about y. Correct it, or set dimensions to 3."
            )
        for face in boundary.symmetry:
            if not is_along(piston.path, face[0]):
                raise ValueError(
                    f"{label}.motion must stay in the plane of boundary.symmetry {face}: displaced "
                    f"by nothing along {face[0]}, and turned about {face[0]}. Correct it, or make "
                    "the face a wall."
                )
        if piston.face and piston.waves is not None:
            raise ValueError(
                f"{label}: {piston.part} must not make waves, as a paddle swings to both sides and "
                "a face of the tank goes into it alone. Take an obstacle that reaches across."
            )
        if piston.face:
            _check_face(label, piston, boundary, spacing)
            _check_way(label, piston, boundary, _swept_by_face(piston, boundary), spacing)
        elif (box := piston.number("obstacles")) >= 0:
            _check_dry_faces(label, piston, boundary, box, spacing, dimensions)
        if not piston.face and (piston.path.turns or piston.number("meshes") >= 0):
            _check_any_way(label, piston, boundary, spacing, dimensions)
        elif not piston.face:
            swept = _swept_by_box(piston, boundary.solids[piston.number("obstacles")])
            _check_way(label, piston, boundary, swept, spacing)
            _check_inside(label, piston, boundary, swept, dimensions)
    if boundary.method == "potential":
        raise ValueError(
            "boundary.pistons need boundary.method mdbc or dbc; found potential. Set method."
        )
    if boundary.lubrication_films is True:
        raise ValueError(
            "boundary.lubrication_films is not available with boundary.pistons. Set "
            "lubrication_films to false, or remove the pistons."
        )


def _check_part(label: str, piston: Piston, boundary: Boundary, dimensions: int) -> None:
    closed = boundary.closed_faces(dimensions) if boundary.tank else ()
    if piston.face and piston.face not in closed:
        raise ValueError(
            f"{label}.part must be a closed face of the tank, "
            f"{', '.join(closed) or 'but the tank has none'}; found {piston.part}. Close the face, "
            "or name another part."
        )
    for kind, count in (("obstacles", len(boundary.solids)), ("meshes", len(boundary.meshes))):
        number = piston.number(kind)  # type: ignore[arg-type]
        if number >= count:
            raise ValueError(
                f"{label}.part must be one of the {count} entries of boundary.{kind}, numbered "
                f"from 0; found {piston.part}. Correct its number, or add the entry."
            )


def _check_start(label: str, piston: Piston, boundary: Boundary, spacing: float) -> None:
    """A motion begins where the part stands in the scene, outside of the fluid."""
    place = piston.path.trajectory.at(0.0).place
    shift, angle = math.hypot(*place[:3].tolist()), float(place[3])
    arms = [math.dist(corner, piston.path.point) for corner in part_corners(piston, boundary)]
    if shift + abs(angle) * max(arms, default=0.0) > START * spacing:
        raise ValueError(
            f"{label}.motion must begin at no displacement and no angle, where {piston.part} "
            f"stands in the scene; found {shift:.3g} m and {angle:.3g} rad at 0 s. Move the part "
            "in the scene, and subtract the first place from the motion."
        )


def part_corners(piston: Piston, boundary: Boundary) -> Array:
    """Corners (n, 3) m of an obstacle or a mesh; none of a face, which does not turn."""
    if (box := piston.number("obstacles")) >= 0:
        return np.array(list(itertools.product(*zip(*boundary.solids[box], strict=True))))
    if (mesh := piston.number("meshes")) >= 0:
        # Left out of scenes without boundaries from files.
        from quintet.components.sph_fluid.setup.mesh_surfaces import placed

        return placed(boundary.meshes[mesh]).corner.reshape(-1, 3)
    return np.zeros((0, 3))


def _check_face(label: str, piston: Piston, boundary: Boundary, spacing: float) -> None:
    """A face moves into the tank, along its normal: behind it are no walls."""
    axis, sign = "xyz".index(piston.face[0]), 1.0 if piston.face[1] == "-" else -1.0
    motion, shifts = piston.path, list(piston.path.shifts)
    shifts[axis] = False
    if motion.turns or any(shifts):
        raise ValueError(
            f"{label}: {piston.part} must move along {piston.face[0]} alone, or it would leave the "
            "other faces; take an obstacle for other motions."
        )
    if sign * motion.least(axis, sign) < -BACK * spacing:
        raise ValueError(
            f"{label}: {piston.part} must move into the tank, from where it stands in the scene; "
            f"found displacements of {motion.least(axis, sign):g} m along {piston.face[0]}, where "
            "the other faces have no walls. Move the face in the scene, or take an obstacle."
        )
    if piston.face in boundary.wall_velocity:
        raise ValueError(
            f"{label}: {piston.part} must not have a boundary.wall_velocity too; found both. "
            "Remove one."
        )


def _swept_by_face(piston: Piston, boundary: Boundary) -> Array:
    """Corners (1, 2, 3) m of the box that a face of the tank goes through."""
    assert boundary.tank is not None
    swept = np.array([boundary.tank])
    axis, is_lower = "xyz".index(piston.face[0]), piston.face[1] == "-"
    furthest = piston.path.least(axis, -1.0 if is_lower else 1.0)
    swept[0, int(is_lower), axis] = swept[0, int(not is_lower), axis] + furthest
    return swept


def _swept_by_box(piston: Piston, box: Bounds) -> Array:
    """Corners (n, 2, 3) m of boxes that an obstacle goes through, one after the other."""
    course = piston.path.trajectory.course()[:, :3]
    low = np.minimum(course[:-1], course[1:]) + np.array(box[0])
    high = np.maximum(course[:-1], course[1:]) + np.array(box[1])
    return np.stack([low, high], axis=1)


def _check_way(
    label: str, piston: Piston, boundary: Boundary, swept: Array, spacing: float
) -> None:
    """No obstacle that stands is in the way, and a face does not reach the opposite one."""
    moving_numbers = [part.number("obstacles") for part in boundary.pistons]
    obstacle, tolerance = piston.number("obstacles"), ROUNDING * spacing
    for number, box in enumerate(boundary.solids):
        low, high = np.array(box) if number not in moving_numbers else np.full((2, 3), np.nan)
        overlap_on_way = np.minimum(swept[:, 1], high) - np.maximum(swept[:, 0], low)
        at_start = np.array(boundary.solids[obstacle]) if obstacle >= 0 else np.full((2, 3), np.nan)
        overlap = np.minimum(at_start[1], high) - np.maximum(at_start[0], low)
        if (overlap_on_way > tolerance).all(axis=1).any() and not (overlap > tolerance).all():
            raise _in_the_way(label, piston, number)
    if piston.face and boundary.tank is not None:
        axis = "xyz".index(piston.face[0])
        length = boundary.tank[1][axis] - boundary.tank[0][axis]
        travel = float(swept[0, 1, axis] - swept[0, 0, axis])
        if travel >= length - tolerance:
            raise ValueError(
                f"{label}: {piston.part} must stay before the opposite face, {length:g} m away; "
                f"found a displacement of {travel:g} m. Shorten the motion."
            )


def _in_the_way(label: str, piston: Piston, number: int) -> ValueError:
    return ValueError(
        f"{label}: {piston.part} must not go through boundary.obstacles[{number}], which stands; "
        "found that they overlap on its way. Shorten the motion, or move one of the two."
    )


def _outside(label: str, piston: Piston, face: str) -> ValueError:
    return ValueError(
        f"{label}: {piston.part} must stay in the tank; found it beyond the wall {face} on its "
        "way. Shorten the motion, or open the face."
    )


def _check_any_way(
    label: str, piston: Piston, boundary: Boundary, spacing: float, dimensions: int
) -> None:
    """No obstacle that stands is in the way of what turns or is a mesh; it stays in the tank."""
    moving_numbers = [part.number("obstacles") for part in boundary.pistons]
    tolerance = ROUNDING * spacing
    standing = {
        number: box
        for number, box in enumerate(boundary.solids)
        if number not in moving_numbers
        and not meets(surface(piston, boundary), box, tolerance)
        and not _holds_middle(piston, boundary, box)
    }
    closed = boundary.closed_faces(dimensions) if boundary.tank else ()
    for triangles in surfaces_on_way(piston, boundary, spacing):
        for number, box in standing.items():
            if meets(triangles, box, tolerance):
                raise _in_the_way(label, piston, number)
        low, high = triangles.min(axis=(0, 1)), triangles.max(axis=(0, 1))
        for face in closed:
            assert boundary.tank is not None
            axis, is_upper = "xyz".index(face[0]), face[1] == "+"
            wall = boundary.tank[int(is_upper)][axis]
            if low[axis] >= wall if is_upper else high[axis] <= wall:
                raise _outside(label, piston, face)


def _holds_middle(piston: Piston, boundary: Boundary, box: Bounds) -> bool:
    """Whether an obstacle that stands is inside a box that moves, or the other way round."""
    number = piston.number("obstacles")
    if number < 0:
        return False
    ends = np.array([boundary.solids[number], box])
    return bool((ends[:, 0].max(axis=0) < ends[:, 1].min(axis=0)).all())


def _check_inside(
    label: str, piston: Piston, boundary: Boundary, swept: Array, dimensions: int
) -> None:
    """An obstacle does not leave the tank through a closed face."""
    for face in boundary.closed_faces(dimensions) if boundary.tank else ():
        assert boundary.tank is not None
        axis = "xyz".index(face[0])
        wall = boundary.tank["-+".index(face[1])][axis]
        outside = swept[:, 1, axis] <= wall if face[1] == "-" else swept[:, 0, axis] >= wall
        if outside.any():
            raise _outside(label, piston, face)


def _check_dry_faces(
    label: str, piston: Piston, boundary: Boundary, box: int, spacing: float, dimensions: int
) -> None:
    """Faces of an obstacle that lie on a wall stay on it."""
    if boundary.tank is None:
        return
    ends = np.array([boundary.tank, boundary.solids[box]])
    touches = np.abs(ends[0] - ends[1]) <= ROUNDING * spacing  # (2, 3): lower and upper faces
    for axis, name in enumerate("xyz"):
        sides = [f"{name}{side}" for side in "-+"]
        closed = [face in boundary.closed_faces(dimensions) for face in sides]
        for side in range(2):
            if touches[side, axis] and closed[side] and not is_along(piston.path, name):
                raise ValueError(
                    f"{label}: {piston.part} must stay on the wall {sides[side]} that it touches: "
                    f"displaced by nothing along {name}, and turned about {name}. Let it stand off "
                    "the wall, or let it go through as far as it moves."
                )
