"""Point particles of a partner: what it tells of them, and what the gas does to them."""

import numpy as np

from quintet.components.meshless_gas.build import Domain, transport_of
from quintet.components.meshless_gas.kernels.motion import STAGES
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.point_particles.interphase import InterphaseExchange
from quintet.components.meshless_gas.point_particles.particles import Particles
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import StepError

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


class Partner:
    """Particles as they were last told, and their exchange with the nodes."""

    def __init__(self, params: MeshlessGasParams, domain: Domain) -> None:
        assert params.particles is not None
        gas = params.gas
        self.exchange = InterphaseExchange(
            params.particles, domain.cloud, params.planar, transport_of(gas), gas.gamma, gas.prandtl
        )
        # What boundary nodes were given would be lost: their states follow from others.
        advanced = np.zeros(domain.cloud.nodes, bool)
        advanced[domain.inner] = True
        images = advanced[domain.cloud.owner]
        self.exchange.look_among(np.flatnonzero(np.concatenate([advanced, images])))
        self.periods = periods(params)
        self.hold(0)

    def hold(self, count: int) -> None:
        """Make room for so many particles, of which nothing is known."""
        self.exchange.resize(count)
        self.particles = self.exchange.particles

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
        self.place()
        self._find_rates(primitive)

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
        """Begin a step: find the nodes around them, or around their images in a periodic box."""
        x = self.particles.position.copy()
        for axis, low, length in self.periods:
            x[:, axis] = low + np.mod(x[:, axis] - low, length)
        self.exchange.place(self.particles._replace(position=x))

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
        force = self.exchange.loads.force
        return {
            "particle_load.force": force.copy(),
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
        for name in SUMS:
            kept[f"particles.{name}"] = getattr(self.exchange.loads, name).copy()
        return kept

    def load(self, state: Fields) -> None:
        """Come back to it."""
        told = {name: np.array(state[f"particles.{name}"]) for name in TOLD + STATIC}
        self.particles = Particles(**told)
        placed = self.particles._replace(position=np.array(state["particles.placed"]))
        self.exchange.place(placed)
        for name in SUMS:
            getattr(self.exchange.loads, name)[:] = state[f"particles.{name}"]
