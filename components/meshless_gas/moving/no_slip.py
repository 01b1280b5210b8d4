"""Bodies with no-slip walls; left out of scenes without friction."""

import numpy as np

from quintet.components.meshless_gas.clouds.cloud import Cloud
from quintet.components.meshless_gas.laws.transport import Transport, sutherland
from quintet.components.meshless_gas.moving.friction import BodyFriction
from quintet.components.meshless_gas.moving.kernels.held_walls import write_held_walls
from quintet.components.meshless_gas.moving.kernels.walls import FORCE, HEAT, POWER, TORQUE
from quintet.components.meshless_gas.moving.layout import CloudLayout
from quintet.components.meshless_gas.moving_bodies import Moving
from quintet.components.meshless_gas.viscous.kernels.walls import write_tractions
from quintet.interfaces.component import Array


class NoSlipBodies(BodyFriction):
    """Bodies of which some have no-slip walls."""

    def __init__(self, params: Moving, layout: CloudLayout, law: Transport) -> None:
        super().__init__(len(layout.walls))
        warmth = np.array([body.temperature or 0.0 for body in params.bodies])[layout.body]
        insulating = np.array([body.is_adiabatic for body in params.bodies])[layout.body]
        self.held = np.flatnonzero((warmth > 0.0) | insulating)
        self.law, self.layout = law, layout
        # Temperatures of no-slip walls; negative where a wall is adiabatic.
        self.temperature = np.where(insulating, -1.0, warmth)[self.held]  # K
        self.insulating = np.flatnonzero(self.temperature < 0.0)
        self.rows = layout.walls[self.held].astype(np.int32)
        self.above = layout.above[self.held].astype(np.int32)
        # Of nodes of bodies' clouds, from the body's centre: slopes at walls are then the same to
        # the bit wherever the body is.
        self.offsets = np.zeros((len(layout.height), 3))  # m
        self.offsets[layout.carried] = layout.offsets

    def write_walls(self, velocity: Array, primitive: Array) -> None:
        """Write the states of no-slip walls: their velocity and temperature, at their pressure."""
        write_held_walls(
            self.rows, self.above, self.layout.heights[self.held], velocity[self.held],
            self.temperature, self.law.gas_constant, primitive,
        )  # fmt: skip

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
            viscosity = [sutherland.py_func(kelvin, self.law) for kelvin in self._warmth(primitive)]
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

    def _warmth(self, primitive: Array) -> Array:
        """Temperatures [K] of the walls; those of adiabatic walls are the gas's."""
        warmth, rows = self.temperature.copy(), self.rows[self.insulating]
        warmth[self.insulating] = primitive[rows, 4] / (primitive[rows, 0] * self.law.gas_constant)
        return warmth
