"""Whether bodies float as they are placed: their mass, and that of the water in which they begin.

The water inside a body is removed at the start, so that it stands in as much as its surface
displaces below the level. It then rises or sinks until it displaces its own mass; the level of the
rest of the water follows. How it turns meanwhile is left out.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np

from quintet.components.dem_bodies.shapes.copies import Bodies
from quintet.components.dem_bodies.shapes.placement import rotation_matrix
from quintet.components.dem_bodies.shapes.rigid_body import RigidBody
from quintet.components.dem_bodies.shapes.solid import measure
from quintet.components.shared.geometry.box_faces import CORNERS, FACES
from quintet.components.shared.geometry.displacement import displaced_volume, level_of_volume
from quintet.components.shared.geometry.shapes import Mesh
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import SceneError
from quintet.interfaces.ports import STILL_WATER, SURFACE

MOST = 20  # bodies; for more, no notes
NEARLY = 0.01  # of a body's height
FAR = 0.25  # of a body's mass: the water that it stands in differs by more than it is likely to


class StillWater(NamedTuple):
    """A box of water at rest."""

    low: Array  # (3,) m, its corners
    high: Array  # (3,) m
    density: float  # kg/m3

    @property
    def area(self) -> float:
        """Of its level [m2]."""
        return float(np.prod((self.high - self.low)[:2]))


def still_water(stated: Fields) -> StillWater | None:
    """The water that a partner states, if it does."""
    keys = [f"{SURFACE.name}.{field.name}" for field in STILL_WATER]
    if not stated.keys() >= set(keys):
        return None
    low, high, density = (stated[key][0] for key in keys)
    return StillWater(low, high, float(density))


def flotation_notes(bodies: Bodies, water: StillWater) -> tuple[str, ...]:
    """Say of free boxes and meshes how far they are from where they float.

    Raises
    ------
    SceneError
        Of a body that is longer than the diagonal of the water.
    """
    if len(bodies) > MOST:
        return ()
    notes = []
    for number, body in enumerate(bodies):
        triangles = surface_triangles(body)
        if triangles is None or ("z" in body.locked and body.released_at is None):
            continue
        refuse_longer(number, body, triangles, water)
        notes.append(f"bodies[{number}] {flotation(measure(body).mass, triangles, water)}")
    return tuple(notes)


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


def refuse_longer(number: int, body: RigidBody, triangles: Array, water: StillWater) -> None:
    """Refuse a body that is longer than the diagonal of the water: its scale must be wrong."""
    size, room = np.ptp(triangles, axis=(0, 1)), water.high - water.low
    if size.max() <= np.linalg.norm(room):
        return
    name, remedy = "its box", "lowest and highest"
    if body.file is not None:
        name, remedy = f"{Path(body.file).name} at scale {body.scale or 1.0:g}", "scale"
    raise SceneError(
        f"bodies[{number}] must fit into the water of its partner, which is {_size(room)} m; found "
        f"{_size(size)} m of {name}. Correct {remedy}, or the water."
    )


def flotation(mass: float, triangles: Array, water: StillWater) -> str:
    """Say what a body weighs, what it stands in, and where it floats."""
    level = float(water.high[2])
    lowest, highest = float(triangles[:, :, 2].min()), float(triangles[:, :, 2].max())
    stands_in = water.density * displaced_volume(triangles, level)  # kg
    most = water.density * displaced_volume(triangles, highest)  # kg
    text = f"weighs {mass:.4g} kg and stands in {stands_in:.4g} kg of water"
    if lowest >= level:
        text = f"weighs {mass:.4g} kg and begins {lowest - level:.3g} m above the water"
    if mass >= most:
        return f"{text}: it displaces at most {most:.4g} kg and sinks. {_remedy()}"
    floats_at = level_of_volume(triangles, mass / water.density)  # where the level must be
    rise = level + (mass - stands_in) / water.density / water.area - floats_at  # m, of the body
    text += f": without turning, it floats {_way(rise, highest - lowest)}"
    return f"{text}. {_remedy()}" if abs(stands_in - mass) > FAR * mass else text


def _way(rise: float, height: float) -> str:
    if abs(rise) < NEARLY * height:
        return "where it is"
    return f"{abs(rise):.2g} m {'higher' if rise > 0.0 else 'lower'}"


def _remedy() -> str:
    return "Correct its height, mass, scale or orientation if that is not meant."


def _size(edges: Array) -> str:
    return " x ".join(f"{edge:.4g}" for edge in edges)
