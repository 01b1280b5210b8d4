"""What bodies state before they are built: shapes, sizes, masses, and their poses at the start."""

import numpy as np

from quintet.components.dem_bodies import build
from quintet.components.dem_bodies.params import DemBodiesParams
from quintet.components.dem_bodies.shapes import planar
from quintet.components.dem_bodies.shapes.rigid_body import RigidBody
from quintet.interfaces.component import Array
from quintet.interfaces.ports import BOX, DISC, OTHER, POLYGON, SPHERE

SHAPES = {
    "sphere": SPHERE, "box": BOX, "spheres": OTHER, "mesh": OTHER,
    "disc": DISC, "polygon": POLYGON,
}  # fmt: skip
MOST = 100_000  # bodies; of more, nothing is told before they are built


def initial(params: DemBodiesParams) -> dict[str, Array]:
    """Fields of the port `motion` at the start, static ones first; none of very many bodies."""
    if len(params.bodies) > MOST:
        return {}
    bodies, solids = list(params.placed), build.solids(params)
    turns = np.array([body.orientation for body in bodies])
    return described(params, bodies, solids) | {
        "motion.position": np.array([body.position for body in bodies]),
        "motion.orientation": turns / np.linalg.norm(turns, axis=1, keepdims=True),
        "motion.velocity": np.array([body.velocity for body in bodies]),
        "motion.angular_velocity": np.array([body.angular_velocity for body in bodies]),
    }


def described(
    params: DemBodiesParams, bodies: list[RigidBody], solids: list[build.Solid]
) -> dict[str, Array]:
    """Shapes, sizes, masses, corners; unions of spheres have the box around them."""
    stated: dict[str, Array] = {
        "motion.shape": np.array([float(SHAPES[body.shape]) for body in bodies]),
        "motion.size": np.array([one.size for one in solids]),
        "motion.mass": np.array([one.mass for one in solids]),
    }
    if params.dimensions == 2:
        stated |= planar.describe(bodies)
    return stated
