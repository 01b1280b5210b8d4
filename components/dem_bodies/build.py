"""From parameters to arrays: mass, inertia, contact spheres and edges of each body."""

from collections.abc import Sequence
from itertools import product
from typing import NamedTuple

import numpy as np

from quintet.components.dem_bodies.contact import materials
from quintet.components.dem_bodies.params import (
    DIRECTIONS,
    DemBodiesParams,
    Material,
)
from quintet.components.dem_bodies.shapes import planar
from quintet.components.dem_bodies.shapes.placement import (
    ROUNDED,
    bounding_radius,
    contact_spheres,
    cover,
    edge_radius,
    rotation_matrix,
)
from quintet.components.dem_bodies.shapes.rigid_body import RigidBody
from quintet.components.dem_bodies.shapes.sphere_union import measure_union
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
from quintet.components.shared.geometry.polygons import area_moments
from quintet.interfaces.faces import CORNERS

SKIN = 0.4  # over the smallest length of contact: pairs nearer than that are listed
THIN = 0.1  # of a box's longest edge: what is thinner is listed as if it were not
# Pairs of corners that differ in one coordinate.
EDGES = np.array([(k, k + step) for step in (1, 2, 4) for k in range(8) if not k & step])


class Solid(NamedTuple):
    """Mass and inertia of one body, and the spheres that make its contacts."""

    mass: float  # kg
    inertia: Numbers  # (3, 3) kg m2, body axes
    centres: Numbers  # (s, 3) m, body axes
    radii: Numbers  # (s,) m
    size: Numbers  # (3,) m, edges of the box that holds it


def solids(params: DemBodiesParams) -> list[Solid]:
    """Measure all bodies; copies share what is found of the first."""
    each = zip(params.placed.templates, params.placed.counts, strict=True)
    return [one for body, count in each for one in count * [solid(body)]]


def solid(body: RigidBody) -> Solid:
    """Measure a body: a union of spheres by voxels, all others exactly."""
    if body.size is not None:
        size = np.array(body.size)
        volume = float(size.prod())
        inertia = (np.eye(3) * (size**2).sum() - np.diag(size**2)) / 12.0 * volume
        centres = CORNERS * (0.5 * size - edge_radius(body))
        radii = np.full(8, edge_radius(body))
    else:
        centres, radii = contact_spheres(body)
        size = np.ptp(np.vstack([centres - radii[:, None], centres + radii[:, None]]), axis=0)
        if body.shape in planar.SHAPES:
            volume, inertia = planar_inertia(body)
            if body.corners is not None:
                size[[0, 2]] = np.ptp(planar.corners(body), axis=0)
            size[1] = 1.0
        elif body.radius is not None:
            diameter = 2.0 * body.radius
            volume = np.pi / 6.0 * diameter**3
            inertia = np.eye(3) * volume * diameter**2 / 10.0
        elif (covered := cover(body)) is not None:
            volume, inertia = covered.volume, covered.inertia
        else:
            assert body.centres is not None and body.radii is not None
            volume, _, inertia = measure_union((body.centres, body.radii))
    density = body.density if body.mass is None else body.mass / volume
    assert density is not None
    return Solid(density * volume, density * inertia, centres, radii, size)


def planar_inertia(body: RigidBody) -> tuple[float, Numbers]:
    """Volume [m3] of 1 m along y, and inertia at unit density: about all axes that about y."""
    if body.radius is not None:
        diameter = 2.0 * body.radius
        area, moment = np.pi / 4.0 * diameter**2, np.pi / 32.0 * diameter**4
    else:
        area, _, moment = area_moments(planar.corners(body))
    return area, moment * np.eye(3)


def skin(bodies: Sequence[RigidBody], solids: Sequence[Solid]) -> float:
    """Distance [m] within which pairs are listed.

    It follows the smallest contact radius; but the edge radius of a sharp box, or of a thin plate,
    is no measure of how far it goes before it touches, and lists would be renewed at every step.
    """
    return SKIN * min(map(contact_length, bodies, solids))


