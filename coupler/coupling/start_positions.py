"""Where rigid bodies stand at the start: within the tank, and beside the water and what is in it.

A body that touches is none that overlaps: up to half a spacing of the fluid, neither particles nor
samples meet. Boxes along the axes are (2, 3) m, the lowest and the highest corner.
"""

from dataclasses import dataclass
from itertools import product

import numpy as np

from quintet.coupler.coupling.rigid_samples import Sampling, corners_of
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.ports import BOX, POLYGON
from quintet.interfaces.rotation import matrix

TOUCH = 0.5  # spacings by which a body may overlap
ROUNDING = 1e-6  # of a spacing
PARALLEL = 1e-9  # sine of an angle that counts as none
MOST_TOLD = 5  # bodies
CORNERS = np.array(list(product((-0.5, 0.5), repeat=3)))  # of a box of edges 1
NONE = np.zeros((0, 2, 3))
PLANAR, SPATIAL = [0, 2], [0, 1, 2]  # axes of two dimensions and of three
SAID = {  # of boxes that no body may begin in: what they are, and what to do
    "wet": (
        "water",
        "Move it, make the water of boxes around it, or let the fluid set remove_inside_bodies.",
    ),
    "solid": ("obstacles", "Move one of them."),
}


@dataclass(frozen=True, slots=True)
class Standing:
    """One convex body where it begins, in the axes of its dimensions."""

    radius: float  # m, of what is round; else 0
    corner: Array  # (k, d) m, in the world; the centre of what is round
    normal: Array  # (m, d) axes that may part it from a box along the axes

    @property
    def bounds(self) -> Array:
        """Lowest and highest corner (2, d) m of what holds it."""
        ends = self.corner.min(axis=0) - self.radius, self.corner.max(axis=0) + self.radius
        return np.stack(ends)


@dataclass(frozen=True, slots=True)
class Room:
    """Where a fluid begins, in the axes of its dimensions."""

    tank: Array  # (0 or 1, 2, d) m
    closed: Array  # (0 or 1, 2, d) whether its lower and upper faces are closed
    taken: dict[str, Array]  # "wet" and "solid": boxes (n, 2, d) m
    slack: float  # m, by which a body may overlap


def misplaced(names: tuple[str, str], fluid: Fields, bodies: Fields, asked: Sampling) -> list[str]:
    """Say which bodies begin where they must not.

    Parameters
    ----------
    names : two str
        Of the fluid and of the bodies.
    fluid : mapping of arrays
        What the fluid states of where it begins, `ports.BEGINNING`; of what it does not state
        nothing is said.
    bodies : mapping of arrays
        Static fields of the port `motion`, and the pose at the start.
    asked : Sampling
        By the fluid.
    """
    axes = PLANAR if asked.planar else SPATIAL
    faces = fluid.get("surface.closed", np.zeros((0, 6))).reshape(-1, 3, 2).transpose(0, 2, 1)
    boxes = {name: fluid.get(f"surface.{name}", NONE)[:, :, axes] for name in SAID}
    tank = fluid.get("surface.tank", NONE)[:, :, axes]
    slack = (TOUCH + ROUNDING) * asked.spacing
    room = Room(tank, faces[: len(tank), :, axes] > 0.0, boxes, slack)
    found = []
    for number in np.flatnonzero(_suspect(bodies, room, axes)):
        said = _misplaced(_standing(bodies, int(number), axes), room, axes, names[0])
        if said:
            found.append(f"body {number} of {names[1]} {said}")
        if len(found) == MOST_TOLD:
            break
    return found


def _suspect(bodies: Fields, room: Room, axes: list[int]) -> Array:
    """Which bodies (n,) may be misplaced, by the spheres that hold them."""
    corners = corners_of(bodies)
    radius = 0.5 * np.linalg.norm(bodies["motion.size"], axis=1)
    for k in np.flatnonzero(bodies["motion.shape"] == POLYGON):
        radius[k] = np.linalg.norm(corners[k], axis=1).max()
    place = bodies["motion.position"][:, axes]
    low, high = place - radius[:, None], place + radius[:, None]
    found = np.zeros(len(place), bool)
    for box in room.tank:
        found |= (low < box[0]).any(axis=1) | (high > box[1]).any(axis=1)
    for box in np.concatenate(list(room.taken.values())):
        found |= ((low < box[1]) & (high > box[0])).all(axis=1)
    return found


