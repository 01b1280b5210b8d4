"""Where the particles are at the start, and how dense."""

import math

import numpy as np

from quintet.components.shared.geometry.bounds import Bounds
from quintet.components.shared.geometry.lattice import fill_box
from quintet.components.sph_fluid.boundary.parts import standing
from quintet.components.sph_fluid.boundary.walls import wall_velocity
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.setup.geometry import cells, levels
from quintet.components.sph_fluid.setup.initial import InitialFields
from quintet.components.sph_fluid.setup.tait import TAIT
from quintet.components.sph_fluid.state import Array, State

OFFSETS = np.array([0.0, 0.5 * (math.sqrt(5.0) - 1.0), math.sqrt(2.0) - 1.0])  # 1, per row in y, z
FADING = 10.0  # spacings from a wall within which the offsets of rows fade


def state(params: SphFluidParams) -> State:
    """Initial state: each box under the hydrostatic pressure of the surface above it."""
    boxes = [box_points(box, params) for box in params.boxes]
    wall, _ = standing(params)
    pairs = zip(boxes, params.boxes, strict=True)
    dense = [hydrostatic(points, box, params) for points, box in pairs]
    if params.shapes:
        shape_particles = shape_points(params)
        boxes, dense = boxes + shape_particles, dense + shape_density(shape_particles, params)
    start = State.empty(sum(map(len, boxes)), len(wall))
    start.position_density[:, :3] = np.concatenate([*boxes, wall])
    start.position_density[:, 3] = np.concatenate([*dense, wall_density(wall, params)])
    start.velocity_pressure[start.fluid :, :3] = wall_velocity(wall, params)
    if params.wave is not None:
        moves = params.wave.velocity(boxes[0], params.boxes[0], params.gravity)
        start.velocity_pressure[: len(moves), :3] = moves
    if params.initial is not None:
        _write_initial(start, params.initial, params.density)
    if params.boundary.tank is not None:
        start.exit_face = np.zeros(start.fluid, np.int64)
    if params.acoustic_damper > 0.0:
        start.minus_rho_div_u = np.zeros(start.particles)
    start.largest_acceleration = math.hypot(*params.gravity)
    return start


def shape_points(params: SphFluidParams) -> list[Array]:
    """Particles (n, 3) m of each shape that is no box."""
    # Left out of scenes whose fluid is in boxes.
    from quintet.components.sph_fluid.setup.shape_filling import fill_shape

    return [fill_shape(shape, params.spacing, params.dimensions == 2) for shape in params.shapes]


def shape_density(points: list[Array], params: SphFluidParams) -> list[Array]:
    """Density (n,) kg/m3 of each shape: under its highest point at rest, or ρ₀."""
    return [
        hydrostatic(particles, shape.bounds, params)
        if shape.hydrostatic
        else np.full(len(particles), params.density)
        for particles, shape in zip(points, params.shapes, strict=True)
    ]


def _write_initial(state: State, initial: InitialFields, unpressed: float) -> None:
    """Write velocity and density as a scene gives them; `unpressed` is ρ₀ [kg/m3]."""
    points = state.position_density[: state.fluid, :3]
    velocity, density = initial.velocity_at(points), initial.density_at(points, unpressed)
    if velocity is not None:
        state.velocity_pressure[: state.fluid, :3] = velocity
    if density is not None:
        state.position_density[: state.fluid, 3] = density


def box_points(box: Bounds, params: SphFluidParams) -> Array:
    """Middles of the cells of a box; (n, 3) m, x fastest."""
    points = fill_box(box, cells(box, params.spacing, params.dimensions))
    if params.staggered:
        points[:, 0] += _offsets(points, box, params)
    return points


def _offsets(points: Array, box: Bounds, params: SphFluidParams) -> Array:
    """How far rows are moved along x, half a cell at most, none at the tank's own faces; (n,) m.

    By multiples of two irrational numbers, which no two rows nearby share: whole they are a lattice
    too, as much at rest as the cubic one, but none of its planes meets a face at once.
    """
    low, high = np.array(box)
    counts = cells(box, params.spacing, params.dimensions)
    row = np.floor((points - low) / (high - low) * counts)
    offset = np.mod(0.5 + row @ OFFSETS, 1.0) - 0.5
    for end, side in enumerate(("x-", "x+") if params.boundary.tank else ()):
        if side not in params.boundary.open_faces:
            assert params.boundary.tank is not None
            wall_distance = np.abs(points[:, 0] - params.boundary.tank[end][0]) / (
                FADING * params.spacing
            )
            offset *= np.minimum(wall_distance, 1.0)
    return np.asarray(offset * (high[0] - low[0]) / counts[0])


def hydrostatic(points: Array, box: Bounds, params: SphFluidParams) -> Array:
    """Density (n,) kg/m3 at points (n, 3) m below the surface over a box of fluid at rest."""
    size = math.hypot(*params.hydrostatic_gravity)
    depth = _surface(box, params) + points @ np.array(params.hydrostatic_gravity) / (size or 1.0)
    pressure = params.density * size * np.maximum(depth, 0.0)
    stiffness = params.sound_speed**2 * params.density / TAIT  # Pa
    return params.density * (1.0 + pressure / stiffness) ** (1.0 / TAIT)


def _surface(box: Bounds, params: SphFluidParams) -> float:
    """Level [m] of the surface over a box: its own upper face, or that of boxes on it."""
    top, tolerance = levels(box, params.hydrostatic_gravity)[1], 1e-6 * params.spacing
    level = top
    for other_box in params.boxes if any(params.hydrostatic_gravity) else ():
        ends = zip(*box, *other_box, strict=True)
        overlap = [min(high, upper) - max(low, lower) for low, high, lower, upper in ends]
        beside = min(overlap) > -tolerance and sum(width > tolerance for width in overlap) > 1
        lowest, highest = levels(other_box, params.hydrostatic_gravity)
        if beside and abs(lowest - top) < tolerance < highest - top:
            level = max(level, _surface(other_box, params))
    return level


def wall_density(wall: Array, params: SphFluidParams) -> Array:
    """Density (n,) kg/m3 of wall particles (n, 3) m: that of the fluid they touch, or ρ₀."""
    density = np.full(len(wall), params.density)
    if params.boundary.method == "potential":
        return density
    for box in params.boxes:
        low, high = np.array(box)
        margin = (params.boundary.wall_offset + 0.51) * params.spacing
        rows = np.flatnonzero(((wall > low - margin) & (wall < high + margin)).all(axis=1))
        density[rows] = np.maximum(density[rows], hydrostatic(wall[rows], box, params))
    return density