def contact_length(body: RigidBody, one: Solid) -> float:
    """Smallest radius [m] by which a body bears; of a box at least that of a less slender one."""
    radius = float(one.radii.min())
    if body.corners is not None:
        return max(radius, ROUNDED * max(planar.shortest_edge(body), THIN * float(one.size.max())))
    if body.size is None:
        return radius
    return max(radius, ROUNDED * max(min(body.size), THIN * max(body.size)))


def contact_radii(body: RigidBody, one: Solid) -> Numbers:
    """Radii (s,) m by which the spheres of a body bear: of corners, that of a blunt edge."""
    if body.size is None and body.corners is None:
        return one.radii
    return np.full(len(one.radii), contact_length(body, one))


def half_thickness(body: RigidBody) -> float:
    """Half the least width [m] of a box or polygon."""
    if body.size is not None:
        return 0.5 * min(body.size)
    corner = planar.corners(body)
    return float(-planar.polygon_distance(corner, np.zeros((1, 2)))[0])


def material_pairs(params: DemBodiesParams) -> Numbers:
    """Table (materials, materials, 5) of E* [Pa], G* [Pa], ζ, μ and μ_r."""
    names = list(params.materials)
    table = np.zeros((len(names), len(names), 5))
    for (i, a), (j, b) in product(enumerate(params.materials.values()), repeat=2):
        table[i, j] = material_pair(a, b)
    for pair in params.pairs:
        i, j = (names.index(name) for name in pair.between)
        if pair.restitution is not None:
            table[i, j, 2] = table[j, i, 2] = materials.damping_ratio(pair.restitution)
        if pair.friction is not None:
            table[i, j, 3] = table[j, i, 3] = pair.friction
        if pair.rolling_friction is not None:
            table[i, j, 4] = table[j, i, 4] = pair.rolling_friction
    return table


def material_pair(a: Material, b: Material) -> Numbers:
    """E* [Pa], G* [Pa], ζ, μ and μ_r of two materials: the lower of both where they differ."""
    moduli, ratios = (a.youngs_modulus, b.youngs_modulus), (a.poissons_ratio, b.poissons_ratio)
    return np.array(
        [
            materials.effective_modulus(moduli, ratios),
            materials.effective_shear(moduli, ratios),
            materials.damping_ratio(min(a.restitution, b.restitution)),
            min(a.friction, b.friction),
            min(a.rolling_friction, b.rolling_friction),
        ]
    )


def balls_first(bodies: Sequence[RigidBody]) -> list[int]:
    """Bodies in the order of their rows at the start."""
    return sorted(range(len(bodies)), key=lambda k: not is_ball(bodies[k]))


def is_ball(body: RigidBody) -> bool:
    """Whether a body is one sphere and free: those have a list and kernels of their own."""
    return body.radius is not None and not body.locked


def free_motion(body: RigidBody) -> list[float]:
    """Write 1 for each direction along and about which a body may move, 0 where it is locked."""
    return [float(one not in body.locked) for one in DIRECTIONS]


