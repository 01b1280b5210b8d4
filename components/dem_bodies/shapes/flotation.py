"""Whether bodies float as they are placed: their mass, and that of the water in which they begin.

The water inside a body is removed at the start, so that it stands in as much as its surface
displaces below the level. It then rises or sinks until it displaces its own mass or rests on the
bottom; the level of the rest of the water follows all bodies. How they turn meanwhile, and forces
other than gravity, are left out.
"""

import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple, Self

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
LONGEST = 20.0  # edge of a body over the diagonal of the water; longer: probably a wrong unit
ROUNDING = 1e-9  # of the edges of the water
NEARLY = 0.01  # of a body's height
FAR = 0.25  # of a body's mass: a larger difference from the displaced water gets a remedy
SAME = 1e-6  # relative change of the displaced water at which the level has converged
MOST_TRIED = 100  # levels, until then
REST = "rests on the bottom"
REMEDY = "If it is to float at rest, correct its height, mass, scale or orientation."


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

    def is_around(self, points: Array) -> bool:
        """Whether points (..., 3) m lie within its bounds along x and y."""
        places, rim = points[..., :2], ROUNDING * self.size[:2]
        return bool(np.all((places >= self.low[:2] - rim) & (places <= self.high[:2] + rim)))


def still_water(stated: Fields) -> StillWater | None:
    """The water among what a partner states, if it is there."""
    if any(field.name not in stated for field in STILL_WATER):
        return None
    low, high, density = (stated[field.name][0] for field in STILL_WATER)
    return StillWater(low, high, float(density))


class FreeBody(NamedTuple):
    """A body that may float."""

    mass: float  # kg
    heights: Heights  # of its surface, where it begins
    lowest: float  # m, its lowest point
    highest: float  # m
    begins_in: float  # kg, water that it displaces where it begins
    most: float  # kg, water that it displaces under water
    draught: float  # m, its lowest point below the level where it floats; inf if it sinks

    @classmethod
    def of(cls, mass: float, triangles: Array, water: StillWater) -> Self:
        """Measure a body of triangles (t, 3, 3) m."""
        heights, level = Heights.of(triangles), float(water.high[2])
        lowest, highest = float(heights.lowest.min()), float(heights.highest.max())
        begins_in = water.density * heights.volume_below(level)
        most = water.density * heights.volume_below(highest)
        draught = heights.level_of(mass / water.density) - lowest if mass < most else math.inf
        return cls(mass, heights, lowest, highest, begins_in, most, draught)


def flotation_notes(bodies: Bodies, water: StillWater) -> tuple[str, ...]:
    """Say of free boxes and meshes in or above the water how far they are from where they float.

    Where bodies of other shapes float too, how far the level follows is not known: nothing is then
    said of where bodies come to rest.
    """
    if len(bodies) > MOST:
        return ()
    free: dict[int, FreeBody] = {}
    all_known = True
    for number, body in enumerate(bodies):
        if "z" in body.locked and body.released_at is None:
            continue
        triangles = surface_triangles(body)
        if not water.is_around(np.array(body.position) if triangles is None else triangles):
            continue
        if triangles is None:
            all_known = False
        else:
            free[number] = FreeBody.of(mass_of(body), triangles, water)
    change = level_change(tuple(free.values()), water) if all_known else None
    numbers: dict[str, list[str]] = {}
    for number, free_body in free.items():
        numbers.setdefault(flotation(free_body, water, change), []).append(str(number))
    return tuple(
        f"{'each of ' if len(alike) > 1 else ''}bodies[{', '.join(alike)}] {text}"
        for text, alike in numbers.items()
    )


def level_change(bodies: Sequence[FreeBody], water: StillWater) -> float:
    """How far [m] the level rises until all bodies float or rest on the bottom."""
    begin_in = sum(body.begins_in for body in bodies)
    displaced = [min(body.mass, body.most) for body in bodies]  # kg
    for _ in range(MOST_TRIED):
        change = (sum(displaced) - begin_in) / water.density / water.area
        depth = float(water.size[2]) + change
        before, displaced = displaced, [_displaced(body, depth, water.density) for body in bodies]
        if np.allclose(displaced, before, rtol=SAME, atol=0.0):
            break
    return change


def _displaced(body: FreeBody, depth: float, density: float) -> float:
    """Water [kg] that a body displaces at rest, in water of a depth [m]."""
    if body.draught <= depth:
        return body.mass
    return density * body.heights.volume_below(body.lowest + depth)


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


def flotation(body: FreeBody, water: StillWater, change: float | None) -> str:
    """Say what a body weighs, what it stands in, and where it floats.

    Parameters
    ----------
    body : FreeBody
    water : StillWater
    change : float or None, m
        How far the level rises; None where that is not known.
    """
    mass, level = body.mass, float(water.high[2])
    text = f"weighs {mass:.4g} kg and stands in {body.begins_in:.4g} kg of water"
    if body.lowest >= level:
        text = f"weighs {mass:.4g} kg and begins {body.lowest - level:.3g} m above the water"
    if mass >= body.most:
        text += f": it displaces at most {body.most:.4g} kg and sinks"
    elif change is not None:
        rise = level + change - body.draught - body.lowest  # m, of the body
        rests = body.lowest + rise < water.low[2]
        way = _way(rise, body.highest - body.lowest)
        text += f": without turning or other forces, it {REST if rests else f'floats {way}'}"
    return f"{text}. {REMEDY}" if abs(body.begins_in - mass) > FAR * mass else text


def _way(rise: float, height: float) -> str:
    if abs(rise) < NEARLY * height:
        return "where it is"
    return f"{abs(rise):.2g} m {'higher' if rise > 0.0 else 'lower'}"


def _size(lengths: Iterable[float]) -> str:
    return " x ".join(f"{length:.4g}" for length in lengths)
