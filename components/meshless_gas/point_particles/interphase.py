"""Forces and heat between the gas and particles that its nodes do not resolve."""

import math

import numpy as np
from numpy.typing import NDArray

from quintet.components.meshless_gas.clouds.cloud import Cloud
from quintet.components.meshless_gas.laws.transport import Transport
from quintet.components.meshless_gas.particle_coupling import PointParticles
from quintet.components.meshless_gas.point_particles.kernels import (
    exchange,
    fastest,
    write_weights,
)
from quintet.components.meshless_gas.point_particles.laws import DRAG, HEAT
from quintet.components.meshless_gas.point_particles.particles import Laws, Loads, Particles
from quintet.components.shared.search.nearest import build, search
from quintet.interfaces.component import Array

NODES = {2: 16, 3: 32}  # by dimensions
SHARE = 0.5  # of the time in which particle and gas relax towards each other, that is a step


class InterphaseExchange:
    """What point particles and nodes give each other in a step.

    Parameters
    ----------
    keys : PointParticles
    cloud : Cloud
    planar : bool
        Whether nodes lie in the plane of x and z, where y of particles does not count.
    transport : Transport
    gamma, prandtl : float, 1
    """

    def __init__(
        self,
        keys: PointParticles,
        cloud: Cloud,
        planar: bool,
        transport: Transport,
        gamma: float,
        prandtl: float,
    ) -> None:
        self.laws = Laws(DRAG[keys.drag], HEAT[keys.heat], transport, gamma, prandtl)
        self.capacity = transport.gas_constant / (gamma - 1.0)  # J/(kg K)
        self.count = keys.nodes or NODES[2 if planar else 3]
        self.reaction, self.planar, self.images = keys.reaction, planar, cloud
        of = np.concatenate([np.arange(cloud.nodes), cloud.owner])
        self.volumes, self.spacing = cloud.volumes[of], cloud.spacing[of]
        self.summed = np.zeros((len(of), 2))
        self.look_among(np.arange(len(of)))
        self.resize(0)

    def look_among(self, among: NDArray[np.int64]) -> None:
        """Take these nodes (m,) for those that there are, others being covered by bodies."""
        count = len(among)
        self.tree = among.astype(np.int64), np.zeros(count, np.int8), np.zeros(count)
        self.count = min(self.count, count)
        build(self.images.positions, *self.tree)

    def resize(self, count: int) -> None:
        """Make room for so many particles."""
        self.particles, self.loads = Particles.empty(count), Loads.empty(count)
        self.near = np.zeros((count, self.count), np.int64)
        self.weights, self.squares = (np.zeros((count, self.count)) for _ in range(2))

    def place(self, particles: Particles) -> None:
        """Begin a step: find the nodes around each particle, and their weights."""
        if len(particles.mass) != len(self.near):
            self.resize(len(particles.mass))
        self.particles = particles
        target, positions = particles.position, self.images.positions
        if self.planar:
            target = target * np.array([1.0, 0.0, 1.0])
        search(0, len(target), positions, *self.tree, target, self.near, self.squares)
        write_weights(self.squares, self.near, self.volumes, self.spacing, self.weights)
        self.loads.begin(particles)

    def add(
        self, primitive: Array, residual: Array | None, dt: float, stage: tuple[float, float, float]
    ) -> None:
        """Add the loads of a stage of a step [s]; take them from the residual.

        The velocities and temperatures of the particles are foreseen by the stages of the gas.
        """
        exchange(
            self.laws, dt, *stage, self.particles, self.near, self.weights, primitive,
            self.volumes, self.images.owner, self.images.turn, self.loads,
            residual if self.reaction else None,
        )  # fmt: skip

    def stable_dt(self, primitive: Array) -> float:
        """Step [s] that the stiffness of drag and heat allows, by the loads of the last stage."""
        if not len(self.near):
            return math.inf
        rate = fastest(
            self.loads.rates, self.particles, self.near, self.weights, primitive, self.volumes,
            self.images.owner, self.summed, self.capacity,
        )  # fmt: skip
        return SHARE / rate if rate > 0.0 else math.inf
