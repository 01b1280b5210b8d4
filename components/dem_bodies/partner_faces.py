"""Contact of spheres with the faces of a partner's mesh."""

import math

import numpy as np

from quintet.components.dem_bodies.contact.materials import DURATION, SPEED_UP
from quintet.components.dem_bodies.params import DemBodiesParams, Material
from quintet.components.dem_bodies.state import OMEGA, VELOCITY, Model, State
from quintet.components.shared.contact.kernels import Points
from quintet.components.shared.contact.penalty import PenaltyContact
from quintet.interfaces.component import Array, Fields

NO_AREA = np.zeros(0)  # m2, which only penalty forces need
NONE_FIXED = np.zeros(0, np.int64)  # spheres that touch faces are free


class PartnerFaces:
    """Faces that spheres touch by Hertz's and Mindlin's forces."""

    def __init__(
        self, static: Fields, params: DemBodiesParams, model: Model, state: State, mass: Array
    ) -> None:
        rows, count = state.row[: len(mass)], len(mass)
        self.mass, self.radius = mass, model.sphere_radius[rows].copy()
        self.inverse_moment = model.inverse_moment[rows].copy()
        of_materials = np.array([moduli(material) for material in params.materials.values()])
        self.modulus, self.tangential = of_materials[model.material[rows]].T.copy()
        self.count = count
        # With fixed_step, impacts need not be resolved: the scene looks for the limit of stability,
        # which `penalty.stable_step` still keeps to.
        self.steps = params.steps_per_contact if params.fixed_step is None else 0
        self.penalty = PenaltyContact(static, count, self.radius, spheres=True)
        self.penalty.start(state.motion[rows, VELOCITY : VELOCITY + 3])

    def stable_step(self) -> float:
        """Stable step [s], and a part of the duration of the fastest impact that is near."""
        stable, impact = self.penalty.stable_step(math.inf), self.penalty.numbers.impact
        if not impact or not self.steps:
            return stable
        return min(stable, DURATION * SPEED_UP / math.sqrt(impact) / self.steps)

    def kick(self, state: State, dt: float) -> None:
        """Change velocities by contact in a step of dt [s], with its forces at the begin."""
        rows = state.row[: self.count]
        moving = state.motion[rows]
        velocity = np.ascontiguousarray(moving[:, VELOCITY : VELOCITY + 3])
        spin = np.ascontiguousarray(moving[:, OMEGA : OMEGA + 3])
        points = Points(
            np.ascontiguousarray(moving[:, :3]), velocity, np.arange(self.count), self.mass,
            NO_AREA, self.modulus, self.tangential, self.radius, spin, self.inverse_moment,
            NONE_FIXED,
        )  # fmt: skip
        self.penalty.kick(points, dt)
        state.motion[rows, VELOCITY : VELOCITY + 3] = velocity
        state.motion[rows, OMEGA : OMEGA + 3] = spin


def moduli(material: Material) -> tuple[float, float]:
    """E/(1 - ν²) and G/(2 - ν) [Pa] of Hertz's and Mindlin's contacts."""
    e, v = material.youngs_modulus, material.poissons_ratio
    return e / (1.0 - v * v), e / (2.0 * (1.0 + v) * (2.0 - v))
