"""Point particles of a partner: what it tells of them, and what the gas does to them."""

import numpy as np

from quintet.components.meshless_gas.build import Domain, transport_of
from quintet.components.meshless_gas.kernels.motion import STAGES
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.point_particles.half_plane import (
    azimuths_of,
    from_half_plane,
    to_half_plane,
)
from quintet.components.meshless_gas.point_particles.interphase import InterphaseExchange
from quintet.components.meshless_gas.point_particles.kernels import OUTSIDE
from quintet.components.meshless_gas.point_particles.particles import Particles
from quintet.components.meshless_gas.view import reaches
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import SceneError, StepError

TOLD = ("position", "velocity", "acceleration", "temperature", "diameter", "launched")
SUMS = ("force", "heat", "power", "rates")
STATIC = ("mass", "heat_capacity", "number")


def periods(params: MeshlessGasParams) -> list[tuple[int, float, float]]:
    """Axes along which the gas repeats: number, lowest place [m] and length [m]."""
    found, box = [], params.box
    if box is None:
        return []
    for axis, name in enumerate("xyz"):
        if params.kind_of(f"{name}-") == "periodic" and not (params.planar and name == "y"):
            found.append((axis, box.lowest[axis], box.highest[axis] - box.lowest[axis]))
    return found


class CoupledParticles:
    """Particles as they were last told, and their exchange with the nodes."""

    def __init__(self, params: MeshlessGasParams, domain: Domain) -> None:
        assert params.particles is not None
        gas, cloud = params.gas, domain.cloud
        if params.box is None:
            # Layers are thinner than they are wide: a particle has left the gas that is farther
            # from its nearest node than all neighbours of this are.
            reach = reaches(domain)[np.concatenate([np.arange(cloud.nodes), cloud.owner])]
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
        one = params.sphere
        self.axis = np.array(one.centre) if one is not None and params.axisymmetric else None
        self.hold(0)

    def hold(self, count: int) -> None:
        """Make room for so many particles, of which nothing is known."""
        self.exchange.resize(count)
        self.particles = self.exchange.particles
        self.azimuths = np.tile([1.0, 0.0], (count, 1))  # (p, 2) 1, cosines and sines

    def bind(self, static: Fields) -> None:
        """Learn how heavy they are, how much heat they hold, and how many each stands for."""
        if "particles.mass" not in static:
            return
        self.hold(len(static["particles.mass"]))
        found = {name: np.array(static[f"particles.{name}"], float) for name in STATIC}
        self.particles = self.particles._replace(**found)

    def prime(self, fields: Fields, primitive: Array) -> None:
        """Learn where they are at the start, and how stiffly they are held there."""
        self.take(fields)
        self._refuse_resolved()
        self.place()
        self._find_rates(primitive)

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

    def _find_rates(self, primitive: Array) -> None:
        """Find how stiff the exchange is, without any exchange."""
        self.exchange.add(primitive, None, 0.0, STAGES[0])
        self.place()

    def take(self, fields: Fields) -> None:
        """Take what is told of them for the coming step."""
        found = {
            name: np.array(fields[f"particles.{name}"], float)
            for name in TOLD
            if f"particles.{name}" in fields
        }
        self.particles = self.particles._replace(**found)
        if found and not self.particles.temperature.min(initial=1.0) > 0.0:
            coldest = int(self.particles.temperature.argmin())
            raise StepError(
                f"particles must be warmer than 0 K; particle {coldest} has "
                f"{self.particles.temperature[coldest]:.4g} K. Shorten the window."
            )

    def place(self) -> None:
        """Begin a step: find the nodes around them, or around their images.

        These are in a periodic box, or about an axis in the half-plane that has nodes.
        """
        one, x = self.particles, self.particles.position.copy()
        for axis, low, length in self.periods:
            x[:, axis] = low + np.mod(x[:, axis] - low, length)
        if self.axis is not None:
            azimuths = self.azimuths = azimuths_of(x, self.axis)
            x = self.axis + to_half_plane(azimuths, x - self.axis)
            velocity, acceleration = (
                to_half_plane(azimuths, one.velocity),
                to_half_plane(azimuths, one.acceleration),
            )
            one = one._replace(velocity=velocity, acceleration=acceleration)
        self.exchange.place(one._replace(position=x))

    def add(
        self, primitive: Array, residual: Array, dt: float, stage: tuple[float, float, float]
    ) -> None:
        """Exchange momentum and heat in a stage of a step [s]."""
        self.exchange.add(primitive, residual, dt, stage)

    def given(self) -> Array:
        """Mass, momentum and energy (5,) kg/s, N, W that the gas gave in the last step."""
        if not self.exchange.reaction:
            return np.zeros(5)
        one = self.exchange.loads
        return np.array([0.0, *one.force.sum(axis=0), one.power.sum()])

    def loads(self) -> Fields:
        """Mean force [N] and heat [W] on each in the last step."""
        force = from_half_plane(self.azimuths, self.exchange.loads.force)
        return {
            "particle_load.force": force,
            "particle_load.torque": np.zeros_like(force),
            "particle_heat.heat_flow": self.exchange.loads.heat.copy(),
        }

    def stable_dt(self, primitive: Array) -> float:
        """Step [s] that their stiffness allows."""
        return self.exchange.stable_dt(primitive)

    def save(self) -> dict[str, Array]:
        """Copy out what was told, and the last loads; they stand where they were placed."""
        kept = {f"particles.{name}": getattr(self.particles, name).copy() for name in TOLD + STATIC}
        kept["particles.placed"] = self.exchange.particles.position.copy()
        kept["particles.azimuths"] = self.azimuths.copy()
        for name in SUMS:
            kept[f"particles.{name}"] = getattr(self.exchange.loads, name).copy()
        return kept

    def load(self, state: Fields) -> None:
        """Come back to it."""
        told = {name: np.array(state[f"particles.{name}"]) for name in TOLD + STATIC}
        self.particles = Particles(**told)
        placed = self.particles._replace(position=np.array(state["particles.placed"]))
        self.azimuths = np.array(state["particles.azimuths"])
        self.exchange.place(placed)
        for name in SUMS:
            getattr(self.exchange.loads, name)[:] = state[f"particles.{name}"]
