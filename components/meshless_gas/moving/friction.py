"""Walls of bodies that hold the gas, and what symmetry about an axis adds to its stresses.

Imported only where the gas has friction.
"""

import numpy as np

from quintet.components.meshless_gas.clouds.cloud import Cloud
from quintet.components.meshless_gas.laws.transport import Transport, sutherland
from quintet.components.meshless_gas.moving.kernels.axis import add_axis_stresses, write_swelling
from quintet.components.meshless_gas.moving.layout import CloudLayout
from quintet.components.meshless_gas.moving.params import Moving
from quintet.components.meshless_gas.stencils import Stencils
from quintet.components.meshless_gas.viscous.kernels.walls import write_tractions
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array

LEAST = 0.3  # of the nearer node's temperature: what an adiabatic wall must keep


class Friction:
    """Friction and heat at the walls of bodies that hold the gas."""

    def __init__(self, params: Moving, layout: CloudLayout, law: Transport) -> None:
        warmth = np.array([one.temperature or 0.0 for one in params.bodies])[layout.body]
        insulating = np.array([one.is_adiabatic for one in params.bodies])[layout.body]
        self.held = np.flatnonzero((warmth > 0.0) | insulating)
        self.law, self.layout, self.temperature = law, layout, warmth[self.held]
        self.insulating = np.flatnonzero(insulating[self.held])  # of those that are held
        self.rows = layout.walls[self.held].astype(np.int32)
        self.above = layout.above[self.held].astype(np.int32)
        self.friction = np.zeros((len(layout.walls), 3))  # Pa, on all walls
        self.heat = np.zeros(len(layout.walls))  # W/m2, into all walls

    def hold(self, velocity: Array, primitive: Array) -> None:
        """Give walls their velocity and temperature, at the pressure that they have."""
        rows = self.rows
        if len(self.insulating):
            self._level(primitive)
        primitive[rows, 0] = primitive[rows, 4] / (self.law.gas_constant * self.temperature)
        primitive[rows, 1:4] = velocity[self.held]

    def _level(self, primitive: Array) -> None:
        """Give adiabatic walls the temperature of the parabola that is level there."""
        near, far = primitive[self.above[self.insulating]].transpose(1, 0, 2)
        first, second = (one[:, 4] / (one[:, 0] * self.law.gas_constant) for one in (near, far))
        low, high = self.layout.heights[self.held[self.insulating]].T ** 2
        level = (first * high - second * low) / (high - low)
        # Where a shock lies between the two, that of the nearer.
        self.temperature[self.insulating] = np.where(level > LEAST * first, level, first)

    def load(
        self, cloud: Cloud, velocity: Array, spin: Array, primitive: Array, loads: Array
    ) -> None:
        """Add friction and heat to what bodies are loaded with: (b, 8) N, N m, W, W.

        Gas that turns with its wall is not sheared: of the slope of the velocity along the normal
        n, ω × n is rotation.
        """
        own, held = self.layout, self.held
        friction, heat = np.empty((len(held), 3)), np.empty(len(held))
        write_tractions(
            self.rows, self.above, cloud.positions, cloud.normals, velocity[held], primitive,
            self.law, friction, heat,
        )  # fmt: skip
        if spin.any():
            turning = np.cross(spin[own.body[held]], cloud.normals[self.rows])  # 1/s
            viscosity = [sutherland.py_func(one, self.law) for one in self.temperature]
            friction -= np.array(viscosity)[:, None] * turning
        heat[self.insulating] = 0.0
        self.friction[held], self.heat[held] = friction, heat
        size = np.sqrt((cloud.areas[own.walls] ** 2).sum(axis=1))
        force = size[:, None] * self.friction
        torque, work = np.cross(own.arms, force), (force * velocity).sum(axis=1)
        for b in range(len(loads)):
            one = own.body == b
            loads[b, :3] += force[one].sum(axis=0)
            loads[b, 3:6] += torque[one].sum(axis=0)
            loads[b, 6] -= work[one].sum()
            loads[b, 7] += (size * self.heat)[one].sum()


class AxisStresses:
    """Stresses about an axis, added stage by stage."""

    def __init__(self, nodes: int, conduction: float) -> None:
        self.swelling, self.conduction = np.zeros(nodes), conduction

    def add(
        self, team: Team, rows: Array, positions: Array, primitive: Array, stencils: Stencils,
        flow: tuple[Array, Array, Array], residual: Array,
    ) -> None:  # fmt: skip
        """Add rates by viscosity, of (transported, gradients, temperature gradients)."""
        transported, gradients, slopes = flow
        write_swelling(0, len(positions), positions, primitive, transported, self.swelling)
        team.run(
            add_axis_stresses, len(rows), rows, positions, primitive, transported, self.swelling,
            *stencils, gradients, slopes, self.conduction, residual,
        )  # fmt: skip
