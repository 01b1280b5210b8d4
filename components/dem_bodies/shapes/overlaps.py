"""Bodies that start inside one another or below a plane, found without making their copies.

Equal copies on a lattice overlap as one of them and its neighbours do. Of scattered ones all places
are looked at, unless the widest scatter cannot make them touch; of very many that is required.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations, product

import numpy as np
from numpy.typing import NDArray

from quintet.components.dem_bodies.shapes import placement, planar
from quintet.components.dem_bodies.shapes.copies import Bodies, at, places, some_places
from quintet.components.dem_bodies.shapes.rigid_body import Plane, RigidBody
from quintet.components.shared.search.overlapping import overlapping
from quintet.interfaces.component import Array

Mask = NDArray[np.bool_]

MOST_SCATTERED = 400_000  # copies whose places are looked at one by one
MOST_NEIGHBOURS = 20_000  # of a copy, within whose reach it stands


def check(bodies: Bodies, planes: Sequence[Plane]) -> None:
    """Refuse bodies that start inside one another or below a plane."""
    for k in np.flatnonzero(may_be_low(bodies, planes)).tolist():
        for m, plane in enumerate(planes):
            require_above(bodies.first[k], bodies.templates[k], m, plane)
    for k in np.flatnonzero(bodies.have_copies()[bodies.kind]).tolist():
        require_apart(bodies.first[k], bodies.templates[k])
    check_others(bodies)


def may_be_low(bodies: Bodies, planes: Sequence[Plane]) -> Mask:
    """Whether each template has copies, or is not above a plane by its bounding radius."""
    low, reach = bodies.have_copies()[bodies.kind], bounding_radii(bodies)
    x, y, z = bodies.poses["position"].T
    for plane in planes:
        (a, b, c), (nx, ny, nz) = plane.point, plane.normal
        rise = (x - a) * nx + (y - b) * ny + (z - c) * nz
        low = low | ~(rise / math.hypot(*plane.normal) > reach)
    return low


def bounding_radii(bodies: Bodies) -> Array:
    """Radius (t,) m about the centre of mass that holds each template."""
    return np.array([placement.bounding_radius(kind) for kind in bodies.kinds])[bodies.kind]


def require_above(first: int, body: RigidBody, m: int, plane: Plane) -> None:
    """Refuse a body, or the lowest of its copies, that reaches below a plane."""
    allowed = placement.ALLOWED * placement.bounding_radius(body)
    number, gap = 0, placement.plane_gap(body, plane)
    if body.copies is not None:
        number, gap = lowest_copy(body, plane, gap, allowed)
    if gap < -allowed:
        raise ValueError(
            f"bodies[{first + number}] must start above planes[{m}]; it reaches {-gap:.6g} m "
            "below. Raise it, or turn the plane's normal to the free side."
        )


def lowest_copy(body: RigidBody, plane: Plane, gap: float, allowed: float) -> tuple[int, float]:
    """Number of the lowest copy above a plane, and its gap [m], that of the first being given."""
    assert body.copies is not None
    normal = np.array(plane.normal) / np.linalg.norm(plane.normal)
    lattice, counts = body.copies, np.array(body.copies.number)
    down = np.minimum(normal * lattice.spacing, 0.0) * (counts - 1)
    lowest = gap + float(down.sum())
    if lattice.scatter == 0.0 or lowest - scatter(body) @ np.abs(normal) > -allowed:
        x, y, z = np.where(down < 0.0, counts - 1, 0).tolist()
        return (x * counts[1] + y) * counts[2] + z, lowest
    if counts.prod() <= MOST_SCATTERED:
        gaps = gap + (places(body) - body.position) @ normal
        return int(np.argmin(gaps)), float(gaps.min())
    return 0, lowest - float(scatter(body) @ np.abs(normal))


def scatter(body: RigidBody) -> Array:
    """By how much each copy at most is moved along each axis; (3,) m."""
    assert body.copies is not None
    return body.copies.scatter * np.array([1.0, body.shape not in planar.SHAPES, 1.0])


def extent(body: RigidBody) -> Array:
    """How far a body reaches from its position along each axis, to either side; (2, 3) m."""
    if body.size is not None:
        turned = np.abs(placement.rotation_matrix(body.orientation))
        reach = turned @ (0.5 * np.array(body.size))
        return np.array([-reach, reach])
    centres, radii = placement.world_spheres(body)
    arms = centres - body.position
    return np.array([(arms - radii[:, None]).min(axis=0), (arms + radii[:, None]).max(axis=0)])


def require_apart(first: int, body: RigidBody) -> None:
    """Refuse copies of a body that overlap each other."""
    assert body.copies is not None
    lattice, moved = body.copies, 2.0 * scatter(body)
    allowed = placement.ALLOWED * placement.bounding_radius(body)
    room = float(np.linalg.norm(moved))
    for index in neighbours(body, np.ptp(extent(body), axis=0) + moved):
        step = index * np.array(lattice.spacing)
        if body.radius is not None:  # round ones keep the distance that the step leaves
            gap = float(np.linalg.norm(step)) - 2.0 * body.radius
            nearest = np.maximum(np.abs(step) - moved, 0.0)
            least = float(np.linalg.norm(nearest)) - 2.0 * body.radius
        else:
            x, y, z = (step + body.position).tolist()
            gap = placement.body_gap(body, replace(body, position=(x, y, z)))
            least = gap - room
        if least >= -allowed:
            continue
        _, ny, nz = lattice.number
        other = int((index[0] * ny + index[1]) * nz + index[2])
        begin = max(0, -other)
        if lattice.scatter == 0.0:
            refuse(first + begin, first + begin + other, gap)
        if math.prod(lattice.number) > MOST_SCATTERED:
            raise ValueError(
                f"bodies[{first}].copies: more than {MOST_SCATTERED} must not overlap however they "
                f"are scattered; by {lattice.scatter:g} m some may, by {-least:.6g} m. Lower "
                "scatter, or widen spacing."
            )
        refuse_pairs(first, body)
        return


def neighbours(body: RigidBody, reach: Array) -> Iterator[Array]:
    """Steps (3,) to the copies within reach of one, each pair of copies once; axes first."""
    assert body.copies is not None
    counts, step = np.array(body.copies.number), np.array(body.copies.spacing)
    most = np.minimum(counts - 1, np.ceil(reach / step)).astype(np.int64)
    along = [np.eye(3, dtype=np.int64)[axis] for axis in range(3) if most[axis] > 0]
    yield from along
    if math.prod((2 * most + 1).tolist()) > 2 * MOST_NEIGHBOURS:
        raise ValueError(
            f"bodies: copies must stand within reach of at most {MOST_NEIGHBOURS} others; found "
            f"spacing {body.copies.spacing} m of bodies that reach over {tuple(reach.tolist())} m. "
            "Widen it."
        )
    for index in product(*(range(-n, n + 1) for n in most.tolist())):
        if index > (0, 0, 0) and sum(map(abs, index)) > 1:
            yield np.array(index)


def refuse_pairs(first: int, body: RigidBody) -> None:
    """Refuse scattered copies of which two overlap, as they stand."""
    where = places(body)
    radius = np.full(len(where), placement.bounding_radius(body))
    for i, j in overlapping(where, radius):
        if body.radius is not None:
            gap = np.linalg.norm(where[i] - where[j], axis=1) - 2.0 * body.radius
        else:
            pairs = zip(where[i], where[j], strict=True)
            gap = np.array([placement.body_gap(at(body, a), at(body, b)) for a, b in pairs])
        refuse_deepest(first + i, first + j, gap, np.minimum(radius[i], radius[j]))


def check_others(bodies: Bodies) -> None:
    """Refuse bodies that overlap others than their own copies."""
    single = np.flatnonzero(bodies.counts == 1)
    several = np.flatnonzero(bodies.counts > 1).tolist()
    if len(single) > 1:
        where, radius = bodies.poses["position"][single], bounding_radii(bodies)[single]
        compare(bodies, single, np.zeros_like(single), where, radius)
    boxes = {k: bounds(bodies.templates[k]) for k in several}
    for k in several:
        beside = [j for j in single.tolist() if meet(boxes[k], bounds(bodies.templates[j]))]
        if beside:
            compare_lattice(bodies, k, beside)
    for k, j in combinations(several, 2):
        if meet(boxes[k], boxes[j]):
            compare_lattice(bodies, k, [j])


def bounds(body: RigidBody) -> Array:
    """Lowest and highest corner (2, 3) m of what holds a body and its copies."""
    ends = np.array(body.position) + extent(body)
    if body.copies is not None:
        steps = np.array(body.copies.spacing) * (np.array(body.copies.number) - 1)
        ends += np.array([-scatter(body), steps + scatter(body)])
    return ends


def meet(box_i: Array, box_j: Array) -> bool:
    """Whether two boxes (2, 3) m overlap."""
    return bool((np.minimum(box_i[1], box_j[1]) > np.maximum(box_i[0], box_j[0])).all())


def compare_lattice(bodies: Bodies, k: int, others: list[int]) -> None:
    """Compare the copies of one body with others, which may have copies too, where both are."""
    groups: list[tuple[Array, ...]] = []  # template, number, place and radius of each
    boxes = {j: bounds(bodies.templates[j]) for j in (k, *others)}
    low = np.min([boxes[j][0] for j in others], axis=0)
    high = np.max([boxes[j][1] for j in others], axis=0)
    rooms = {k: np.array([low, high]), **dict.fromkeys(others, boxes[k])}
    for j, room in rooms.items():
        body = bodies.templates[j]
        if body.copies and body.copies.scatter and bodies.counts[j] > MOST_SCATTERED:
            raise ValueError(
                f"bodies[{bodies.first[j]}].copies: more than {MOST_SCATTERED} scattered ones must "
                f"keep clear of other bodies; they stand in {boxes[j].tolist()} m. Move them."
            )
        around = np.ptp(extent(body), axis=0)
        numbers, where = some_places(body, room[0] - around, room[1] + around)
        radius = np.full(len(where), placement.bounding_radius(body))
        groups.append((np.full(len(where), j), numbers, where, radius))
    compare(bodies, *map(np.concatenate, zip(*groups, strict=True)))


def compare(bodies: Bodies, group: Array, number: Array, where: Array, radius: Array) -> None:
    """Refuse two of these bodies that overlap: their templates, numbers, places (n, 3) m, radii."""
    first, counts = bodies.first[group] + number, bodies.counts
    round_ = np.array([kind.radius is not None for kind in bodies.kinds])[bodies.kind[group]]
    for i, j in overlapping(where, radius):
        other = (group[i] != group[j]) | (counts[group[i]] == 1)
        i, j = i[other], j[other]
        gap = np.linalg.norm(where[i] - where[j], axis=1) - radius[i] - radius[j]
        for k in np.flatnonzero(~(round_[i] & round_[j])):
            pair = (at(bodies.templates[group[n]], where[n]) for n in (i[k], j[k]))
            gap[k] = placement.body_gap(*pair)
        refuse_deepest(first[i], first[j], gap, np.minimum(radius[i], radius[j]))


def refuse_deepest(i: Array, j: Array, gap: Array, size: Array) -> None:
    """Refuse the first pair whose gap [m] is an overlap that counts."""
    wrong = np.flatnonzero(gap < -placement.ALLOWED * size)
    if len(wrong):
        k = wrong[np.lexsort((np.maximum(i, j)[wrong], np.minimum(i, j)[wrong]))[0]]
        refuse(int(min(i[k], j[k])), int(max(i[k], j[k])), float(gap[k]))


def refuse(i: int, j: int, gap: float) -> None:
    """Say which two bodies overlap."""
    raise ValueError(
        f"bodies[{i}] and bodies[{j}] must not overlap at the start; they do by {-gap:.6g} m. Move "
        "one of them; touching is allowed."
    )
