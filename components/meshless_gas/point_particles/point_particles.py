"""Point particles of a partner, and their exchange of momentum and heat with the gas."""

from collections.abc import Mapping

import numpy as np

from quintet.components.meshless_gas.build import Domain, reaches, transport_of
from quintet.components.meshless_gas.kernels.motion import STAGES
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.parts import Part, Reader, Stage
from quintet.components.meshless_gas.point_particles.half_plane import (
    azimuths_of,
    from_half_plane,
    to_half_plane,
)
from quintet.components.meshless_gas.point_particles.interphase import InterphaseExchange
from quintet.components.meshless_gas.point_particles.kernels import OUTSIDE
from quintet.components.meshless_gas.point_particles.particles import Particles
from quintet.components.meshless_gas.state import Fluxes
from quintet.interfaces.component import Array, Fields, Keys
from quintet.interfaces.errors import SceneError, StepError

RECEIVED = ("position", "velocity", "acceleration", "temperature", "diameter", "launched")
SUMS = ("force", "heat", "power", "rates")
STATIC = ("mass", "heat_capacity", "number")


def periods(params: MeshlessGasParams) -> list[tuple[int, float, float]]:
    """Axes along which the gas repeats: number, lowest place [m] and length [m]."""
    axes, box = [], params.box
    if box is None:
        return []
    for axis, name in enumerate("xyz"):
        if params.kind_of(f"{name}-") == "periodic" and not (params.planar and name == "y"):
            axes.append((axis, box.lowest[axis], box.highest[axis] - box.lowest[axis]))
    return axes


