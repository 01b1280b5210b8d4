"""A mass on a spring by explicit leap-frog: of second order, and stable up to a step of 2/ω."""

import numpy as np

from quintet.interfaces.component import Component, Port, Totals
from quintet.interfaces.params import NotNegative, Positive, parameters
from quintet.interfaces.ports import POSITION, VELOCITY


class Spring(Component):
    """Steps with exactly the given step."""

    @parameters
    class Params:
        step: Positive  # s
        mass: Positive = 1.0  # kg
        stiffness: Positive = 100.0  # N/m
        start: tuple[float, float, float] = (1.0, 0.0, 0.0)  # m
        damping: NotNegative = 0.0  # 1/s

    gives = (Port("motion", (POSITION, VELOCITY)),)

    def __init__(self, params):
        self.params = params
        self.position, self.velocity = np.array([params.start]), np.zeros((1, 3))

    def stable_dt(self):
        return self.params.step

    def take(self, fields):
        pass

    def step(self, dt):
        self.velocity = self.velocity + 0.5 * dt * self.pull()
        self.position = self.position + dt * self.velocity
        self.velocity = self.velocity + 0.5 * dt * self.pull()
        self.velocity = self.velocity * (1.0 - self.params.damping * dt)

    def pull(self):
        return -self.params.stiffness / self.params.mass * self.position

    def give(self, wanted):
        fields = {"position": self.position.copy(), "velocity": self.velocity.copy()}
        return {f"motion.{name}": field for name, field in fields.items()}

    def totals(self):
        mass, stiffness = self.params.mass, self.params.stiffness
        energy = 0.5 * mass * (self.velocity**2).sum(), 0.5 * stiffness * (self.position**2).sum()
        return Totals(mass=mass, kinetic=energy[0], internal=energy[1])

    def save(self):
        return {"position": self.position.copy(), "velocity": self.velocity.copy()}

    def load(self, state):
        self.position, self.velocity = np.array(state["position"]), np.array(state["velocity"])
