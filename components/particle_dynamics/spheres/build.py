"""Spheres from their parameters, with lattices of copies; overlaps at the start are refused."""

import math
from collections.abc import Sequence

import numpy as np

from quintet.components.particle_dynamics.spheres.params import Sphere, Wall
from quintet.components.particle_dynamics.spheres.start import places
from quintet.components.particle_dynamics.spheres.state import Spheres, State
from quintet.components.shared.search.sphere_pairs import Pairs
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError

ROOM = 0.9  # of the distance in contact, at least: a tenth may overlap


def build(entries: Sequence[Sphere]) -> Spheres:
    """Make the arrays of spheres, in the order of the scene."""
    count = [sphere.count for sphere in entries]

    def repeated(name: str) -> Array:
        return np.repeat(np.array([getattr(sphere, name) for sphere in entries], float), count, 0)

    radius, parcel = repeated("radius"), repeated("parcel")
    mass = parcel * repeated("density") * 4.0 / 3.0 * math.pi * radius**3
    start, launch = places(entries), repeated("launch")
    first = 0
    for sphere in entries:
        if sphere.copies is not None:
            rows = slice(first, first + sphere.count)
            launch[rows] += sphere.copies.interval * np.arange(sphere.count)
        first += sphere.count
    return Spheres(
        start=start,
        first_velocity=repeated("velocity"),
        first_spin=repeated("angular_velocity"),
        launch=launch,
        radius=radius,
        mass=mass,
        inertia=0.4 * mass * radius**2,
        capacity=mass * repeated("specific_heat"),
        tether=repeated("tether"),
        parcel=parcel,
        temperature=repeated("temperature"),
    )


def initial_state(spheres: Spheres) -> State:
    """Spheres at rest where they start; none is launched yet."""
    count = len(spheres.mass)
    return State(
        position=spheres.start.copy(),
        velocity=np.zeros((count, 3)),
        orientation=np.tile([1.0, 0.0, 0.0, 0.0], (count, 1)),
        spin=np.zeros((count, 3)),
        temperature=spheres.temperature.copy(),
        force=np.zeros((count, 3)),
        torque=np.zeros((count, 3)),
        heat=np.zeros(count),
        launched=np.zeros(count, bool),
        sums=np.zeros(4),
    )


def planes(walls: Sequence[Wall]) -> Array:
    """Unit normals and offsets [m] of walls, (w, 4)."""
    plane = np.array([[*wall.normal, wall.offset] for wall in walls]).reshape(-1, 4)
    plane[:, :3] /= np.linalg.norm(plane[:, :3], axis=1, keepdims=True)
    return plane


def refuse_overlaps(start: Array, radius: Array, near: Pairs) -> None:
    """Refuse spheres that overlap at the start.

    Parameters
    ----------
    start : (n, 3) float array, m
    radius : (n,) float array, m
    near : Pairs
        Includes all pairs that overlap.
    """
    first = np.repeat(np.arange(len(radius)), np.diff(near.begin))
    second = near.other[: near.begin[-1]]
    apart = np.linalg.norm(start[first] - start[second], axis=1)
    contact = radius[first] + radius[second]
    wrong = np.flatnonzero(apart < ROOM * contact)
    if len(wrong):
        k = wrong[np.argmin((apart / contact)[wrong])]
        raise SceneError(
            f"spheres: centres of {first[k]} and {second[k]} must be {ROOM * contact[k]:.6g} m "
            f"apart at the start, {ROOM:g} of their distance in contact; found {apart[k]:.6g} m. "
            "Move them apart, also those that wait for their launch, or set collisions = false."
        )


def refuse_behind_walls(start: Array, radius: Array, planes: Array) -> None:
    """Refuse spheres that start in a wall (w, 4), or behind it."""
    for number, plane in enumerate(planes):
        height = start @ plane[:3] - plane[3]  # m
        wrong = np.flatnonzero(height < ROOM * radius)
        if len(wrong):
            k = wrong[np.argmin((height - radius)[wrong])]
            raise SceneError(
                f"walls.{number}: the centre of sphere {k} must be "
                f"{ROOM * radius[k]:.6g} m in front of it at the start, {ROOM:g} of its "
                f"radius; found {height[k]:.6g} m. Move the sphere, turn normal, or correct offset."
            )
