"""Toys: a creeping flow that drags, turns and heats spheres."""

from dataclasses import replace

import numpy as np

from quintet.interfaces.component import Component, Fields, Keys, Totals
from quintet.interfaces.params import Count, Positive, Vector, parameters
from quintet.interfaces.ports import HEAT, LOAD, MOTION, PARTICLES

SPHERES = replace(PARTICLES, name="spheres")


class Wind(Component):
    """A uniform wind: -3π μ d (v - u), -π μ d³ ω and 2π λ d (T_gas - T), of each in a parcel."""

    takes = (MOTION, SPHERES)
    gives = (LOAD, HEAT)

    @parameters
    class Params:
        """The wind, and how it answers."""

        count: Count = 1
        velocity: Vector = (0.0, 0.0, 0.0)  # m/s
        temperature: Positive = 400.0  # K
        viscosity: Positive = 1.8e-5  # Pa s
        conductivity: Positive = 0.025  # W/(m K)
        dt: Positive = 0.01  # s

    def __init__(self, params: Params) -> None:
        self.params = params
        self.force, self.torque = (np.zeros((params.count, 3)) for _ in range(2))
        self.heat, self.number = np.zeros(params.count), np.ones(params.count)
        self.momentum, self.heated = np.zeros(3), 0.0

    def bind(self, static: Fields, joined: Keys) -> None:
        self.number = static.get("spheres.number", self.number)

    def stable_dt(self) -> float:
        return self.params.dt

    def take(self, fields: Fields) -> None:
        params, factor = self.params, np.pi * self.number
        if "spheres.diameter" not in fields:
            return
        d = fields["spheres.diameter"]
        turning = fields["motion.angular_velocity"]
        relative = np.array(params.velocity) - fields["spheres.velocity"]
        self.force = 3.0 * params.viscosity * (factor * d)[:, None] * relative
        self.torque = -params.viscosity * (factor * d**3)[:, None] * turning
        self.heat = 2.0 * params.conductivity * factor * d
        self.heat = self.heat * (params.temperature - fields["spheres.temperature"])

    def step(self, dt: float) -> None:
        self.momentum = self.momentum - dt * self.force.sum(axis=0)
        self.heated -= dt * float(self.heat.sum())

    def give(self, wanted: Keys) -> Fields:
        outputs = {
            "load.force": self.force,
            "load.torque": self.torque,
            "heat.heat_flow": self.heat,
        }
        return {key: outputs[key].copy() for key in wanted}

    def save(self) -> Fields:
        loads = np.column_stack([self.force, self.torque, self.heat, self.number])
        return {"loads": loads, "lost": np.array([*self.momentum, self.heated])}

    def load(self, state: Fields) -> None:
        loads, lost = np.array(state["loads"]), np.array(state["lost"])
        self.force, self.torque = loads[:, :3].copy(), loads[:, 3:6].copy()
        self.heat, self.number = loads[:, 6].copy(), loads[:, 7].copy()
        self.momentum, self.heated = lost[:3].copy(), float(lost[3])

    def totals(self) -> Totals:
        return Totals(momentum=self.momentum.copy(), internal=self.heated)
