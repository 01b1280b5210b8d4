"""A mass on a spring whose foot may ride on something that moves."""

import numpy as np

from quintet.interfaces.component import Component, Fields, Keys, Port
from quintet.interfaces.params import Positive, Vector, parameters
from quintet.interfaces.ports import FORCE, POSITION, VELOCITY


class Mass(Component):
    """It takes a load and the motion of its foot; it gives its motion and its push on the foot."""

    takes = (Port("load", (FORCE,)), Port("foot", (POSITION, VELOCITY)))
    gives = (Port("motion", (POSITION, VELOCITY)), Port("foot_load", (FORCE,)))

    @parameters
    class Params:
        """What a scene says of it; it starts at rest."""

        mass: Positive  # kg
        stiffness: Positive  # N/m
        arm: Vector  # m, from the foot to where the spring is at ease
        start: Vector  # m

    def __init__(self, params: Params) -> None:
        self.mass, self.stiffness = params.mass, params.stiffness
        self.arm, self.position = np.array([params.arm]), np.array([params.start])  # (1, 3) m
        self.velocity = np.zeros((1, 3))  # m/s
        self.foot = np.zeros((1, 3))  # m, where it stands unless something carries it
        self.push, self.pull = np.zeros((1, 3)), np.zeros((1, 3))  # N

    def stable_dt(self) -> float:
        """Allow a tenth of the spring's limit, 2 sqrt(m / k)."""
        return 0.2 * float(np.sqrt(self.mass / self.stiffness))

    def take(self, fields: Fields) -> None:
        """Keep the load, and where the foot is in the middle of the step."""
        self.push = np.array(fields.get("load.force", self.push))
        self.foot = np.array(fields.get("foot.position", self.foot))

    def step(self, dt: float) -> None:
        """Drift half a step, kick, drift half a step."""
        self.position = self.position + 0.5 * dt * self.velocity
        self.pull = self.stiffness * (self.position - self.foot - self.arm)
        self.velocity = self.velocity + dt * (self.push - self.pull) / self.mass
        self.position = self.position + 0.5 * dt * self.velocity

    def give(self, wanted: Keys) -> Fields:
        """Copy out the motion as it is now, and the pull on the foot over the last step."""
        motion = {"motion.position": self.position, "motion.velocity": self.velocity}
        outputs = {**motion, "foot_load.force": self.pull}
        return {key: outputs[key].copy() for key in wanted}

    def save(self) -> Fields:
        """Copy out all that changes."""
        return {"state": np.array([self.position, self.velocity, self.foot, self.push, self.pull])}

    def load(self, state: Fields) -> None:
        """Come back to it."""
        self.position, self.velocity, self.foot, self.push, self.pull = np.array(state["state"])