def model(params: DemBodiesParams, bodies: Sequence[RigidBody], solids: list[Solid]) -> Model:
    """Arrays of all that never changes, of bodies in the order of their rows."""
    planes = params.planes
    names = {name: k for k, name in enumerate(params.materials)}
    n = len(bodies) + 1
    half, rounded = np.zeros((n, 3)), np.zeros(n)
    bearing, thickness = np.zeros(n), np.full(n, np.inf)
    counts, edges = np.zeros(n + 1, np.int64), np.zeros(n + 1, np.int64)
    for k, body in enumerate(bodies):
        counts[k + 1] = len(solids[k].radii)
        if body.size is not None:
            rounded[k] = edge_radius(body)
            half[k] = 0.5 * np.array(body.size) - rounded[k]
            edges[k + 1] = len(EDGES)
        elif body.corners is not None:
            rounded[k] = edge_radius(body)
        if rounded[k] > 0.0:
            bearing[k], thickness[k] = contact_length(body, solids[k]), half_thickness(body)
    material = [names[body.material] for body in bodies] + [0]
    balls = [is_ball(body) for body in bodies]
    first = np.cumsum(counts)
    boxes = [int(first[k]) + EDGES for k, body in enumerate(bodies) if body.size is not None]
    normals = np.array([plane.normal for plane in planes]).reshape(-1, 3)
    normals = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    points = np.array([plane.point for plane in planes]).reshape(-1, 3)
    inverses = [np.asarray(np.linalg.inv(one.inertia), np.float64) for one in solids]
    return Model(
        inverse_mass=np.array([1.0 / one.mass for one in solids] + [0.0]),
        inverse_inertia=np.array([packed(one) for one in inverses] + [np.zeros(6)]),
        inertia=np.array([packed(one.inertia) for one in solids] + [np.zeros(6)]),
        inverse_moment=np.array([one[0, 0] for one in inverses] + [0.0]),
        isotropic=np.array([isotropic(one.inertia) for one in solids] + [True]),
        ball=np.array([*balls, False]),
        free=np.array([free_motion(body) for body in bodies] + [[1.0] * 6]),
        locked=np.array([*(bool(body.locked) for body in bodies), False]),
        others=np.flatnonzero(~np.array(balls)),
        half_extent=half,
        edge_radius=rounded,
        body_contact_radius=bearing,
        half_thickness=thickness,
        sharp=bearing > rounded,
        polygon=np.array([*(body.corners is not None for body in bodies), False]),
        bounding_radius=np.array([bounding_radius(body) for body in bodies]),
        material=np.array(material),
        kind=kinds(solids, material),
        sphere_begin=first,
        sphere_row=np.repeat(np.arange(n), counts[1:]),
        sphere_centre=np.vstack([one.centres for one in solids]),
        sphere_radius=np.concatenate([one.radii for one in solids]),
        contact_radius=np.concatenate(
            [contact_radii(body, one) for body, one in zip(bodies, solids, strict=True)]
        ),
        edge_begin=np.cumsum(edges),
        edge_ends=np.vstack(boxes) if boxes else np.zeros((0, 2), np.int64),
        plane=np.column_stack([normals, (normals * points).sum(axis=1)]),
        plane_material=as_whole([names[plane.material] for plane in planes]),
        material_pairs=material_pairs(params),
        gravity=np.array(params.gravity),
    )


def kinds(solids: list[Solid], material: list[int]) -> Whole:
    """Number the kinds of bodies, which differ in mass, radius or material; and the ground."""
    of = [(one.mass, float(one.radii[0]), a) for one, a in zip(solids, material, strict=False)]
    number = {kind: k for k, kind in enumerate(dict.fromkeys(of))}
    return np.array([number[kind] for kind in of] + [len(number)])


def as_whole(numbers: list[int]) -> Whole:
    """Integer array, also of nothing."""
    return np.array(numbers, np.int64)


def packed(matrix: Numbers) -> Numbers:
    """Six numbers xx yy zz xy xz yz of a symmetric matrix."""
    return matrix[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]


def isotropic(inertia: Numbers) -> bool:
    """Whether a body turns about all axes alike, so that ω is parallel to its angular momentum."""
    return bool(np.abs(inertia - inertia[0, 0] * np.eye(3)).max() <= 1e-14 * inertia[0, 0])


