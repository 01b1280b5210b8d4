"""What concerns several parameters of a fluid at once; each mistake is one sentence."""

import math
from typing import TYPE_CHECKING

from quintet.components.sph_fluid.setup.gauge_checks import check_gauges
from quintet.components.sph_fluid.setup.geometry import (
    Box,
    closed_faces,
    depth,
    fluid_boxes,
    hydrostatic_gravity,
    named_boxes,
)
from quintet.components.sph_fluid.setup.mass import check_mass

if TYPE_CHECKING:
    from quintet.components.sph_fluid.params import SphFluidParams

LEAST_WAVE_LAYERS = 8
ROUNDING = 1e-6  # of a spacing


def check(params: "SphFluidParams") -> None:
    """Refuse what cannot be computed."""
    if not params.fluid:
        raise ValueError("fluid must have at least one box; found none. Add a box.")
    check_boxes(params)
    check_mass(params)
    check_walls(params)
    check_obstacles(params)
    check_sound(params)
    check_slab(params)
    check_symmetry(params)
    check_methods(params)
    check_gauges(params)
    if params.shapes:
        # Left out of scenes whose fluid is in boxes.
        from quintet.components.sph_fluid.setup.shape_checks import check_shapes

        check_shapes(params)
    if params.initial is not None:
        # Left out of scenes whose fluid starts at rest.
        from quintet.components.sph_fluid.setup.initial_fields import check_initial

        check_initial(params, fluid_boxes(params))
    if params.wave is not None:
        params.wave.check(params.boxes, params.gravity)
        check_wave_resolution(params)


def check_wave_resolution(params: "SphFluidParams") -> None:
    """Refuse a wave on water of few particles: of five in the depth its period is 11 % long."""
    layers = depth(params) / params.spacing
    if layers < LEAST_WAVE_LAYERS - ROUNDING:
        raise ValueError(
            f"wave needs {LEAST_WAVE_LAYERS} particles or more in the depth; found {layers:.3g}. "
            "Refine the spacing."
        )


def check_boxes(params: "SphFluidParams") -> None:
    """Boxes of fluid have tolerance for particles and do not overlap."""
    boxes = named_boxes(params)
    for number, (name, box) in enumerate(boxes):
        _check_corners(name, box, params.spacing)
        for other, earlier in boxes[:number]:
            if _overlap(box, earlier, ROUNDING * params.spacing):
                raise ValueError(
                    f"{name} must not overlap {other}; found {box} and {earlier}. Cut one of them."
                )


def check_walls(params: "SphFluidParams") -> None:
    """Fluid is inside the walls, and moving faces move in their own planes."""
    edge = params.boundary
    if edge.tank is None:
        return
    _check_corners("boundary.walls", edge.tank, params.spacing)
    low, high = edge.tank
    tolerance = ROUNDING * params.spacing
    for whose, box in [(f"fluid[{k}]", region.bounds) for k, region in enumerate(params.fluid)]:
        for axis, name in enumerate("xyz"):
            below = box[0][axis] < low[axis] - tolerance and f"{name}-" not in edge.open_faces
            above = box[1][axis] > high[axis] + tolerance and f"{name}+" not in edge.open_faces
            if below or above:
                raise ValueError(
                    f"{whose} must be inside the walls along {name}, "
                    f"{low[axis]} to {high[axis]} m; found {box[0][axis]} to "
                    f"{box[1][axis]} m. Move the box, or add the face to boundary.open_faces."
                )
    closed = closed_faces(params)
    for face, velocity in edge.wall_velocity.items():
        if face not in closed or velocity["xyz".index(face[0])] != 0.0:
            raise ValueError(
                f"boundary.wall_velocity.{face} must lie in a face that the tank has, "
                f"{', '.join(closed)}; found {velocity} m/s. Close the face, or leave its "
                f"{face[0]} 0."
            )


def check_obstacles(params: "SphFluidParams") -> None:
    """Obstacles have tolerance for particles and are dry inside."""
    least = 2.0 * params.boundary.wall_offset * params.spacing
    for number, box in enumerate(params.boundary.solids):
        name = f"boundary.obstacles[{number}]"
        _check_corners(name, box, params.spacing)
        low, high = box
        across = (0, 1, 2) if params.dimensions == 3 else (0, 2)
        width = min(high[axis] - low[axis] for axis in across)
        if width < least - ROUNDING * params.spacing:
            raise ValueError(
                f"{name} must be at least {least:g} m across, twice the wall_offset; found "
                f"{width:g} m. Refine the spacing, or lower wall_offset."
            )
        for other, water in named_boxes(params):
            if _overlap(box, water, ROUNDING * params.spacing):
                raise ValueError(
                    f"{name} must not overlap {other}; found {box} and {water}. Cut the fluid."
                )


def check_sound(params: "SphFluidParams") -> None:
    """The fluid is hardly compressed by its own weight; Monaghan 1994."""
    deep = depth(params)
    needed = 10.0 * math.sqrt(math.hypot(*hydrostatic_gravity(params)) * deep)
    if params.sound_speed < needed:
        raise ValueError(
            f"sound_speed must be at least 10 sqrt(g depth) = {needed:.4g} m/s for the fluid's "
            f"depth of {deep:.4g} m; found {params.sound_speed}. Raise it; twice that "
            "suits a dam break."
        )


