"""From parameters to the arrays of all bodies, and their state at the start."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from quintet.components.dem_bodies.contact.expected import material_pairs
from quintet.components.dem_bodies.params import DIRECTIONS, DemBodiesParams
from quintet.components.dem_bodies.shapes.copies import Bodies
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


def balls_first(bodies: Bodies) -> Whole:
    """Bodies (m,) in the order of their rows at the start."""
    is_other = np.array([not is_ball(kind) for kind in bodies.kinds])
    return np.argsort(is_other[bodies.kind_of_each()], kind="stable")


def model(params: DemBodiesParams, bodies: Bodies, number: Whole, solids: Sequence[Solid]) -> Model:
    """Arrays that never change; `number` holds the body of each row; the last is the ground.

    `solids` are those of the kinds of bodies.
    """
    names = {name: k for k, name in enumerate(params.materials)}
    kinds, kind = bodies.kinds, bodies.kind_of_each()[number]  # (m,) of each row
    with_ground = np.append(kind, len(kinds))
    materials = np.array([names[body.material] for body in kinds])
    balls = np.array([*(is_ball(body) for body in kinds), False])[with_ground]
    return Model(
        ball=balls,
        free=np.array([free_motion(body) for body in kinds] + [[1.0] * 6])[with_ground],
        locked=np.array([*(bool(body.locked) for body in kinds), False])[with_ground],
        others=np.flatnonzero(~balls[:-1]),
        polygon=np.array([*(body.corners is not None for body in kinds), False])[with_ground],
        bounding_radius=np.array([bounding_radius(body) for body in kinds])[kind],
        material=np.array([*materials, 0])[with_ground],
        kind=contact_kinds(solids, materials, kind),
        plane=planes(params.planes),
        plane_material=np.array([names[plane.material] for plane in params.planes], np.int64),
        material_pairs=material_pairs(params),
        gravity=np.array(params.gravity),
        **{name: rows[with_ground] for name, rows in inertias(solids).items()},
        **{name: rows[with_ground] for name, rows in edges(kinds, solids).items()},
        **spheres(kinds, solids, kind),
    )


def inertias(solids: Sequence[Solid]) -> dict[str, Any]:
    """Masses and inertias of kinds of bodies and the ground, as `Model` holds them."""
    inverses = [np.asarray(np.linalg.inv(solid.inertia), np.float64) for solid in solids]
    return {
        "inverse_mass": np.array([1.0 / solid.mass for solid in solids] + [0.0]),
        "inverse_inertia": np.array([packed(inverse) for inverse in inverses] + [np.zeros(6)]),
        "inertia": np.array([packed(solid.inertia) for solid in solids] + [np.zeros(6)]),
        "inverse_moment": np.array([inverse[0, 0] for inverse in inverses] + [0.0]),
        "isotropic": np.array([isotropic(solid.inertia) for solid in solids] + [True]),
    }


def edges(kinds: Sequence[RigidBody], solids: Sequence[Solid]) -> dict[str, Any]:
    """Rounded edges and faces of kinds of boxes and polygons, as `Model` holds them."""
    n = len(kinds) + 1
    half, rounded = np.zeros((n, 3)), np.zeros(n)
    contact_radius, thickness = np.zeros(n), np.full(n, np.inf)
    for k, body in enumerate(kinds):
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


def spheres(kinds: Sequence[RigidBody], solids: Sequence[Solid], kind: Whole) -> dict[str, Any]:
    """Contact spheres of rows of kinds (m,), and the edges between them, as `Model` holds them."""
    of_kinds = np.array([len(solid.radii) for solid in solids])
    counts = of_kinds[kind]
    begin = np.concatenate([[0], np.cumsum(counts)])
    # Sphere of the kinds' spheres that each sphere is.
    first = (np.cumsum(of_kinds) - of_kinds)[kind]
    source = np.arange(begin[-1]) + np.repeat(first - begin[:-1], counts)
    box = np.array([body.size is not None for body in kinds])[kind]
    pairs = zip(kinds, solids, strict=True)
    return {
        "sphere_begin": np.append(begin, begin[-1]),
        "sphere_row": np.repeat(np.arange(len(kind)), counts),
        "sphere_centre": np.vstack([solid.centres for solid in solids])[source],
        "sphere_radius": np.concatenate([solid.radii for solid in solids])[source],
        "contact_radius": np.concatenate([contact_radii(*pair) for pair in pairs])[source],
        "edge_begin": np.concatenate([[0], np.cumsum(np.append(len(EDGES) * box, 0))]),
        "edge_ends": (begin[:-1][box][:, None, None] + EDGES).reshape(-1, 2),
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


def contact_kinds(solids: Sequence[Solid], material: Whole, kind: Whole) -> Whole:
    """Number the rows of bodies by what differs in mass, radius or material; and the ground.

    `material` is that of each kind of bodies, `kind` (m,) that of each row.
    """
    appearing, first = np.unique(kind, return_index=True)
    number: dict[tuple[float, float, int], int] = {}
    of_kind = np.zeros(len(solids), np.int64)
    for k in appearing[np.argsort(first)].tolist():
        known = (solids[k].mass, float(solids[k].radii[0]), int(material[k]))
        of_kind[k] = number.setdefault(known, len(number))
    return np.append(of_kind[kind], len(number))


def packed(matrix: Numbers) -> Numbers:
    """Six numbers xx yy zz xy xz yz of a symmetric matrix."""
    return matrix[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]


def isotropic(inertia: Numbers) -> bool:
    """Whether the moment of inertia is the same about all axes, so that ω is parallel to L."""
    return bool(np.abs(inertia - inertia[0, 0] * np.eye(3)).max() <= 1e-14 * inertia[0, 0])


def state(bodies: Bodies, number: Whole, solids: Sequence[Solid]) -> State:
    """State at the start; `number` (m,) holds the body of each row.

    `solids` are those of the kinds of bodies.
    """
    n, rows, kind = len(bodies) + 1, np.append(number, len(bodies)), bodies.kind_of_each()[number]
    orientation, spin = bodies.of_each("orientation")[number], bodies.of_each("angular_velocity")
    radius = np.array([bounding_radius(body) for body in bodies.kinds])
    orientations = np.vstack([orientation, (1.0, 0.0, 0.0, 0.0)])
    motion = np.zeros((n, COLUMNS))
    motion[:-1, :3] = bodies.positions()[number]
    motion[:-1, RADIUS] = radius[kind]
    motion[:-1, VELOCITY : VELOCITY + 3] = bodies.of_each("velocity")[number]
    motion[:-1, OMEGA : OMEGA + 3] = spin[number]
    momenta, inverses = turning(bodies, solids, kind, orientation, spin[number])
    count = sum(np.bincount(kind, minlength=len(solids)) * [len(solid.radii) for solid in solids])
    report = np.zeros(REPORTED)
    report[DEEPEST_PAIR] = -1.0  # no contact is known
    return State(
        body=rows,
        row=np.argsort(rows),
        motion=motion,
        orientation=orientations / np.linalg.norm(orientations, axis=1, keepdims=True),
        angular_momentum=np.vstack([momenta, np.zeros(3)]),
        contact_load=np.zeros((n, 6)),
        previous_contact_load=np.zeros((n, 6)),
        load=np.zeros((n, 6)),
        axes=np.tile(np.eye(3).reshape(9), (n, 1)),
        world_inverse_inertia=np.vstack([inverses, np.zeros(6)]),
        centre=np.zeros((count, 3)),
        listed_centre=np.full((count, 3), np.inf),
        report=report,
    )


def turning(
    bodies: Bodies, solids: Sequence[Solid], kind: Whole, orientation: Numbers, spin: Numbers
) -> tuple[Numbers, Numbers]:
    """Angular momenta (m, 3) and packed inverse inertias (m, 6), in world axes, of rows.

    What turns alike is computed once.
    """
    both = np.ascontiguousarray(np.column_stack([orientation, spin])).view(np.int64)
    _, first, source = np.unique(
        np.column_stack([kind, both]), axis=0, return_index=True, return_inverse=True
    )
    momenta, inverses = np.zeros((len(first), 3)), np.zeros((len(first), 6))
    for k, row in enumerate(first.tolist()):
        turned, spinning = tuple(orientation[row].tolist()), tuple(spin[row].tolist())
        body = replace(bodies.kinds[kind[row]], orientation=turned, angular_velocity=spinning)
        momenta[k], inverse = momentum(body, solids[kind[row]])
        inverses[k] = packed(inverse)
    return momenta[source.reshape(-1)], inverses[source.reshape(-1)]


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
