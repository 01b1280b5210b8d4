"""Fields that bodies state before they are built: masses, and their poses at the start."""

import numpy as np

from quintet.components.dem_bodies.params import DemBodiesParams
from quintet.components.dem_bodies.shapes.copies import Bodies
from quintet.components.dem_bodies.shapes.solid import Solid, solids
from quintet.interfaces.component import Array

MOST = 100_000  # bodies; for more, no field is stated before they are built


def initial(params: DemBodiesParams) -> dict[str, Array]:
    """Fields of the port `motion` at the start, static ones first; empty for very many bodies."""
    if len(params.bodies) > MOST:
        return {}
    bodies = params.placed
    turns = bodies.of_each("orientation")
    return described(params, masses(bodies, solids(bodies))) | {
        "motion.position": bodies.positions(),
        "motion.orientation": turns / np.linalg.norm(turns, axis=1, keepdims=True),
        "motion.velocity": bodies.of_each("velocity"),
        "motion.angular_velocity": bodies.of_each("angular_velocity"),
    }


def masses(bodies: Bodies, solids: list[Solid]) -> Array:
    """Mass (m,) [kg] of each body; `solids` are those of the kinds."""
    return np.array([solid.mass for solid in solids])[bodies.kind_of_each()]


def described(params: DemBodiesParams, mass: Array) -> dict[str, Array]:
    """Masses (m,) [kg]; and the number of dimensions where it is two."""
    stated = {"motion.mass": mass.copy()}
    if params.dimensions == 2:
        stated["motion.dimensions"] = np.array([2.0])
    return stated
