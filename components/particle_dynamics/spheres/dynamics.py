"""Spheres that fly: loads of a partner, gravity, tethers, impacts."""

import math
from functools import partial

import numpy as np

from quintet.components.particle_dynamics.build import STAGES
from quintet.components.particle_dynamics.params import ParticleDynamicsParams
from quintet.components.particle_dynamics.plan import LIMIT
from quintet.components.particle_dynamics.ports import ports
from quintet.components.particle_dynamics.spheres.build import build, planes
from quintet.components.particle_dynamics.spheres.collisions import (
    bounce,
    bounce_from_walls,
    deepest_overlap,
)
from quintet.components.particle_dynamics.spheres.kernels import fly
from quintet.components.particle_dynamics.spheres.pairs import NearPairs
from quintet.components.particle_dynamics.spheres.refusals import (
    refuse_behind_walls,
    refuse_overlaps,
)
from quintet.components.shared.geometry.surface_samples import rigid_answer, sphere
from quintet.interfaces.component import Array, Component, Fields, Keys, Totals
from quintet.interfaces.errors import StepError

KEPT = ("position", "velocity", "orientation", "spin", "temperature", "force", "torque", "heat")
ROUNDING = 1e-9  # of a step, by which the time of a launch may be missed
CLOSING = 0.25  # of the smallest diameter, by which two may come nearer in a step
OVERLAPPING = 0.01  # of the smaller diameter: spheres that overlap by more are wrong
TOUCHING = 0.005  # of the smaller diameter: the largest overlap at the end of a step
MOST_PARTS = 64  # into which a step is divided where several impacts of a sphere fall into it
SWEEPS = 100  # over all pairs, in which an impulse runs through a row: each in turn


