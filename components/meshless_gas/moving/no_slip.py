"""Bodies with no-slip walls; left out of scenes without friction."""

import numpy as np

from quintet.components.meshless_gas.clouds.cloud import Cloud
from quintet.components.meshless_gas.laws.transport import Transport, sutherland
from quintet.components.meshless_gas.moving.friction import BodyFriction
from quintet.components.meshless_gas.moving.kernels.walls import FORCE, HEAT, POWER, TORQUE
from quintet.components.meshless_gas.moving.layout import CloudLayout
from quintet.components.meshless_gas.moving_bodies import Moving
from quintet.components.meshless_gas.viscous.kernels.walls import write_tractions
from quintet.interfaces.component import Array

LEAST = 0.3  # of the nearer node's temperature: what an adiabatic wall must keep


class NoSlipBodies(BodyFriction):
    """Bodies of which some have no-slip walls."""

    def __init__(self, params: Moving, layout: CloudLayout, law: Transport) -> None:
        super().__init__(len(layout.walls))
        warmth = np.array([body.temperature or 0.0 for body in params.bodies])[layout.body]
        insulating = np.array([body.is_adiabatic for body in params.bodies])[layout.body]
        self.held = np.flatnonzero((warmth > 0.0) | insulating)
        self.law, self.layout, self.temperature = law, layout, warmth[self.held]
        self.insulating = np.flatnonzero(insulating[self.held])  # of those that are held
        self.rows = layout.walls[self.held].astype(np.int32)
        self.above = layout.above[self.held].astype(np.int32)
        # Of nodes of bodies' clouds, from the body's centre: slopes at walls are then the same to
        # the bit wherever the body is.
        self.offsets = np.zeros((len(layout.height), 3))  # m
        self.offsets[layout.carried] = layout.offsets

    def write_walls(self, velocity: Array, primitive: Array) -> None:
        """Write the states of no-slip walls: their velocity and temperature, at their pressure."""
        rows = self.rows
        if len(self.insulating):
            self._level(primitive)
        primitive[rows, 0] = primitive[rows, 4] / (self.law.gas_constant * self.temperature)
        primitive[rows, 1:4] = velocity[self.held]

    def _level(self, primitive: Array) -> None:
        """Give adiabatic walls the temperature of the parabola that is level there."""
        near, far = primitive[self.above[self.insulating]].transpose(1, 0, 2)
        first, second = (q[:, 4] / (q[:, 0] * self.law.gas_constant) for q in (near, far))
        low, high = self.layout.heights[self.held[self.insulating]].T ** 2
        level = (first * high - second * low) / (high - low)
        # Where a shock lies between the two, that of the nearer.
        self.temperature[self.insulating] = np.where(level > LEAST * first, level, first)

    def add_loads(
        self, cloud: Cloud, velocity: Array, spin: Array, primitive: Array, loads: Array
    ) -> None:
        """Add friction and heat to the loads (b, 8) on bodies.

        Gas that turns with its wall is not sheared: of the slope of the velocity along the normal
        n, ω × n is rotation.
        """
        layout, held = self.layout, self.held
        friction, heat = np.empty((len(held), 3)), np.empty(len(held))
        write_tractions(
            self.rows, self.above, self.offsets, cloud.normals, velocity[held], primitive,
            self.law, friction, heat,
        )  # fmt: skip
        if spin.any():
            turning = np.cross(spin[layout.body[held]], cloud.normals[self.rows])  # 1/s
            viscosity = [sutherland.py_func(kelvin, self.law) for kelvin in self.temperature]
            friction -= np.array(viscosity)[:, None] * turning
        heat[self.insulating] = 0.0
        self.friction[held], self.heat[held] = friction, heat
        size = np.sqrt((cloud.areas[layout.walls] ** 2).sum(axis=1))
        force = size[:, None] * self.friction
        torque, work = np.cross(layout.arms, force), (force * velocity).sum(axis=1)
        for b in range(len(loads)):
            mine = layout.body == b
            loads[b, FORCE] += force[mine].sum(axis=0)
            loads[b, TORQUE] += torque[mine].sum(axis=0)
            loads[b, POWER] -= work[mine].sum()
            loads[b, HEAT] += (size * self.heat)[mine].sum()
