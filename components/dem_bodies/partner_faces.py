"""Contact of spheres with the faces of a partner's mesh."""

import numpy as np

from quintet.components.dem_bodies.params import DemBodiesParams, Material
from quintet.components.dem_bodies.state import OMEGA, VELOCITY, Model, State
from quintet.components.shared.contact.kernels import Points
from quintet.components.shared.contact.penalty import PenaltyContact
from quintet.interfaces.component import Array, Fields, Resources
from quintet.interfaces.errors import SceneError

NONE_FIXED = np.zeros(0, np.int64)  # spheres that touch faces are free


class PartnerFaces:
    """Faces that spheres touch; each sphere has the contact area R² and the thickness 2 R."""

    def __init__(
        self, static: Fields, params: DemBodiesParams, model: Model, state: State, mass: Array
    ) -> None:
        rows, count = state.row[: len(mass)], len(mass)
        self.mass, self.radius = mass, model.sphere_radius[rows].copy()
        self.inverse_moment = model.inverse_moment[rows].copy()
        moduli = np.array([modulus(material) for material in params.materials.values()])
        self.modulus, self.count = moduli[model.material[rows]], count
        self.penalty = PenaltyContact(static, count, float(self.radius.max()))
        self.penalty.start(state.motion[rows, VELOCITY : VELOCITY + 3])

    def kick(self, state: State, dt: float) -> None:
        """Change velocities by contact in a step of dt [s], with its forces at the begin."""
        rows = state.row[: self.count]
        moving = state.motion[rows]
        velocity = np.ascontiguousarray(moving[:, VELOCITY : VELOCITY + 3])
        spin = np.ascontiguousarray(moving[:, OMEGA : OMEGA + 3])
        points = Points(
            np.ascontiguousarray(moving[:, :3]), velocity, np.arange(self.count), self.mass,
            self.radius**2, self.modulus, self.radius, spin, self.inverse_moment,
            NONE_FIXED,
        )  # fmt: skip
        self.penalty.kick(points, dt)
        state.motion[rows, VELOCITY : VELOCITY + 3] = velocity
        state.motion[rows, OMEGA : OMEGA + 3] = spin


def modulus(material: Material) -> float:
    """Modulus [Pa] of plane contact, E/(1 - ν²)."""
    return material.youngs_modulus / (1.0 - material.poissons_ratio**2)


def require_one_rank(resources: Resources) -> None:
    """Raise SceneError where bodies are shared among ranks."""
    communicator = resources.communicator
    if communicator is not None and communicator.size > 1:
        raise SceneError(
            f"contact_with_faces must be false of bodies on {communicator.size} ranks; it is true. "
            "Take one rank and several threads."
        )
