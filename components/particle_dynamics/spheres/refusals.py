"""What is refused of spheres at the start, and why."""

import numpy as np

from quintet.components.particle_dynamics.spheres.build import Spheres
from quintet.components.particle_dynamics.spheres.pairs import Pairs
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError

ROOM = 0.9  # of the distance in contact, at least: a tenth may overlap


def refuse_overlaps(spheres: Spheres, near: Pairs) -> None:
    """Refuse spheres that begin within one another.

    Parameters
    ----------
    spheres : Spheres
    near : Pairs
        All pairs that overlap are among these.
    """
    first = np.repeat(np.arange(len(spheres.mass)), np.diff(near.begin))
    second = near.other[: near.begin[-1]]
    apart = np.linalg.norm(spheres.start[first] - spheres.start[second], axis=1)
    contact = spheres.radius[first] + spheres.radius[second]
    wrong = np.flatnonzero(apart < ROOM * contact)
    if len(wrong):
        k = wrong[np.argmin((apart / contact)[wrong])]
        raise SceneError(
            f"spheres: centres of {first[k]} and {second[k]} must be {ROOM * contact[k]:.6g} m "
            f"apart at the start, {ROOM:g} of their distance in contact; found {apart[k]:.6g} m. "
            "Move them apart, also those that wait for their launch, or say collisions = false."
        )


def refuse_behind_walls(spheres: Spheres, planes: Array) -> None:
    """Refuse spheres that begin in a wall (w, 4), or behind it."""
    for number, plane in enumerate(planes):
        height = spheres.start @ plane[:3] - plane[3]  # m
        wrong = np.flatnonzero(height < ROOM * spheres.radius)
        if len(wrong):
            k = wrong[np.argmin((height - spheres.radius)[wrong])]
            raise SceneError(
                f"walls.{number}: the centre of sphere {k} must be "
                f"{ROOM * spheres.radius[k]:.6g} m in front of it at the start, {ROOM:g} of its "
                f"radius; found {height[k]:.6g} m. Move the sphere, turn normal, or correct offset."
            )
