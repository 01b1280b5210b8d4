"""Walls of bodies that hold the gas, and what symmetry about an axis adds to its stresses.

Imported only where the gas has friction.
"""

from typing import Any

import numpy as np
from numba import njit

from quintet.components.meshless_gas.clouds.cloud import Cloud
from quintet.components.meshless_gas.moving.layout import CloudLayout
from quintet.components.meshless_gas.moving.params import Moving
from quintet.components.meshless_gas.stencils import Stencils
from quintet.components.meshless_gas.transport import Transport
from quintet.components.meshless_gas.viscous.walls import write_tractions
from quintet.components.shared.numba_options import FAST
from quintet.components.shared.threads import Team
from quintet.interfaces.component import Array


class Friction:
    """Friction and heat at the walls of bodies that have a temperature."""

    def __init__(self, params: Moving, layout: CloudLayout, law: Transport) -> None:
        warmth = np.array([one.temperature or 0.0 for one in params.bodies])[layout.body]
        self.held = np.flatnonzero(warmth > 0.0)
        self.law, self.layout, self.temperature = law, layout, warmth[self.held]
        self.rows = layout.walls[self.held].astype(np.int32)
        self.above = layout.above[self.held].astype(np.int32)
        self.friction = np.zeros((len(layout.walls), 3))  # Pa, on all walls
        self.heat = np.zeros(len(layout.walls))  # W/m2, into all walls

    def hold(self, velocity: Array, primitive: Array) -> None:
        """Give walls their velocity and temperature, at the pressure that they have."""
        rows = self.rows
        primitive[rows, 0] = primitive[rows, 4] / (self.law.gas_constant * self.temperature)
        primitive[rows, 1:4] = velocity[self.held]

    def load(self, cloud: Cloud, velocity: Array, primitive: Array, loads: Array) -> None:
        """Add friction and heat to what bodies are loaded with: (b, 8) N, N m, W, W."""
        own, held = self.layout, self.held
        friction, heat = np.empty((len(held), 3)), np.empty(len(held))
        write_tractions(
            self.rows, self.above, cloud.positions, cloud.normals, velocity[held], primitive,
            self.law, friction, heat,
        )  # fmt: skip
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


@njit(**FAST)
def write_swelling(first: int, last: int, positions: Any, primitive: Any, transported: Any,
                   swelling: Any) -> None:  # fmt: skip
    """Write -2/3 μ w/r (n,) Pa: what circles that grow add to the normal stresses."""
    for i in range(first, last):
        swelling[i] = -2.0 / 3.0 * transported[i, 1] * primitive[i, 3] / positions[i, 2]


@njit(**FAST)
def add_axis_stresses(
    first: int,
    last: int,
    rows: Any,
    positions: Any,
    primitive: Any,
    transported: Any,
    swelling: Any,
    neighbours: Any,
    coefficients: Any,
    gradients: Any,
    temperature_gradients: Any,
    conduction: float,
    residual: Any,
) -> None:
    """Add to momentum and energy what stresses about an axis have more than those of a plane.

    With s = -2/3 μ w/r: (∂s/∂x + τ_xr/r, ∂s/∂r + 2μ(∂w/∂r - w/r)/r,
    ∇·(s v) + (u τ_xr + w τ_rr + λ ∂T/∂r)/r).
    """
    for row in range(first, last):
        i = np.uintp(rows[row])
        u, w, r = primitive[i, 1], primitive[i, 3], positions[i, 2]
        mu, s = transported[i, 1], swelling[i]
        along = across = power = 0.0
        for k in range(neighbours.shape[1]):
            j = np.uintp(neighbours[i, k])
            x, z = coefficients[i, k, 0], coefficients[i, k, 2]
            along += x * (swelling[j] - s)
            across += z * (swelling[j] - s)
            power += x * (swelling[j] * primitive[j, 1] - s * u)
            power += z * (swelling[j] * primitive[j, 3] - s * w)
        g = gradients[i]
        shear = mu * (g[1, 2] + g[3, 0])
        normal = mu * (2.0 * g[3, 2] - 2.0 / 3.0 * (g[1, 0] + g[3, 2])) + s
        residual[i, 1] += along + shear / r
        residual[i, 3] += across + 2.0 * mu * (g[3, 2] - w / r) / r
        heat = conduction * mu * temperature_gradients[i, 2]
        residual[i, 4] += power + (u * shear + w * normal + heat) / r


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
