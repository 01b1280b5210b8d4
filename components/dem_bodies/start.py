"""What bodies state before they are built: masses, and their poses at the start."""

import numpy as np

from quintet.components.dem_bodies import build
from quintet.components.dem_bodies.params import DemBodiesParams
from quintet.interfaces.component import Array

MOST = 100_000  # bodies; of more, nothing is told before they are built


def initial(params: DemBodiesParams) -> dict[str, Array]:
    """Fields of the port `motion` at the start, static ones first; none of very many bodies."""
    if len(params.bodies) > MOST:
        return {}
    bodies, solids = list(params.placed), build.solids(params)
    turns = np.array([body.orientation for body in bodies])
    return described(params, solids) | {
        "motion.position": np.array([body.position for body in bodies]),
        "motion.orientation": turns / np.linalg.norm(turns, axis=1, keepdims=True),
        "motion.velocity": np.array([body.velocity for body in bodies]),
        "motion.angular_velocity": np.array([body.angular_velocity for body in bodies]),
    }


def described(params: DemBodiesParams, solids: list[build.Solid]) -> dict[str, Array]:
    """Masses; in two dimensions that it has two."""
    stated = {"motion.mass": np.array([one.mass for one in solids])}
    if params.dimensions == 2:
        stated["motion.dimensions"] = np.array([2.0])
    return stated
