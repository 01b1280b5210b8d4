"""A start from the state of another run, whose planes, materials and locks may differ."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from quintet.components.dem_bodies.build import free_motion, inverse_of_free, packed
from quintet.components.dem_bodies.shapes.copies import Bodies
from quintet.components.dem_bodies.shapes.placement import (
    ALLOWED,
    bounding_radius,
    rotation_matrix,
)
from quintet.components.dem_bodies.shapes.solid import Solid, is_ball
from quintet.components.dem_bodies.state import (
    FIRST,
    KIND,
    OMEGA,
    RADIUS,
    VELOCITY,
    Model,
    Numbers,
    Whole,
)
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import SceneError

SAME = 1e-9  # relative difference of planes, radii and inertias that are the same
SURROUNDINGS = ("surroundings.planes", "surroundings.pairs", "surroundings.gravity")
Saved = dict[str, Array]


@dataclass(frozen=True, slots=True)
class Lists:
    """What the lists of pairs hold in this run."""

    rolling: bool  # whether balls resist rolling
    forces: bool  # whether the force of each pair is recorded


def surroundings(model: Model) -> Saved:
    """Planes (p, 5) with materials, properties of pairs of materials, and gravity: see `fitted`."""
    planes = np.column_stack([model.plane, model.plane_material.astype(float)])
    arrays = (planes, model.material_pairs.copy(), model.gravity.copy())
    return dict(zip(SURROUNDINGS, arrays, strict=True))


def fitted(
    state: Fields, bodies: Bodies, solids: list[Solid], model: Model, lists: Lists
) -> tuple[Saved, bool]:
    """Fit a saved state to the bodies of this run; tell whether anything around them has changed.

    Contacts keep their history where body and plane are there in both runs. Nothing is changed
    where nothing differs, so that the run goes on with the same bits.

    Raises
    ------
    SceneError
        Where the state is of other bodies, or a plane cuts through them.
    """
    saved: Saved = {name: np.array(array) for name, array in state.items()}
    require_same_bodies(saved, bodies, solids)
    saved["load"][:] = 0.0  # of partners, who tell it before the first step
    after = surroundings(model)
    changed = any(not np.array_equal(saved[name], after[name]) for name in SURROUNDINGS)
    if not np.array_equal(saved[SURROUNDINGS[0]], after[SURROUNDINGS[0]]):
        number = same_planes(saved[SURROUNDINGS[0]], model.plane)
        new = np.setdiff1d(np.arange(len(model.plane)), number)
        require_above(saved, bodies, model, new)
        renumber_planes(saved, number)
        saved["listed_centre"][:] = np.inf  # pairs are listed again
    changed |= fit_lists(saved, lists)
    changed |= fit_balls(saved, bodies, solids)
    changed |= fit_others(saved, bodies, solids)
    return saved, changed


def require_same_bodies(saved: Saved, bodies: Bodies, solids: list[Solid]) -> None:
    """Refuse a state of other bodies: their number, sizes and contact spheres."""
    saved_count = len(saved["body"]) - 1
    if saved_count != len(bodies):
        raise SceneError(
            f"bodies must be as many as in the state that it begins from, {saved_count}; found "
            f"{len(bodies)}. Make both scenes alike."
        )
    kind = bodies.kind_of_each()
    radius = np.array([bounding_radius(body) for body in bodies.kinds])[kind]
    before = saved["motion"][saved["row"][:saved_count], RADIUS]
    if len(wrong := np.flatnonzero(np.abs(radius - before) > SAME * radius)):
        k = int(wrong[0])
        raise SceneError(
            f"bodies[{k}] must be as large as in the state that it begins from, where it reaches "
            f"{before[k]:.6g} m from its centre; found {radius[k]:.6g} m. Make both scenes alike."
        )
    balls = np.array([is_ball(body) for body in bodies.kinds])[kind]
    spheres = int(np.array([len(solid.radii) for solid in solids])[kind].sum())
    rows = len(saved.get("balls.begin", np.zeros(1))) - 1
    same = rows == np.count_nonzero(balls) and balls[saved["body"][:rows].astype(np.int64)].all()
    if not same or spheres != len(saved["centre"]):
        raise SceneError(
            "bodies must have the shapes that they have in the state that it begins from, and "
            "spheres that are locked there must be locked here; they differ. Make both scenes "
            "alike; a released_at lets go of a locked sphere."
        )


def same_planes(before: Numbers, planes: Numbers) -> Whole:
    """Number that each plane (p, 5) of a state has among planes (q, 4); -1: it is not there."""
    number = np.full(len(before), -1, np.int64)
    for k, plane in enumerate(before):
        gap = np.abs(planes - plane[:4]) <= SAME * (1.0 + np.abs(plane[:4]))
        free = [m for m in np.flatnonzero(gap.all(axis=1)).tolist() if m not in number]
        number[k] = free[0] if free else -1
    return number


def require_above(saved: Saved, bodies: Bodies, model: Model, new: Whole) -> None:
    """Refuse planes that were not there before and cut through bodies."""
    count = len(saved["body"]) - 1
    others = saved["body"][len(saved.get("balls.begin", np.zeros(1))) - 1 : count]
    for m in new.tolist():
        normal, offset = model.plane[m, :3], model.plane[m, 3]
        depth = np.full(count, -np.inf)  # m, of each body
        motion, body = saved["motion"][:count], saved["body"][:count]
        depth[body] = motion[:, RADIUS] - (motion[:, :3] @ normal - offset)
        for k in others.tolist():  # whose corners reach less far than the sphere that holds them
            row = saved["row"][k]
            spheres = slice(model.sphere_begin[row], model.sphere_begin[row + 1])
            heights = saved["centre"][spheres] @ normal - offset
            depth[k] = float((model.sphere_radius[spheres] - heights).max())
        radius = motion[saved["row"][:count], RADIUS]
        if len(wrong := np.flatnonzero(depth > ALLOWED * radius)):
            k = int(wrong[np.argmax(depth[wrong])])
            raise SceneError(
                f"planes[{m}] was not in the state that it begins from, so all bodies must lie "
                f"above it; bodies[{k}] reaches {depth[k]:.6g} m below. Move the plane."
            )


def renumber_planes(saved: Saved, number: Whole) -> None:
    """Give the planes of listed pairs their new numbers; leave out pairs without their plane."""
    rows = len(saved["body"])
    if "balls.begin" in saved:
        begin, partner = saved["balls.begin"], saved["balls.partner"]
        row = np.repeat(np.arange(len(begin) - 1), np.diff(begin))
        on_plane = partner >= rows
        partner[on_plane] = rows + number[partner[on_plane] - rows]
        remaining = np.flatnonzero(~on_plane | (partner >= rows))
        order = remaining[np.lexsort((partner[remaining], row[remaining]))]
        counts = np.bincount(row[order], minlength=len(begin) - 1)
        saved["balls.begin"] = np.concatenate([[0], np.cumsum(counts)])
        saved["balls.partner"] = partner[order]
        saved["balls.history"] = np.ascontiguousarray(saved["balls.history"][:, order])
        for name in ("balls.rolling_moment", "balls.force"):
            if len(saved.get(name, ())):
                saved[name] = saved[name][order]
    key = saved["others.key"]
    on_plane = key >> KIND == 0
    second = key & ((1 << FIRST) - 1)
    second[on_plane] = number[second[on_plane]]
    remaining = np.flatnonzero(second >= 0)
    key = (key >> FIRST << FIRST)[remaining] | second[remaining]
    order = np.argsort(key, kind="stable")
    saved["others.key"] = key[order]
    saved["others.history"] = np.ascontiguousarray(saved["others.history"][remaining][order])


def fit_lists(saved: Saved, lists: Lists) -> bool:
    """Give pairs of balls the arrays that this run needs of them; tell whether any is new."""
    if "balls.begin" not in saved:
        return False
    pairs = len(saved["balls.partner"])
    recorded = pairs if lists.rolling or lists.forces else 0
    has_moment = "balls.rolling_moment" in saved
    changed = has_moment != lists.rolling or len(saved["balls.force"]) != recorded
    if lists.rolling and not has_moment:
        saved["balls.rolling_moment"] = np.zeros((pairs, 3))
    if len(saved["balls.force"]) != recorded:
        saved["balls.force"] = np.zeros((recorded, 3))
    return changed


def fit_balls(saved: Saved, bodies: Bodies, solids: list[Solid]) -> bool:
    """Give balls the inertia of this run; tell whether any has another."""
    inverse = np.array([packed(np.asarray(np.linalg.inv(s.inertia), float)) for s in solids])
    rows = slice(0, len(saved.get("balls.begin", np.zeros(1))) - 1)
    after = inverse[bodies.kind_of_each()[saved["body"][rows]]]
    before = saved["world_inverse_inertia"][rows]
    if not (np.abs(after - before) > SAME * after[:, :1]).any():
        return False
    saved["world_inverse_inertia"][rows] = after
    return True


def fit_others(saved: Saved, bodies: Bodies, solids: list[Solid]) -> bool:
    """Give other bodies the inertia and locks of this run; tell whether any has others.

    In locked directions they move as this run says.
    """
    changed, kind = False, bodies.kind_of_each()
    velocity, spin = bodies.of_each("velocity"), bodies.of_each("angular_velocity")
    first = len(saved.get("balls.begin", np.zeros(1))) - 1
    for row in range(first, len(saved["body"]) - 1):
        k = int(saved["body"][row])
        body, inertia = bodies.kinds[kind[k]], solids[kind[k]].inertia
        free, motion = np.array(free_motion(body)), saved["motion"][row]
        motion[VELOCITY : VELOCITY + 3][free[:3] == 0.0] = velocity[k][free[:3] == 0.0]
        if not free[3:].any():
            motion[OMEGA : OMEGA + 3] = spin[k]
        changed |= turn_freely(saved, row, inertia, free[3:])
    return changed


def turn_freely(saved: Saved, row: int, inertia: Numbers, free: Numbers) -> bool:
    """Give a body its inverse inertia and angular momentum; tell whether its locks have changed."""
    w, x, y, z = saved["orientation"][row].tolist()
    axes: Any = rotation_matrix((w, x, y, z))
    world = axes @ inertia @ axes.T
    inverse = packed(inverse_of_free(world, free))
    scale = max(
        float(np.abs(inverse).max()), float(np.abs(saved["world_inverse_inertia"][row]).max())
    )
    if (np.abs(inverse - saved["world_inverse_inertia"][row]) <= SAME * scale).all():
        return False
    motion = saved["motion"][row]
    if 0.0 < free.sum() < 3.0:
        motion[OMEGA : OMEGA + 3] *= free
    saved["world_inverse_inertia"][row] = inverse
    saved["angular_momentum"][row] = free * (world @ motion[OMEGA : OMEGA + 3])
    return True