def check_slab(params: "SphFluidParams") -> None:
    """In two dimensions all is one slab."""
    walls = params.boundary.tank
    boxes = [*fluid_boxes(params), *([] if walls is None else [walls]), *params.boundary.solids]
    sides = {(low[1], high[1]) for low, high in boxes}
    if params.dimensions == 2 and (len(sides) > 1 or params.gravity[1] != 0.0):
        raise ValueError(
            "in two dimensions, x and z, all boxes must reach over the same y, and gravity has "
            f"no y; found y from {sorted(sides)} and gravity {params.gravity}. Correct them, or "
            "set dimensions to 3."
        )


def check_symmetry(params: "SphFluidParams") -> None:
    """Planes of symmetry are faces of the tank that nothing crosses."""
    edge = params.boundary
    for face in edge.symmetry:
        axis, name = "xyz".index(face[0]), f"boundary.symmetry: {face}"
        if edge.tank is None or face in edge.open_faces:
            raise ValueError(
                f"{name} must be a face of the tank; found walls {edge.tank} and open_faces "
                f"{edge.open_faces}. Give walls, or take the face out of one of the two."
            )
        if params.dimensions == 2 and face[0] == "y":
            raise ValueError(
                f"{name} must be x- or x+ in two dimensions, where both sides along y are "
                "planes already. Remove it."
            )
        if params.gravity[axis] != 0.0:
            raise ValueError(
                f"{name} must have gravity in its plane; found {params.gravity} m/s2. Turn "
                "gravity, or make the face a wall."
            )
        low, high = edge.tank[0][axis], edge.tank[1][axis]
        both = {f"{face[0]}-", f"{face[0]}+"} <= set(edge.symmetry)
        if both and high - low < (least := 3.0 * params.smoothing_length):
            # What is behind one plane would be mirrored in the other.
            raise ValueError(
                f"{name} must be {least:g} m or more, 3 smoothing lengths, from the opposite "
                f"plane; found {high - low:g} m. Widen the tank, or refine the spacing."
            )
        for number, box in enumerate(edge.solids):
            if min(box[0][axis] - low, high - box[1][axis]) < -ROUNDING * params.spacing:
                raise ValueError(
                    f"{name}, {face[0]} from {low:g} to {high:g} m, must not cut "
                    f"boundary.obstacles[{number}]; found {box}. Cut the box there."
                )


def check_methods(params: "SphFluidParams") -> None:
    """Options are asked for with what they need."""
    edge = params.boundary
    if edge.method == "mdbc" and (edge.wall_offset, edge.sample_depth) != (0.5, 0.5):
        raise ValueError(
            "boundary.method mdbc puts its particles half a spacing behind the face; found "
            f"wall_offset {edge.wall_offset} and sample_depth {edge.sample_depth}. Remove them, "
            "or use dbc."
        )
    films = edge.lubrication_films is True
    if films and edge.method != "mdbc":
        raise ValueError(
            "boundary.lubrication_films needs boundary.method mdbc, whose samples know the "
            f"pressure at a gap's rim; found {edge.method}. Set method, or leave films out."
        )
    if edge.symmetry and films:
        raise ValueError(
            "boundary.lubrication_films knows no planes of symmetry; found films and symmetry "
            f"{edge.symmetry}. Leave one out."
        )
    if params.dimensions == 2 and films:
        raise ValueError(
            "boundary.lubrication_films needs three dimensions, in which water flows into a film "
            "from its rim; found dimensions 2. Set dimensions to 3, or leave films out."
        )
    if params.remove_inside_bodies and edge.method != "mdbc":
        raise ValueError(
            "remove_inside_bodies needs boundary.method mdbc, whose samples say where the surface "
            f"is; found {edge.method}. Set method, or cut the fluid."
        )
    if edge.potential_stiffness is not None and edge.method == "dbc":
        raise ValueError(
            "boundary.potential_stiffness belongs to boundary.method potential, or mdbc with links "
            f"that choose it; found {edge.method}. Remove it, or set method."
        )
    if params.acoustic_damper > 0.0 and params.integration != "symplectic":
        raise ValueError(
            "acoustic_damper needs integration symplectic, whose step limit with it is known; "
            f"found acoustic_damper {params.acoustic_damper} and integration "
            f"{params.integration}. Set integration, or remove acoustic_damper."
        )


def _check_corners(name: str, box: Box, spacing: float) -> None:
    low, high = box
    if any(b - a < 0.5 * spacing for a, b in zip(low, high, strict=True)):
        raise ValueError(
            f"{name} must go from its lowest to its highest corner, half a spacing or more along "
            f"each axis; found {low} to {high} m. Exchange the corners, or widen it."
        )


def _overlap(one: Box, other: Box, tolerance: float) -> bool:
    return all(
        min(one[1][axis], other[1][axis]) - max(one[0][axis], other[0][axis]) > tolerance
        for axis in range(3)
    )
