"""Spheres as their parameters describe them, lattices of copies among them."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from quintet.components.particle_dynamics.spheres.params import Sphere, Wall
from quintet.components.shared.geometry.lattice import lattice_points
from quintet.interfaces.component import Array


class Spheres(NamedTuple):
    """What never changes; of a parcel mass, inertia and capacity are those of all in it."""

    start: Array  # (n, 3) m
    first_velocity: Array  # (n, 3) m/s, when it is launched
    first_spin: Array  # (n, 3) rad/s
    launch: Array  # (n,) s
    radius: Array  # (n,) m
    mass: Array  # (n,) kg
    inertia: Array  # (n,) kg m2
    capacity: Array  # (n,) J/K
    tether: Array  # (n,) N/m
    parcel: Array  # (n,) 1
    temperature: Array  # (n,) K, at the start


def build(given: Sequence[Sphere]) -> Spheres:
    """Make the arrays of spheres, in the order in which they are given."""
    count = [one.count for one in given]

    def of(name: str) -> Array:
        return np.repeat(np.array([getattr(one, name) for one in given], float), count, axis=0)

    radius, parcel = of("radius"), of("parcel")
    mass = parcel * of("density") * 4.0 / 3.0 * math.pi * radius**3
    start, launch = of("centre"), of("launch")
    first = 0
    for one in given:
        if one.copies is not None:
            rows, axes = slice(first, first + one.count), map(np.arange, one.copies.number)
            places = lattice_points(list(axes), x_fastest=False)
            start[rows] += places * np.array(one.copies.spacing)
            launch[rows] += one.copies.interval * np.arange(one.count)
        first += one.count
    return Spheres(
        start=start,
        first_velocity=of("velocity"),
        first_spin=of("angular_velocity"),
        launch=launch,
        radius=radius,
        mass=mass,
        inertia=0.4 * mass * radius**2,
        capacity=mass * of("specific_heat"),
        tether=of("tether"),
        parcel=parcel,
        temperature=of("temperature"),
    )


def planes(walls: Sequence[Wall]) -> Array:
    """Unit normals and offsets [m] of walls, (w, 4)."""
    made = np.array([[*one.normal, one.offset] for one in walls]).reshape(-1, 4)
    made[:, :3] /= np.linalg.norm(made[:, :3], axis=1, keepdims=True)
    return made
