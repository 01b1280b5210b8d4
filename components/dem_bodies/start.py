"""Fields that bodies state before they are built: masses, and their poses at the start."""

import numpy as np

from quintet.components.dem_bodies.params import DemBodiesParams
from quintet.components.dem_bodies.shapes.solid import Solid, solids
from quintet.interfaces.component import Array

MOST = 100_000  # bodies; for more, no field is stated before they are built


def initial(params: DemBodiesParams) -> dict[str, Array]:
    """Fields of the port `motion` at the start, static ones first; empty for very many bodies."""
    if len(params.bodies) > MOST:
        return {}
    bodies = list(params.placed)
    turns = np.array([body.orientation for body in bodies])
    return described(params, solids(params.placed)) | {
        "motion.position": np.array([body.position for body in bodies]),
        "motion.orientation": turns / np.linalg.norm(turns, axis=1, keepdims=True),
        "motion.velocity": np.array([body.velocity for body in bodies]),
        "motion.angular_velocity": np.array([body.angular_velocity for body in bodies]),
    }


def described(params: DemBodiesParams, solids: list[Solid]) -> dict[str, Array]:
    """Masses; and the number of dimensions where it is two."""
    stated = {"motion.mass": np.array([solid.mass for solid in solids])}
    if params.dimensions == 2:
        stated["motion.dimensions"] = np.array([2.0])
    return stated
