"""Contact of particles with the faces of a partner's mesh."""

import numpy as np

from quintet.components.shared.contact.kernels import Points
from quintet.components.shared.contact.moduli import longitudinal_modulus
from quintet.components.shared.contact.penalty import PenaltyContact
from quintet.components.shared.materials.solid import Solid
from quintet.components.sph_solid.materials import Materials
from quintet.components.sph_solid.state import State
from quintet.interfaces.component import Fields

NONE = np.zeros(0)  # of what only spheres have
NO_SPIN = np.zeros((0, 3)), NONE  # rad/s, and 1/(kg m2)
NONE_FIXED = np.zeros(0, np.int64)


class PartnerFaces:
    """Faces that particles touch at half a spacing."""

    def __init__(self, static: Fields, state: State, laws: list[Solid], spacing: float) -> None:
        self.penalty = PenaltyContact(static, state.particles, 0.5 * spacing)
        self.penalty.start(state.velocity)
        self.radius = np.full(state.particles, 0.5 * spacing)
        bulk, shear = [law.bulk for law in laws], [law.shear for law in laws]
        self.modulus = longitudinal_modulus(bulk, shear)

    def make(self, state: State, materials: Materials) -> None:
        """Take masses, areas and moduli of particles, after their order has changed."""
        self.penalty.forget_rows()
        self.mass = materials.mass(state)
        self.area = state.volume / (2.0 * self.penalty.radius)
        self.moduli = self.modulus[state.material]
        self.fixed = state.fixed if state.fixed.any() else NONE_FIXED

    def kick(self, state: State, dt: float) -> None:
        """Change velocities by contact in a step of dt [s], with its forces at the begin."""
        points = Points(
            state.position, state.velocity, state.identity, self.mass, self.area, self.moduli,
            NONE, self.radius, *NO_SPIN, self.fixed,
        )  # fmt: skip
        self.penalty.kick(points, dt)