class CoupledParticles(Part):
    """Particles as last received from the partner, and their exchange with the nodes."""

    def __init__(self, params: MeshlessGasParams, domain: Domain) -> None:
        assert params.particles is not None
        gas, cloud = params.gas, domain.cloud
        if params.box is None:
            # Layers are thinner than they are wide: a particle has left the gas that is farther
            # from its nearest node than all neighbours of this are.
            behind = np.concatenate([np.arange(cloud.nodes), cloud.owner])
            reach = reaches(domain, domain.every)[behind]
            cloud = cloud._replace(spacing=reach / OUTSIDE)
        self.exchange = InterphaseExchange(
            params.particles, cloud, params.planar, transport_of(gas), gas.gamma, gas.prandtl
        )
        self.coarsest = float(cloud.spacing.max())  # m
        # What boundary nodes were given would be lost: their states follow from others.
        advanced = np.zeros(domain.cloud.nodes, bool)
        advanced[domain.inner] = True
        images = advanced[domain.cloud.owner]
        self.exchange.look_among(np.flatnonzero(np.concatenate([advanced, images])))
        self.periods = periods(params)
        sphere = params.sphere
        self.axis = np.array(sphere.centre) if sphere is not None and params.axisymmetric else None
        self._resize(0)

    def _resize(self, count: int) -> None:
        """Make room for particles, of which nothing is known."""
        self.exchange.resize(count)
        self.particles = self.exchange.particles
        self.azimuths = np.tile([1.0, 0.0], (count, 1))  # (p, 2) 1, cosines and sines

    def describe(self) -> Fields:
        """State the largest diameter of a point particle."""
        return {"particles.largest_diameter": np.array([self.coarsest])}

    def bind(self, static: Fields, joined: Keys) -> None:
        """Take the mass and heat capacity of parcels, and the number of particles in each."""
        if "particles.mass" not in static:
            return
        self._resize(len(static["particles.mass"]))
        fixed = {name: np.array(static[f"particles.{name}"], float) for name in STATIC}
        self.particles = self.particles._replace(**fixed)

    def prime(self, fields: Fields, primitive: Array) -> None:
        """Take their places at the start, and find how stiff the exchange is there."""
        self.take(fields)
        self._refuse_resolved()
        self._place()
        self.exchange.add(primitive, None, 0.0, STAGES[0])  # rates alone, without any exchange
        self._place()

    def _refuse_resolved(self) -> None:
        """Refuse particles that are larger than the spacing of nodes: they are no points."""
        largest = float(self.particles.diameter.max(initial=0.0))
        if largest > self.coarsest:
            raise SceneError(
                "particles: a point particle must be smaller than the spacing of nodes, "
                f"{self.coarsest:.4g} m where they are coarsest; found particle "
                f"{int(self.particles.diameter.argmax())} of {largest:.4g} m. Make nodes coarser, "
                "or let the particle be a body with nodes of its own, moving.bodies."
            )

    def take(self, fields: Fields) -> None:
        """Set their places, velocities and temperatures for the coming step."""
        received = {
            name: np.array(fields[f"particles.{name}"], float)
            for name in RECEIVED
            if f"particles.{name}" in fields
        }
        self.particles = self.particles._replace(**received)
        if received and not self.particles.temperature.min(initial=1.0) > 0.0:
            coldest = int(self.particles.temperature.argmin())
            raise StepError(
                f"particles must be warmer than 0 K; particle {coldest} has "
                f"{self.particles.temperature[coldest]:.4g} K. Shorten the window."
            )

    def begin(self, dt: float, primitive: Array, conservative: Array) -> None:
        """Find the nodes around the particles."""
        self._place()

    def _place(self) -> None:
        """Find the nodes around particles, or around their images among the nodes.

        These lie in a periodic box, or about an axis in the half-plane that has nodes.
        """
        particles, x = self.particles, self.particles.position.copy()
        for axis, low, length in self.periods:
            x[:, axis] = low + np.mod(x[:, axis] - low, length)
        if self.axis is not None:
            azimuths = self.azimuths = azimuths_of(x, self.axis)
            x = self.axis + to_half_plane(azimuths, x - self.axis)
            particles = particles._replace(
                velocity=to_half_plane(azimuths, particles.velocity),
                acceleration=to_half_plane(azimuths, particles.acceleration),
            )
        self.exchange.place(particles._replace(position=x))

    def add_rates(self, domain: Domain, work: Fluxes, dt: float, stage: Stage) -> None:
        """Exchange momentum and heat in a stage of a step [s]."""
        self.exchange.add(work.primitive, work.residual, dt, stage)

    def loss_rates(self) -> Array:
        """Mass, momentum and energy (5,) kg/s, N, W that the gas gave up in the last step."""
        if not self.exchange.reaction:
            return np.zeros(5)
        loads = self.exchange.loads
        return np.array([0.0, *loads.force.sum(axis=0), loads.power.sum()])

    def readers(self, primitive: Array) -> Mapping[str, Reader]:
        """Mean force [N] and heat [W] on each in the last step."""
        return {"particle_load": self._load, "particle_heat": self._heat}

    def _load(self) -> Fields:
        force = from_half_plane(self.azimuths, self.exchange.loads.force)
        return {"particle_load.force": force, "particle_load.torque": np.zeros_like(force)}

    def _heat(self) -> Fields:
        return {"particle_heat.heat_flow": self.exchange.loads.heat.copy()}

    def stable_dt(self, primitive: Array) -> float:
        """Step [s] that their stiffness allows."""
        return self.exchange.stable_dt(primitive)

    def save(self) -> dict[str, Array]:
        """Copy out what was received, where particles were placed, and the last loads."""
        saved = {name: getattr(self.particles, name) for name in RECEIVED + STATIC}
        saved |= {"placed": self.exchange.particles.position, "azimuths": self.azimuths}
        saved |= {name: getattr(self.exchange.loads, name) for name in SUMS}
        return {f"particles.{name}": array.copy() for name, array in saved.items()}

    def restore(self, saved: Fields) -> None:
        """Return to a saved state."""
        received = {name: np.array(saved[f"particles.{name}"]) for name in RECEIVED + STATIC}
        self.particles = Particles(**received)
        self.azimuths = np.array(saved["particles.azimuths"])
        placed = np.array(saved["particles.placed"])
        self.exchange.place(self.particles._replace(position=placed))
        for name in SUMS:
            getattr(self.exchange.loads, name)[:] = saved[f"particles.{name}"]
