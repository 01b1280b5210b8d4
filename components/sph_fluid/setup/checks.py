"""Checks of several parameters of a fluid at once; each mistake is one sentence."""

import math
from collections.abc import Sequence

from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.sph_fluid.setup.boundary import Boundary
from quintet.components.sph_fluid.setup.geometry import ROUNDING
from quintet.components.sph_fluid.setup.shapes import Fluid, named_boxes
from quintet.interfaces.params import Vector

LEAST_WAVE_LAYERS = 8


def check_boxes(fluid: Fluid, spacing: float) -> None:
    """Boxes of fluid have room for particles and do not overlap."""
    boxes = named_boxes(fluid)
    for number, (name, box) in enumerate(boxes):
        _check_corners(name, box, spacing)
        for earlier_name, earlier in boxes[:number]:
            if _overlap(box, earlier, ROUNDING * spacing):
                raise ValueError(
                    f"{name} must not overlap {earlier_name}; found {box} and {earlier}. Cut one "
                    "of them."
                )


def check_walls(boundary: Boundary, fluid: Fluid, spacing: float, dimensions: int) -> None:
    """Fluid is inside the walls, and moving faces move in their own planes."""
    _check_wall_velocity(boundary, dimensions)
    if boundary.tank is None:
        return
    _check_corners("boundary.walls", boundary.tank, spacing)
    low, high = boundary.tank
    tolerance = ROUNDING * spacing
    for k, (bottom, top) in enumerate(region.bounds for region in fluid):
        for axis, name in enumerate("xyz"):
            below = bottom[axis] < low[axis] - tolerance and f"{name}-" not in boundary.open_faces
            above = top[axis] > high[axis] + tolerance and f"{name}+" not in boundary.open_faces
            if below or above:
                raise ValueError(
                    f"fluid[{k}] must be inside the walls along {name}, {low[axis]} to "
                    f"{high[axis]} m; found {bottom[axis]} to {top[axis]} m. Move the box, or add "
                    "the face to boundary.open_faces."
                )


def check_lost_limit(lost_limit: float | None, boundary: Boundary) -> None:
    """Particles are lost outside of a tank alone."""
    if lost_limit is not None and boundary.tank is None:
        raise ValueError(
            "lost_limit needs boundary.walls, for a particle is lost far outside of the tank; "
            f"found lost_limit {lost_limit:g} and no walls. Give walls, or remove lost_limit."
        )


def _check_wall_velocity(boundary: Boundary, dimensions: int) -> None:
    closed = boundary.closed_faces(dimensions) if boundary.tank is not None else ()
    for face, velocity in boundary.wall_velocity.items():
        if face not in closed:
            raise ValueError(
                f"boundary.wall_velocity.{face} must be of a closed face of the tank, "
                f"{', '.join(closed) or 'but the tank has none'}; found {face}. Name a closed "
                f"face, or close this one: with boundary.walls, and without {face} in open_faces, "
                "symmetry and periodic."
            )
        if velocity["xyz".index(face[0])] != 0.0:
            raise ValueError(
                f"boundary.wall_velocity.{face} must lie in the plane of the face; found "
                f"{velocity} m/s. Set its {face[0]} component to 0, or move the face with "
                "boundary.pistons."
            )


def check_obstacles(boundary: Boundary, fluid: Fluid, spacing: float, dimensions: int) -> None:
    """Obstacles have room for particles and are dry inside."""
    least, tolerance = 2.0 * boundary.wall_offset * spacing, ROUNDING * spacing
    for number, box in enumerate(boundary.solids):
        name = f"boundary.obstacles[{number}]"
        _check_corners(name, box, spacing)
        low, high = box
        width = min(high[axis] - low[axis] for axis in _axes(dimensions))
        if width < least - tolerance:
            raise ValueError(
                f"{name} must be at least {least:g} m across, twice the wall_offset; found "
                f"{width:g} m. Refine the spacing, or lower wall_offset."
            )
        for region, water in named_boxes(fluid):
            if _overlap(box, water, tolerance):
                raise ValueError(
                    f"{name} must not overlap {region}; found {box} and {water}. Cut the fluid."
                )


def check_sound(sound_speed: float, gravity: Vector, depth: float) -> None:
    """The fluid is hardly compressed by its own weight; Monaghan 1994."""
    needed = 10.0 * math.sqrt(math.hypot(*gravity) * depth)
    if sound_speed < needed:
        raise ValueError(
            f"sound_speed must be at least 10 sqrt(g depth) = {needed:.4g} m/s for the fluid's "
            f"depth of {depth:.4g} m; found {sound_speed}. Raise it; twice that suits a dam break."
        )


def check_slab(boxes: Sequence[Bounds], gravity: Vector) -> None:
    """In two dimensions all is one slab."""
    sides = {(low[1], high[1]) for low, high in boxes}
    if len(sides) > 1 or gravity[1] != 0.0:
        raise ValueError(
            "in two dimensions, x and z, all boxes must reach over the same y, and gravity has "
            f"no y; found y from {sorted(sides)} and gravity {gravity}. Correct them, or "
            "set dimensions to 3."
        )


