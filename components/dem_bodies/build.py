"""From parameters to the arrays of all bodies, and their state at the start."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from quintet.components.dem_bodies.contact.expected import material_pairs
from quintet.components.dem_bodies.params import DIRECTIONS, DemBodiesParams
from quintet.components.dem_bodies.shapes.placement import (
    bounding_radius,
    edge_radius,
    rotation_matrix,
)
from quintet.components.dem_bodies.shapes.rigid_body import Plane, RigidBody
from quintet.components.dem_bodies.shapes.solid import (
    Solid,
    contact_length,
    contact_radii,
    half_thickness,
    is_ball,
)
from quintet.components.dem_bodies.state import (
    COLUMNS,
    DEEPEST_PAIR,
    OMEGA,
    RADIUS,
    REPORTED,
    VELOCITY,
    Model,
    Numbers,
    State,
    Whole,
)

# Pairs of corners that differ in one coordinate.
EDGES = np.array([(k, k + step) for step in (1, 2, 4) for k in range(8) if not k & step])


def balls_first(bodies: Sequence[RigidBody]) -> list[int]:
    """Bodies in the order of their rows at the start."""
    return sorted(range(len(bodies)), key=lambda k: not is_ball(bodies[k]))


def model(params: DemBodiesParams, bodies: Sequence[RigidBody], solids: list[Solid]) -> Model:
    """Arrays that never change, of bodies in the order of their rows; the last is the ground."""
    names = {name: k for k, name in enumerate(params.materials)}
    material = [names[body.material] for body in bodies] + [0]
    balls = np.array([*(is_ball(body) for body in bodies), False])
    return Model(
        ball=balls,
        free=np.array([free_motion(body) for body in bodies] + [[1.0] * 6]),
        locked=np.array([*(bool(body.locked) for body in bodies), False]),
        others=np.flatnonzero(~balls[:-1]),
        polygon=np.array([*(body.corners is not None for body in bodies), False]),
        bounding_radius=np.array([bounding_radius(body) for body in bodies]),
        material=np.array(material),
        kind=kinds(solids, material),
        plane=planes(params.planes),
        plane_material=np.array([names[plane.material] for plane in params.planes], np.int64),
        material_pairs=material_pairs(params),
        gravity=np.array(params.gravity),
        **inertias(solids),
        **edges(bodies, solids),
        **spheres(bodies, solids),
    )


def inertias(solids: list[Solid]) -> dict[str, Any]:
    """Masses and inertias of bodies and the ground, as `Model` holds them."""
    inverses = [np.asarray(np.linalg.inv(solid.inertia), np.float64) for solid in solids]
    return {
        "inverse_mass": np.array([1.0 / solid.mass for solid in solids] + [0.0]),
        "inverse_inertia": np.array([packed(inverse) for inverse in inverses] + [np.zeros(6)]),
        "inertia": np.array([packed(solid.inertia) for solid in solids] + [np.zeros(6)]),
        "inverse_moment": np.array([inverse[0, 0] for inverse in inverses] + [0.0]),
        "isotropic": np.array([isotropic(solid.inertia) for solid in solids] + [True]),
    }


def edges(bodies: Sequence[RigidBody], solids: list[Solid]) -> dict[str, Any]:
    """Rounded edges and faces of boxes and polygons, as `Model` holds them."""
    n = len(bodies) + 1
    half, rounded = np.zeros((n, 3)), np.zeros(n)
    contact_radius, thickness = np.zeros(n), np.full(n, np.inf)
    for k, body in enumerate(bodies):
        if body.size is None and body.corners is None:
            continue
        rounded[k] = edge_radius(body)
        contact_radius[k], thickness[k] = contact_length(body, solids[k]), half_thickness(body)
        if body.size is not None:
            half[k] = 0.5 * np.array(body.size) - rounded[k]
    return {
        "half_extent": half,
        "edge_radius": rounded,
        "body_contact_radius": contact_radius,
        "half_thickness": thickness,
        "sharp": contact_radius > rounded,
    }


def spheres(bodies: Sequence[RigidBody], solids: list[Solid]) -> dict[str, Any]:
    """Contact spheres of bodies, and the edges between them, as `Model` holds them."""
    counts = [len(solid.radii) for solid in solids]
    begin = np.cumsum([0, *counts, 0])
    box = np.array([body.size is not None for body in bodies])
    ends = [first + EDGES for first in begin[:-2][box]]
    pairs = zip(bodies, solids, strict=True)
    return {
        "sphere_begin": begin,
        "sphere_row": np.repeat(np.arange(len(bodies) + 1), [*counts, 0]),
        "sphere_centre": np.vstack([solid.centres for solid in solids]),
        "sphere_radius": np.concatenate([solid.radii for solid in solids]),
        "contact_radius": np.concatenate([contact_radii(*pair) for pair in pairs]),
        "edge_begin": np.cumsum([0, *(len(EDGES) * box), 0]),
        "edge_ends": np.vstack(ends) if ends else np.zeros((0, 2), np.int64),
    }


def planes(planes: Sequence[Plane]) -> Numbers:
    """Unit normals and offsets (p, 4) [m] of planes."""
    normals = np.array([plane.normal for plane in planes]).reshape(-1, 3)
    normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    points = np.array([plane.point for plane in planes]).reshape(-1, 3)
    return np.column_stack([normals, (normals * points).sum(axis=1)])


def free_motion(body: RigidBody) -> list[float]:
    """Write 1 for each direction along and about which a body may move, 0 where it is locked."""
    return [float(direction not in body.locked) for direction in DIRECTIONS]


def kinds(solids: list[Solid], material: list[int]) -> Whole:
    """Number the kinds of bodies, which differ in mass, radius or material; and the ground."""
    pairs = zip(solids, material, strict=False)
    kind_of = [(solid.mass, float(solid.radii[0]), number) for solid, number in pairs]
    number = {kind: k for k, kind in enumerate(dict.fromkeys(kind_of))}
    return np.array([number[kind] for kind in kind_of] + [len(number)])


def packed(matrix: Numbers) -> Numbers:
    """Six numbers xx yy zz xy xz yz of a symmetric matrix."""
    return matrix[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]


def isotropic(inertia: Numbers) -> bool:
    """Whether the moment of inertia is the same about all axes, so that ω is parallel to L."""
    return bool(np.abs(inertia - inertia[0, 0] * np.eye(3)).max() <= 1e-14 * inertia[0, 0])


def state(bodies: Sequence[RigidBody], number: list[int], solids: list[Solid]) -> State:
    """State at the start; `number` holds the number of each row's body."""
    n, rows = len(bodies) + 1, np.array([*number, len(bodies)])
    turning = [momentum(body, solid) for body, solid in zip(bodies, solids, strict=True)]
    orientations = np.array([body.orientation for body in bodies] + [(1.0, 0.0, 0.0, 0.0)])
    motion = np.zeros((n, COLUMNS))
    motion[:-1, :3] = [body.position for body in bodies]
    motion[:-1, RADIUS] = [bounding_radius(body) for body in bodies]
    motion[:-1, VELOCITY : VELOCITY + 3] = [body.velocity for body in bodies]
    motion[:-1, OMEGA : OMEGA + 3] = [body.angular_velocity for body in bodies]
    count, report = sum(len(solid.radii) for solid in solids), np.zeros(REPORTED)
    report[DEEPEST_PAIR] = -1.0  # no contact is known
    return State(
        body=rows,
        row=np.argsort(rows),
        motion=motion,
        orientation=orientations / np.linalg.norm(orientations, axis=1, keepdims=True),
        angular_momentum=np.array([*(momentum for momentum, _ in turning), np.zeros(3)]),
        contact_load=np.zeros((n, 6)),
        previous_contact_load=np.zeros((n, 6)),
        load=np.zeros((n, 6)),
        axes=np.tile(np.eye(3).reshape(9), (n, 1)),
        world_inverse_inertia=np.array([*(packed(inverse) for _, inverse in turning), np.zeros(6)]),
        centre=np.zeros((count, 3)),
        listed_centre=np.full((count, 3), np.inf),
        report=report,
    )


def momentum(body: RigidBody, solid: Solid) -> tuple[Numbers, Numbers]:
    """Angular momentum (3,) [kg m2/s] and inverse inertia (3, 3) [1/(kg m2)] in world axes."""
    axes = rotation_matrix(body.orientation)
    inertia = axes @ solid.inertia @ axes.T
    momentum = inertia @ np.array(body.angular_velocity)
    if not body.locked:
        return momentum, np.asarray(np.linalg.inv(inertia), np.float64)
    free = np.array(free_motion(body)[3:])
    return free * momentum, inverse_of_free(inertia, free)


def inverse_of_free(inertia: Numbers, free: Numbers) -> Numbers:
    """Inverse (3, 3) [1/(kg m2)] of the free part of an inertia; 0 about locked axes."""
    both = np.outer(free, free)
    return np.asarray(both * np.linalg.inv(both * inertia + np.diag(1.0 - free)))
