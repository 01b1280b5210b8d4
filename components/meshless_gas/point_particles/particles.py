"""Arrays of point particles: what the partner tells of them, and what the gas does to them."""

from typing import NamedTuple

import numpy as np

from quintet.components.meshless_gas.laws.transport import Transport
from quintet.interfaces.component import Array


class Laws(NamedTuple):
    """How a particle is dragged and heated."""

    drag: int  # one of `laws.DRAG`
    heat: int  # one of `laws.HEAT`
    transport: Transport
    gamma: float  # 1
    prandtl: float  # 1


class Particles(NamedTuple):
    """Spheres as the partner tells them; each is told as all those that it stands for."""

    position: Array  # (p, 3) m
    velocity: Array  # (p, 3) m/s
    acceleration: Array  # (p, 3) m/s2, by all but the gas
    temperature: Array  # (p,) K
    diameter: Array  # (p,) m, of one
    launched: Array  # (p,) 1; 0 of those that are not there yet
    mass: Array  # (p,) kg
    heat_capacity: Array  # (p,) J/K
    number: Array  # (p,) 1

    @classmethod
    def empty(cls, count: int) -> "Particles":
        """So many, of which nothing is known."""
        vectors = [np.zeros((count, 3)) for _ in range(3)]
        scalars = [np.ones(count) for _ in range(6)]
        return cls(*vectors, *scalars)


class Loads(NamedTuple):
    """What the gas does to particles in a step: means over its stages."""

    force: Array  # (p, 3) N
    heat: Array  # (p,) W
    power: Array  # (p,) W, that the gas gives: the work of the force, and the heat
    rates: Array  # (p, 2) kg/s and W/K: force over velocity, heat over difference of temperature
    velocity: Array  # (p, 3) m/s, foreseen for the coming stage
    temperature: Array  # (p,) K, foreseen

    @classmethod
    def empty(cls, count: int) -> "Loads":
        """None, on so many."""
        scalar, vector = (count,), (count, 3)
        shapes = (vector, scalar, scalar, (count, 2), vector, scalar)
        return cls(*[np.zeros(shape) for shape in shapes])

    def begin(self, particles: Particles) -> None:
        """Forget the last step."""
        for sums in (self.force, self.heat, self.power):
            sums[:] = 0.0
        self.velocity[:], self.temperature[:] = particles.velocity, particles.temperature