def check_symmetry(
    boundary: Boundary, dimensions: int, gravity: Vector, least: float, spacing: float
) -> None:
    """Planes of symmetry are faces of the tank that nothing crosses, `least` [m] apart or more."""
    for face in boundary.symmetry:
        axis, name = "xyz".index(face[0]), f"boundary.symmetry: {face}"
        if boundary.tank is None or face in boundary.open_faces:
            raise ValueError(
                f"{name} must be a face of the tank; found walls {boundary.tank} and open_faces "
                f"{boundary.open_faces}. Give walls, or take the face out of one of the two."
            )
        if dimensions == 2 and face[0] == "y":
            raise ValueError(
                f"{name} must be x- or x+ in two dimensions, where both sides along y are "
                "planes already. Remove it."
            )
        if gravity[axis] != 0.0:
            raise ValueError(
                f"{name} must have gravity in its plane; found {gravity} m/s2. Turn "
                "gravity, or make the face a wall."
            )
        low, high = boundary.tank[0][axis], boundary.tank[1][axis]
        has_both = {f"{face[0]}-", f"{face[0]}+"} <= set(boundary.symmetry)
        if has_both and high - low < least:
            # What is behind one plane would be mirrored in the other.
            raise ValueError(
                f"{name} must be {least:g} m or more, 3 smoothing lengths, from the opposite "
                f"plane; found {high - low:g} m. Widen the tank, or refine the spacing."
            )
        for number, box in enumerate(boundary.solids):
            if min(box[0][axis] - low, high - box[1][axis]) < -ROUNDING * spacing:
                raise ValueError(
                    f"{name}, {face[0]} from {low:g} to {high:g} m, must not cut "
                    f"boundary.obstacles[{number}]; found {box}. Cut the box there."
                )


def check_method(boundary: Boundary, dimensions: int) -> None:
    """Options of the boundary are asked for with what they need."""
    method, films = boundary.method, boundary.lubrication_films is True
    if method == "mdbc" and (boundary.wall_offset, boundary.sample_depth) != (0.5, 0.5):
        raise ValueError(
            "boundary.method mdbc puts its particles half a spacing behind the face; found "
            f"wall_offset {boundary.wall_offset} and sample_depth {boundary.sample_depth}. Remove "
            "them, or use dbc."
        )
    if films and method != "mdbc":
        raise ValueError(
            "boundary.lubrication_films needs boundary.method mdbc, whose samples know the "
            f"pressure at a gap's rim; found {method}. Set method, or leave films out."
        )
    if films and boundary.symmetry:
        raise ValueError(
            "boundary.lubrication_films is not available with boundary.symmetry; found both, with "
            f"symmetry {boundary.symmetry}. Leave one out."
        )
    if films and dimensions == 2:
        raise ValueError(
            "boundary.lubrication_films needs three dimensions, in which water flows into a film "
            "from its rim; found dimensions 2. Set dimensions to 3, or leave films out."
        )
    if boundary.potential_stiffness is not None and method == "dbc":
        raise ValueError(
            "boundary.potential_stiffness belongs to boundary.method potential, or mdbc with links "
            f"that choose it; found {method}. Remove it, or set method."
        )


def check_wave_resolution(depth: float, spacing: float) -> None:
    """Refuse a wave on water of few particles: of five in the depth its period is 11 % long."""
    layers = depth / spacing
    if layers < LEAST_WAVE_LAYERS - ROUNDING:
        raise ValueError(
            f"wave needs {LEAST_WAVE_LAYERS} particles or more in the depth; found {layers:.3g}. "
            "Refine the spacing."
        )


def _axes(dimensions: int) -> tuple[int, ...]:
    return (0, 1, 2) if dimensions == 3 else (0, 2)


def _check_corners(name: str, box: Bounds, spacing: float) -> None:
    low, high = box
    if any(b - a < 0.5 * spacing for a, b in zip(low, high, strict=True)):
        raise ValueError(
            f"{name} must go from its lowest to its highest corner, half a spacing or more along "
            f"each axis; found {low} to {high} m. Exchange the corners, or widen it."
        )


def _overlap(first: Bounds, second: Bounds, tolerance: float) -> bool:
    (a, b), (c, d) = first, second
    return all(min(b[axis], d[axis]) - max(a[axis], c[axis]) > tolerance for axis in range(3))


def check_moved(boundary: Boundary) -> None:
    """Fluid does not come, go or repeat in a tank of which something moves."""
    moving_keys = [name for name in ("motion", "pistons") if getattr(boundary, name)]
    flow_keys = [name for name in ("inflow", "outflow", "periodic") if getattr(boundary, name)]
    if moving_keys and flow_keys:
        raise ValueError(
            f"boundary.{moving_keys[0]} is not available with boundary.{flow_keys[0]}. Remove one "
            "of them."
        )
