"""Friction and heat at the walls of bodies."""

import numpy as np

from quintet.components.meshless_gas.clouds.cloud import Cloud
from quintet.interfaces.component import Array


class BodyFriction:
    """Friction and heat at the walls of bodies; none of a gas without viscosity."""

    def __init__(self, count: int) -> None:
        self.friction = np.zeros((count, 3))  # Pa, on all walls
        self.heat = np.zeros(count)  # W/m2, into all walls

    def write_walls(self, velocity: Array, primitive: Array) -> None:
        """Leave the states of slip walls."""

    def add_loads(
        self, cloud: Cloud, velocity: Array, spin: Array, primitive: Array, loads: Array
    ) -> None:
        """Add nothing to the loads (b, 8) on bodies."""


class SlipBodies(BodyFriction):
    """Bodies along whose walls the gas slips."""
