"""A bar of finite elements for the toy chains to be glued to, and chains that can be freed."""

import numpy as np
from toy_chains import Rods, chain_totals, hump

from quintet.components.fe_plate.component import FePlate
from quintet.components.fe_plate.params import FePlateParams
from quintet.interfaces.component import ONE_THREAD, Fields, Keys, Resources, Totals
from quintet.interfaces.params import Number, parameters
from quintet.interfaces.ports import GLUE_ACTIVITY, GLUED


class Bar(FePlate):
    """A bar along x that starts with a hump of the velocity along it."""

    @parameters
    class Params(FePlateParams):
        """The hump."""

        height: Number = 0.0  # m/s

    def __init__(self, params: Params, resources: Resources = ONE_THREAD) -> None:
        super().__init__(params, resources)
        place = np.rint(self.mesh.node[:, 0]).astype(int)
        push = hump(place.max() + 1, params.height)[place]
        self.state.velocity[:, 0] += push
        self.state.mean_velocity[:, 0] += push


class LooseRods(Rods):
    """Rods that move freely where the face that they are glued to has eroded.

    In their first free step no force acts on their ends: the nodes have got it.
    """

    takes = (GLUED, GLUE_ACTIVITY)

    def __init__(self, params: Rods.Params) -> None:
        super().__init__(params)
        self.held = np.ones(len(params.places))  # by faces that are there
        self.gave = self.held  # their force to nodes, in the last step

    def take(self, fields: Fields) -> None:
        self.held = np.array(fields.get("glue_activity.active", self.held))
        if "glued.velocity" in fields:
            self.pulled = np.array(fields["glued.velocity"][:, 0]) * self.held

    def step(self, dt: float) -> None:
        acceleration = self.params.stiffness * (self.u[:, 1] - self.u[:, 0]) / self.mass[:, 0]
        free = self.v[:, 0] + dt * acceleration * (self.gave == 0.0)
        glued_velocity = self.pulled
        self.pulled = np.where(self.held > 0.0, glued_velocity, free)
        super().step(dt)
        self.pulled, self.gave = glued_velocity, self.held

    def give(self, wanted: Keys) -> Fields:
        return {key: self.held[:, None] * force for key, force in super().give(wanted).items()}

    def save(self) -> Fields:
        return {**super().save(), "held": self.held.copy(), "gave": self.gave.copy()}

    def load(self, state: Fields) -> None:
        super().load(state)
        self.held, self.gave = np.array(state["held"]), np.array(state["gave"])

    def totals(self) -> Totals:
        """Totals without the glued masses, which the bar carries."""
        mass = self.mass.copy()
        mass[:, 0] *= 1.0 - self.held
        return chain_totals(mass, self.u, self.v, self.params.stiffness)