class SphereDynamics(Component):
    """Moves spheres under constant loads of each step: without tethers flight is then exact."""

    def __init__(self, params: ParticleDynamicsParams) -> None:
        self.params, (self.takes, self.gives) = params, ports(params)
        self.spheres = build(params.spheres)
        self.planes, self.gravity = planes(params.walls), np.array(params.gravity)
        self.stages = np.array(STAGES[params.integrator])
        count = len(self.spheres.mass)
        collide = params.collisions and count > 1
        self.near = NearPairs(self.spheres.radius) if collide else None
        refuse_behind_walls(self.spheres, self.planes)
        if self.near is not None:
            refuse_overlaps(self.spheres, self.near.at(self.spheres.start))
        self.position = self.spheres.start.copy()  # (n, 3) m
        self.velocity = np.zeros((count, 3))  # m/s
        self.spin = np.zeros((count, 3))  # rad/s
        self.orientation = np.tile([1.0, 0.0, 0.0, 0.0], (count, 1))
        self.temperature = self.spheres.temperature.copy()  # (n,) K
        self.force, self.torque = np.zeros((count, 3)), np.zeros((count, 3))
        self.heat = np.zeros(count)  # W
        self.time, self.lost, self.heated = 0.0, 0.0, 0.0  # s, J of impacts, J of partners
        self.deepest = 0.0  # overlap over the smaller diameter that no step was short enough for
        self.flies = np.zeros(count, bool)  # whether it has been launched
        self._launch(0.0)

    def _launch(self, until: float) -> None:
        """Give those that are launched by a time [s] their first velocities."""
        rows = ~self.flies & (self.spheres.launch <= until)
        self.velocity[rows] = self.spheres.first_velocity[rows]
        self.spin[rows] = self.spheres.first_spin[rows]
        self.flies |= rows

    def describe(self) -> Fields:
        """State radius and mass."""
        one = self.spheres
        return {
            "motion.radius": one.radius.copy(),
            "motion.mass": one.mass.copy(),
            "spheres.mass": one.mass.copy(),
            "spheres.heat_capacity": one.capacity.copy(),
            "spheres.number": one.parcel.copy(),
        }

    def sample(self, request: Fields) -> Fields:
        """Sample the surfaces of the spheres as a partner asks for it."""
        diameters = (2.0 * self.spheres.radius).tolist()
        known = {diameter: partial(sphere, diameter) for diameter in set(diameters)}
        return rigid_answer("motion", request, [known[diameter] for diameter in diameters])

    def stable_dt(self) -> float:
        """Return what tethers, closing speeds and the scene allow; free flight has no limit."""
        one, limits = self.spheres, [self.params.longest_step or math.inf]
        frequency = math.sqrt(float((one.tether / one.mass).max()))
        if frequency > 0.0:
            limits.append(self.params.courant * LIMIT[self.params.integrator] / frequency)
        closing = self._closing(self.velocity)
        pull = self._closing(self._acceleration())
        if closing + pull > 0.0:
            room = 2.0 * CLOSING * float(one.radius.min())
            limits.append(2.0 * room / (closing + math.sqrt(closing**2 + 2.0 * pull * room)))
        return min(limits)

    def _closing(self, rates: Array) -> float:
        """Greatest rate at which two may approach each other, or one a wall, of (n, 3) rates."""
        fastest = 0.0
        if self.near is not None:
            relative = rates - rates.mean(axis=0)
            fastest = 2.0 * math.sqrt(float((relative * relative).sum(axis=1).max()))
        if len(self.planes):
            towards = -(rates @ self.planes[:, :3].T)
            fastest = max(fastest, float(towards.max()))
        return fastest

    def _acceleration(self) -> Array:
        """Accelerations (n, 3) m/s2 of those that fly, by all that acts on them."""
        loaded = self.force / self.spheres.mass[:, None] * self.flies[:, None]
        return np.asarray(loaded + self._own_acceleration())

    def take(self, fields: Fields) -> None:
        """Set force [N], torque [N m] and heat [W] on each sphere; without them there are none."""
        for name, key in (("force", "load.force"), ("torque", "load.torque")):
            getattr(self, name)[:] = fields.get(key, 0.0)
        self.heat[:] = fields.get("heat.heat_flow", 0.0)

    def step(self, dt: float) -> None:
        """Advance by exactly dt [s]; who is launched on the way flies for the rest."""
        if self.near is None:
            self._advance(dt)
            return
        start, allowed, parts = self.save(), max(self._overlap(), TOUCHING), 1
        while not self._advance_in_parts(dt, parts, allowed) and parts < MOST_PARTS:
            parts *= 2
            self.load(start)
        self.time = float(start["rest"][0]) + dt

    def _advance_in_parts(self, dt: float, parts: int, allowed: float) -> bool:
        """Advance by equal parts of dt; return whether no two overlap by more than allowed."""
        for _ in range(parts):
            self._advance(dt / parts)
            overlap = self._overlap()
            if overlap > allowed:
                if parts < MOST_PARTS:
                    return False
                self.deepest = max(self.deepest, overlap)
        return True

    def _overlap(self) -> float:
        """Largest overlap of two spheres, or of one and a wall, over the (smaller) diameter."""
        assert self.near is not None
        radius, overlap = self.spheres.radius, 0.0
        if len(self.planes):
            height = self.position @ self.planes[:, :3].T - self.planes[:, 3]  # (n, w) m
            overlap = max(0.0, float((0.5 - height / (2.0 * radius[:, None])).max()))
        pairs = self.near.at(self.position)
        return max(overlap, deepest_overlap(self.position, radius, *pairs))

    def _advance(self, dt: float) -> None:
        """Fly, then bounce."""
        one, end, flew = self.spheres, self.time + dt, self.flies.copy()
        self._launch(end + ROUNDING * dt)
        fly(
            dt, end, self.stages, self.gravity, one.launch, flew, one.start, one.mass, one.inertia,
            one.tether, self.force, self.torque, self.position, self.velocity, self.orientation,
            self.spin,
        )  # fmt: skip
        self.temperature += dt * self.heat / one.capacity
        self.heated += dt * float(self.heat.sum())
        self.time = end
        if not np.isfinite(self.velocity).all():
            raise StepError(
                f"sphere {int(np.argmin(np.isfinite(self.velocity).all(axis=1)))}: its velocity "
                f"is not finite, at {self.time:g} s. Look at what it is loaded by."
            )
        if self.near is not None or len(self.planes):
            self._collide(dt)

    def _collide(self, dt: float) -> None:
        """Bounce from walls and from each other, until nothing that overlaps approaches."""
        one, acceleration = self.spheres, self._acceleration()
        of = self.position, self.velocity, acceleration, one.radius, one.mass, self.flies
        for sweep in range(SWEEPS):
            impacts = 0
            if len(self.planes):
                lost, impacts = bounce_from_walls(dt, *of, self.planes, self.params.restitution)
                self.lost += lost
            if self.near is not None:
                pairs, backwards = self.near.at(self.position), sweep % 2 == 1
                lost, more = bounce(dt, *of, *pairs, backwards, self.params.restitution)
                self.lost, impacts = self.lost + lost, impacts + more
            if impacts == 0:
                return

    def give(self, wanted: Keys) -> Fields:
        """Copy out motion, temperature and size."""
        given: dict[str, Array] = {
            "motion.position": self.position,
            "motion.velocity": self.velocity,
            "motion.orientation": self.orientation,
            "motion.angular_velocity": self.spin,
            "spheres.position": self.position,
            "spheres.velocity": self.velocity,
            "spheres.acceleration": self._own_acceleration(),
            "spheres.temperature": self.temperature,
            "spheres.diameter": 2.0 * self.spheres.radius,
            "spheres.launched": self.flies.astype(float),
        }
        return {key: given[key].copy() for key in wanted}

    def _own_acceleration(self) -> Array:
        """Accelerations (n, 3) m/s2 by gravity and tethers, of those that fly."""
        stiff = (self.spheres.tether / self.spheres.mass)[:, None]
        found = self.gravity - stiff * (self.position - self.spheres.start)
        return np.asarray(found * self.flies[:, None])

    def save(self) -> Fields:
        """Copy out all state."""
        kept = {name: getattr(self, name).copy() for name in KEPT}
        numbers = np.array([self.time, self.lost, self.heated, self.deepest])
        return kept | {"flies": self.flies.astype(np.float64), "rest": numbers}

    def load(self, state: Fields) -> None:
        """Come back to a saved state, bit for bit."""
        for name in KEPT:
            getattr(self, name)[:] = state[name]
        self.flies[:] = state["flies"] > 0.0
        self.time, self.lost, self.heated, self.deepest = state["rest"].tolist()

    def warnings(self) -> dict[str, str]:
        """Warn of spheres that were pressed into each other, or into walls."""
        if self.deepest <= OVERLAPPING:
            return {}
        said = (
            f"spheres overlapped by up to {100.0 * self.deepest:.2g} % of a diameter; impacts must "
            f"keep them apart within {100.0 * OVERLAPPING:g} %. Hard spheres can neither rest on "
            "one another nor be packed densely. Take dem_bodies for piles and packings."
        )
        return {"overlap": said}

    def totals(self) -> Totals:
        """Mass, momentum and energies; internal is heat, that of impacts included."""
        one = self.spheres
        momentum = one.mass[:, None] * self.velocity
        turning = one.inertia[:, None] * self.spin
        moment = np.cross(self.position, momentum) + turning
        kinetic = 0.5 * float((momentum * self.velocity).sum() + (turning * self.spin).sum())
        stretched = ((self.position - one.start) ** 2).sum(axis=1)  # m2
        fallen = float(one.mass @ (self.position @ self.gravity))
        return Totals(
            mass=float(one.mass.sum()),
            momentum=momentum.sum(axis=0),
            angular_momentum=moment.sum(axis=0),
            kinetic=kinetic,
            potential=0.5 * float(one.tether @ stretched) - fallen,
            internal=self.lost + self.heated,
        )

    def view(self) -> Fields:
        """Spheres with velocity and temperature."""
        count = len(self.spheres.mass)
        return {
            "points": self.position.copy(),
            "radius": self.spheres.radius.copy(),
            "velocity": self.velocity.copy(),
            "temperature": self.temperature.copy(),
            "hotness": np.zeros(count),
            "relative_hotness": np.zeros(count),
        }

    def items(self) -> int:
        """Count the spheres."""
        return len(self.spheres.mass)