def _standing(bodies: Fields, number: int, axes: list[int]) -> Standing:
    """Read one body at its pose."""
    shape, size = bodies["motion.shape"][number], bodies["motion.size"][number]
    to_world = matrix(bodies["motion.orientation"][number : number + 1])[0]
    centre = bodies["motion.position"][number]
    if shape == BOX:
        own, others = to_world.T, np.eye(3)
        crossed = np.cross(own[:, None], others[None]).reshape(-1, 3)
        length = np.linalg.norm(crossed, axis=1)
        across = crossed[length > PARALLEL] / length[length > PARALLEL, None]
        corner = centre + CORNERS * size @ to_world.T
        return Standing(0.0, corner, np.vstack([others, own, across]))
    if shape == POLYGON:
        corner = (corners_of(bodies)[number] @ to_world.T + centre)[:, axes]
        along = np.roll(corner, -1, axis=0) - corner
        away = np.stack([along[:, 1], -along[:, 0]], axis=1)
        away /= np.linalg.norm(away, axis=1, keepdims=True)
        return Standing(0.0, corner, np.vstack([np.eye(2), away]))
    return Standing(0.5 * float(size[0]), centre[None, axes], np.eye(len(axes)))


def _misplaced(body: Standing, room: Room, axes: list[int], fluid: str) -> str:
    """Say where a body must not begin, and what to do; "" where all is well."""
    for box, closed in zip(room.tank, room.closed, strict=True):
        if said := _outside(body.bounds, box, closed, axes, room.slack, fluid):
            return said
    for name, (what, remedy) in SAID.items():
        for number, box in enumerate(room.taken[name]):
            if (depth := overlap(body, box)) > room.slack:
                return (
                    f"must begin outside the {what} of {fluid}; it reaches {depth:.3g} m into "
                    f"box {number} of it, {_text(box, axes)}. {remedy}"
                )
    return ""


def _outside(
    bounds: Array, box: Array, closed: Array, axes: list[int], slack: float, fluid: str
) -> str:
    over = np.array([box[0] - bounds[0], bounds[1] - box[1]])  # (2, d) m, beyond each face
    clear = np.array([bounds[1] <= box[0], bounds[0] >= box[1]])  # all of it is beyond that face
    if (clear & ~closed).any():  # it is to fall in, or has left
        return ""
    wrong = np.argwhere(closed & (over > slack))
    if not len(wrong):
        return ""
    end, axis = wrong[0]
    face = f"{'xyz'[axes[axis]]}{'-+'[end]}"
    return (
        f"must begin within the tank of {fluid}, {_text(box, axes)}; it reaches "
        f"{over[end, axis]:.3g} m beyond face {face}. Move it, or open that face."
    )


def _text(box: Array, axes: list[int]) -> str:
    each = zip(axes, box[0], box[1], strict=True)
    return ", ".join(f"{'xyz'[axis]} {low:g} to {high:g} m" for axis, low, high in each)


def overlap(body: Standing, box: Array) -> float:
    """How far [m] a convex body reaches into a box along the axes; negative: it is beside it."""
    if body.radius:
        beyond = np.abs(body.corner[0] - box.mean(axis=0)) - 0.5 * np.ptp(box, axis=0)
        away = np.linalg.norm(np.maximum(beyond, 0.0)) + min(float(beyond.max()), 0.0)
        return body.radius - float(away)
    corners = np.array(list(product(*box.T)))
    mine, its = body.corner @ body.normal.T, corners @ body.normal.T
    reach = np.minimum(mine.max(axis=0) - its.min(axis=0), its.max(axis=0) - mine.min(axis=0))
    return float(reach.min())