def state(bodies: Sequence[RigidBody], number: list[int], solids: list[Solid]) -> State:
    """Arrays of all that moves, as it is at the start; `number` is that of each row's body."""
    n = len(bodies) + 1
    spheres = sum(len(one.radii) for one in solids)
    momenta, inverses = [], []
    for body, one in zip(bodies, solids, strict=True):
        axes = rotation_matrix(body.orientation)
        inertia = axes @ one.inertia @ axes.T
        momentum = inertia @ np.array(body.angular_velocity)
        inverse = np.asarray(np.linalg.inv(inertia), np.float64)
        if body.locked:
            free = np.array(free_motion(body)[3:])
            momentum, inverse = free * momentum, inverse_of_free(inertia, free)
        momenta.append(momentum)
        inverses.append(inverse)
    orientations = np.array([body.orientation for body in bodies] + [(1.0, 0.0, 0.0, 0.0)])
    motion = np.zeros((n, COLUMNS))
    motion[:-1, :3] = [body.position for body in bodies]
    motion[:-1, RADIUS] = [bounding_radius(body) for body in bodies]
    motion[:-1, VELOCITY : VELOCITY + 3] = [body.velocity for body in bodies]
    motion[:-1, OMEGA : OMEGA + 3] = [body.angular_velocity for body in bodies]
    rows, report = np.array([*number, n - 1]), np.zeros(REPORTED)
    report[DEEPEST_PAIR] = -1.0  # nothing touches as far as is known
    return State(
        body=rows,
        row=np.argsort(rows),
        motion=motion,
        orientation=orientations / np.linalg.norm(orientations, axis=1, keepdims=True),
        angular_momentum=np.array([*momenta, np.zeros(3)]),
        contact_load=np.zeros((n, 6)),
        previous_contact_load=np.zeros((n, 6)),
        load=np.zeros((n, 6)),
        axes=np.tile(np.eye(3).reshape(9), (n, 1)),
        world_inverse_inertia=np.array([packed(world) for world in inverses] + [np.zeros(6)]),
        centre=np.zeros((spheres, 3)),
        listed_centre=np.full((spheres, 3), np.inf),
        report=report,
    )


def inverse_of_free(inertia: Numbers, free: Numbers) -> Numbers:
    """Inverse (3, 3) 1/(kg m2) of what is free of an inertia; 0 about locked axes."""
    both = np.outer(free, free)
    return np.asarray(both * np.linalg.inv(both * inertia + np.diag(1.0 - free)))


def expected_frequency(
    params: DemBodiesParams, bodies: Sequence[RigidBody], solids: Sequence[Solid]
) -> float:
    """Bound of √(S_n/m*) [rad/s] in impacts at the expected speed.

    For each material the lightest contact and the largest radius are taken, though they may be
    of different bodies.
    """
    table, names = material_pairs(params)[:, :, 0], list(params.materials)
    lightest, largest = np.zeros(len(names)), np.zeros(len(names))
    for body, one in zip(bodies, solids, strict=True):
        k = names.index(body.material)
        lightest[k] = max(lightest[k], largest_inverse_effective_mass(one))
        largest[k] = max(largest[k], contact_radii(body, one).max())
    boxes = any(body.shape in ("box", "polygon") for body in bodies)
    found = []
    for i in np.flatnonzero(lightest):
        for j in np.flatnonzero(lightest):
            radius = 1.0 / (1.0 / largest[i] + 1.0 / largest[j])
            if boxes:  # a sphere on a box's face has its own radius
                radius = max(largest[i], largest[j])
            mass = 1.0 / (lightest[i] + lightest[j])
            found.append(materials.impact_frequency(table[i, j], radius, mass, params.impact_speed))
        for plane in params.planes:
            modulus = table[i, names.index(plane.material)]
            mass = 1.0 / lightest[i]
            found.append(materials.impact_frequency(modulus, largest[i], mass, params.impact_speed))
    return float(max(found))


def largest_inverse_effective_mass(one: Solid) -> float:
    """Largest 1/m* [1/kg] of a body's contact spheres over all directions of the normal."""
    x, y, z = one.centres.T
    o = np.zeros_like(x)
    skew = np.array([[o, -z, y], [z, o, -x], [-y, x, o]]).transpose(2, 0, 1)  # r × n = skew n
    turning = skew.transpose(0, 2, 1) @ np.linalg.inv(one.inertia) @ skew
    return 1.0 / one.mass + float(np.linalg.eigvalsh(turning).max())
