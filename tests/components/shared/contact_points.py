"""Particles and spheres above two squares and a wall, in contact with them."""

import numpy as np

from quintet.components.shared.contact.kernels import Points
from quintet.components.shared.contact.penalty import PenaltyContact

RADIUS, MODULUS, THICK = 0.5, 2.0, 1.0  # m, Pa, m; without Poisson's ratio
# Two squares in the plane z = 0 that share an edge, and a wall down from the end of the second.
NODES = np.array(
    [[0, 0, 0], [2, 0, 0], [4, 0, 0], [0, 2, 0], [2, 2, 0], [4, 2, 0], [4, 0, -2], [4, 2, -2]],
    float,
)
FACES = np.array([[0, 1, 4, 3], [1, 2, 5, 4], [2, 6, 7, 5]])


def contact_of(
    particles, node=NODES, face=FACES, mass=1.0, friction=0.0, step=1e9, spheres=False, points=1.0,
    radius=RADIUS, on_surface=False,
):  # fmt: skip
    count = len(face)
    static = {
        "corner": face.astype(float),
        "mass": np.full(len(node), mass),
        "bulk": np.full(count, MODULUS / 3.0),
        "shear": np.full(count, MODULUS / 2.0),
        "thickness": np.full(count, THICK),
        "friction": np.full(count, friction),
        "stiffness": np.ones(count),
        "safety": np.ones(1),
        "points": np.array([points]),
        "step": np.array([step]),
    }
    static = {f"contact_faces.{key}": array for key, array in static.items()}
    return PenaltyContact(static, particles, radius, spheres, on_surface)


def take(contact, node=NODES, active=None):
    contact.take({
        "contact_faces.position": node,
        "contact_faces.velocity": np.zeros_like(node),
        "contact_activity.active": np.ones(len(contact.corner)) if active is None else active,
    })  # fmt: skip


def points_at(place, velocity=None, mass=1.0):
    place = np.array(place, float)
    count = len(place)
    velocity = np.zeros_like(place) if velocity is None else velocity
    area, modulus = np.full(count, 1.0), np.full(count, MODULUS)
    masses, radius = np.full(count, mass), np.full(count, RADIUS)
    return Points(
        place,
        velocity,
        np.arange(count),
        masses,
        area,
        modulus,
        np.zeros(0),
        radius,
        np.zeros((0, 3)),
        np.zeros(0),
        np.zeros(0, np.int64),
    )


def spheres_at(place, velocity=None, mass=1.0):
    points = points_at(place, velocity, mass)
    count = len(points.place)
    return points._replace(
        tangential=np.full(count, MODULUS / 4.0),
        spin=np.zeros((count, 3)),
        inverse_moment=np.full(count, 2.5 / (mass * RADIUS**2)),
    )
