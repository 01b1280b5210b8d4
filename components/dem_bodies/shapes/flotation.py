"""Whether bodies float as they are placed: their mass, and that of the water in which they begin.

The water inside a body is removed at the start, so that it stands in as much as its surface
displaces below the level. It then rises or sinks until it displaces its own mass; the level of the
rest of the water follows. How it turns meanwhile is left out.
"""

from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from quintet.components.dem_bodies.shapes.copies import Bodies
from quintet.components.dem_bodies.shapes.placement import rotation_matrix
from quintet.components.dem_bodies.shapes.rigid_body import RigidBody
from quintet.components.shared.geometry.box_faces import CORNERS, FACES
from quintet.components.shared.geometry.displacement import Heights
from quintet.components.shared.geometry.shapes import Mesh
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import SceneError
from quintet.interfaces.ports import STILL_WATER

MOST = 20  # bodies; for more, no notes
LONGEST = 20.0  # of a body over the diagonal of the water: a longer one is in a wrong unit
ROUNDING = 1e-9  # of the edges of the water
NEARLY = 0.01  # of a body's height
FAR = 0.25  # of a body's mass: the water that it stands in differs by more than it is likely to


class StillWater(NamedTuple):
    """A box of water at rest."""

    low: Array  # (3,) m, its corners
    high: Array  # (3,) m
    density: float  # kg/m3

    @property
    def size(self) -> Array:
        """Its edges (3,) m."""
        return self.high - self.low

    @property
    def area(self) -> float:
        """Of its level [m2]."""
        return float(np.prod(self.size[:2]))

    def is_around(self, triangles: Array) -> bool:
        """Whether triangles (t, 3, 3) m lie within its bounds along x and y."""
        corners, rim = triangles[:, :, :2], ROUNDING * self.size[:2]
        return bool(np.all((corners >= self.low[:2] - rim) & (corners <= self.high[:2] + rim)))


def still_water(stated: Fields) -> StillWater | None:
    """The water among what a partner states, if it is there."""
    if any(field.name not in stated for field in STILL_WATER):
        return None
    low, high, density = (stated[field.name][0] for field in STILL_WATER)
    return StillWater(low, high, float(density))


def flotation_notes(bodies: Bodies, water: StillWater) -> tuple[str, ...]:
    """Say of free boxes and meshes in or above the water how far they are from where they float."""
    if len(bodies) > MOST:
        return ()
    notes = []
    for number, body in enumerate(bodies):
        triangles = surface_triangles(body)
        if triangles is None or ("z" in body.locked and body.released_at is None):
            continue
        if water.is_around(triangles):
            notes.append(f"bodies[{number}] {flotation(mass_of(body), triangles, water)}")
    return tuple(notes)


def mass_of(body: RigidBody) -> float:
    """Mass [kg] of a box or mesh."""
    if body.mass is not None:
        return body.mass
    assert body.geometry is not None and body.density is not None
    return body.density * body.geometry.volume


def surface_triangles(body: RigidBody) -> Array | None:
    """Triangles (t, 3, 3) m of a box or mesh where it is; None of other shapes."""
    if isinstance(body.geometry, Mesh):
        solid = body.geometry.solid
        triangles = solid.triangles - solid.centre
    elif body.size is not None:
        corners = 0.5 * np.array(body.size) * CORNERS
        triangles = np.concatenate([corners[FACES[:, [0, 1, 2]]], corners[FACES[:, [0, 2, 3]]]])
    else:
        return None
    return np.asarray(triangles @ rotation_matrix(body.orientation).T + np.array(body.position))


def refuse_longer(bodies: Bodies, water: StillWater) -> None:
    """Refuse boxes and meshes that are far longer than the water: their unit must be wrong.

    Raises
    ------
    SceneError
        Of the first such body.
    """
    longest = LONGEST * float(np.linalg.norm(water.size))
    for kind, body in enumerate(bodies.kinds):
        size = edges(body)
        if size is None or max(size) <= longest:
            continue
        number = int(bodies.first[np.argmax(bodies.kind == kind)])
        name, remedy = "its box", "lowest and highest"
        if body.file is not None:
            name, remedy = f"{Path(body.file).name} at scale {body.scale or 1.0:g}", "scale"
        raise SceneError(
            f"bodies[{number}] must have edges of at most {longest:.4g} m, {LONGEST:g} times the "
            f"diagonal of its partner's water of {_size(water.size)} m; found {_size(size)} m of "
            f"{name}. Correct {remedy}, or the water."
        )


def edges(body: RigidBody) -> Iterable[float] | None:
    """Edges [m] of a box, or of the box that holds a mesh as its file has it."""
    if isinstance(body.geometry, Mesh):
        return np.ptp(body.geometry.solid.triangles, axis=(0, 1)).tolist()
    return body.size


def flotation(mass: float, triangles: Array, water: StillWater) -> str:
    """Say what a body weighs, what it stands in, and where it floats."""
    level, heights = float(water.high[2]), Heights.of(triangles)
    lowest, highest = float(triangles[:, :, 2].min()), float(triangles[:, :, 2].max())
    stands_in = water.density * heights.volume_below(level)  # kg
    most = water.density * heights.volume_below(highest)  # kg
    text = f"weighs {mass:.4g} kg and stands in {stands_in:.4g} kg of water"
    if lowest >= level:
        text = f"weighs {mass:.4g} kg and begins {lowest - level:.3g} m above the water"
    if mass >= most:
        return f"{text}: it displaces at most {most:.4g} kg and sinks. {_remedy()}"
    floats_at = heights.level_of(mass / water.density)  # where the level must be
    rise = level + (mass - stands_in) / water.density / water.area - floats_at  # m, of the body
    text += f": without turning, it floats {_way(rise, highest - lowest)}"
    return f"{text}. {_remedy()}" if abs(stands_in - mass) > FAR * mass else text


def _way(rise: float, height: float) -> str:
    if abs(rise) < NEARLY * height:
        return "where it is"
    return f"{abs(rise):.2g} m {'higher' if rise > 0.0 else 'lower'}"


def _remedy() -> str:
    return "Correct its height, mass, scale or orientation if that is not meant."


def _size(lengths: Iterable[float]) -> str:
    return " x ".join(f"{length:.4g}" for length in lengths)
