"""Spheres that fly: loads of a partner, gravity, impacts; stepped by velocity Verlet."""

import math

import numpy as np

from quintet.components.particle_dynamics.params import ParticleDynamicsParams
from quintet.components.particle_dynamics.ports import ports
from quintet.components.particle_dynamics.spheres.collisions import bounce
from quintet.interfaces import rotation
from quintet.interfaces.component import Array, Component, Fields, Keys, Totals
from quintet.interfaces.errors import StepError
from quintet.interfaces.ports import SPHERE

KEPT = ("position", "velocity", "orientation", "spin", "temperature", "force", "torque", "heat")


class SphereDynamics(Component):
    """Moves spheres under constant loads of each step: places and velocities are then exact."""

    def __init__(self, params: ParticleDynamicsParams) -> None:
        self.params, (self.takes, self.gives) = params, ports(params)
        given = params.spheres
        self.radius = np.array([0.5 * one.diameter for one in given])  # (n,) m
        density = np.array([one.density for one in given])
        self.mass = density * 4.0 / 3.0 * math.pi * self.radius**3  # (n,) kg
        self.inertia = 0.4 * self.mass * self.radius**2  # (n,) kg m2
        self.capacity = self.mass * np.array([one.specific_heat for one in given])  # (n,) J/K
        self.launch = np.array([one.launch for one in given])  # (n,) s
        walls = [np.array([*one.normal, one.offset]) for one in params.walls]
        for wall in walls:
            wall[:3] /= np.linalg.norm(wall[:3])
        self.planes = np.array(walls).reshape(-1, 4)
        self.gravity = np.array(params.gravity)
        self.position = np.array([one.position for one in given])  # (n, 3) m
        self.velocity = np.zeros_like(self.position)  # m/s
        self.spin = np.zeros_like(self.position)  # (n, 3) rad/s
        self.orientation = np.tile([1.0, 0.0, 0.0, 0.0], (len(given), 1))
        self.temperature = np.array([one.temperature for one in given])  # (n,) K
        self.force, self.torque = np.zeros_like(self.position), np.zeros_like(self.position)
        self.heat = np.zeros(len(given))  # W
        self.time, self.lost, self.heated = 0.0, 0.0, 0.0  # s, J of impacts, J of partners
        self.fly = np.zeros(len(given), bool)  # whether it has been launched
        self._launch(0.0)

    def _launch(self, until: float) -> None:
        """Give those that are launched by a time [s] their first velocities."""
        for k in np.flatnonzero(~self.fly & (self.launch <= until)).tolist():
            one = self.params.spheres[k]
            self.velocity[k], self.spin[k], self.fly[k] = one.velocity, one.angular_velocity, True

    def describe(self) -> Fields:
        """State shape, size and mass."""
        size = np.repeat(2.0 * self.radius[:, None], 3, axis=1)
        shape = np.full(len(self.mass), float(SPHERE))
        return {"motion.shape": shape, "motion.size": size, "motion.mass": self.mass.copy()}

    def stable_dt(self) -> float:
        """Return the step that the scene says; free flight has no limit."""
        return self.params.longest_step or math.inf

    def take(self, fields: Fields) -> None:
        """Set force [N], torque [N m] and heat [W] on each sphere; without them there are none."""
        for name, key in (("force", "load.force"), ("torque", "load.torque")):
            getattr(self, name)[:] = fields.get(key, 0.0)
        self.heat[:] = fields.get("heat.heat_flow", 0.0)

    def step(self, dt: float) -> None:
        """Advance by exactly dt [s]; who is launched on the way flies for the rest."""
        end = self.time + dt
        flies_before = self.fly.copy()
        self._launch(end)
        span = np.where(flies_before, dt, np.clip(end - self.launch, 0.0, dt))
        span = np.where(self.fly, span, 0.0)[:, None]
        acceleration = self.force / self.mass[:, None] + self.gravity
        self.position += span * (self.velocity + 0.5 * span * acceleration)
        self.velocity += span * acceleration
        turning = self.torque / self.inertia[:, None]
        angle = span * (self.spin + 0.5 * span * turning)
        self.orientation[:] = rotation.product(rotation.exponential(angle), self.orientation)
        self.orientation /= np.linalg.norm(self.orientation, axis=1, keepdims=True)
        self.spin += span * turning
        self.temperature += dt * self.heat / self.capacity
        self.heated += dt * float(self.heat.sum())
        self.lost += bounce(
            self.position, self.velocity, self.radius, self.mass, self.fly, self.planes,
            self.params.restitution,
        )  # fmt: skip
        self.time = end
        if not np.isfinite(self.velocity).all():
            raise StepError(
                f"sphere {int(np.argmin(np.isfinite(self.velocity).all(axis=1)))}: its velocity "
                f"is not finite, at {self.time:g} s. Look at what it is loaded by."
            )

    def give(self, wanted: Keys) -> Fields:
        """Copy out motion, temperature and size."""
        given: dict[str, Array] = {
            "motion.position": self.position,
            "motion.velocity": self.velocity,
            "motion.orientation": self.orientation,
            "motion.angular_velocity": self.spin,
            "spheres.position": self.position,
            "spheres.velocity": self.velocity,
            "spheres.temperature": self.temperature,
            "spheres.diameter": 2.0 * self.radius,
        }
        return {key: given[key].copy() for key in wanted}

    def save(self) -> Fields:
        """Copy out all state."""
        kept = {name: getattr(self, name).copy() for name in KEPT}
        numbers = np.array([self.time, self.lost, self.heated])
        return kept | {"fly": self.fly.astype(np.float64), "rest": numbers}

    def load(self, state: Fields) -> None:
        """Come back to a saved state, bit for bit."""
        for name in KEPT:
            getattr(self, name)[:] = state[name]
        self.fly[:] = state["fly"] > 0.0
        self.time, self.lost, self.heated = state["rest"].tolist()

    def totals(self) -> Totals:
        """Mass, momentum and energies; internal is heat, that of impacts included."""
        momentum = self.mass[:, None] * self.velocity
        turning = self.inertia[:, None] * self.spin
        moment = np.cross(self.position, momentum) + turning
        kinetic = 0.5 * float((momentum * self.velocity).sum() + (turning * self.spin).sum())
        return Totals(
            mass=float(self.mass.sum()),
            momentum=momentum.sum(axis=0),
            angular_momentum=moment.sum(axis=0),
            kinetic=kinetic,
            potential=-float(self.mass @ (self.position @ self.gravity)),
            internal=self.lost + self.heated,
        )

    def view(self) -> Fields:
        """Spheres with velocity and temperature."""
        count = len(self.mass)
        return {
            "points": self.position.copy(),
            "radius": self.radius.copy(),
            "velocity": self.velocity.copy(),
            "temperature": self.temperature.copy(),
            "hotness": np.zeros(count),
            "relative_hotness": np.zeros(count),
        }

    def items(self) -> int:
        """Count the spheres."""
        return len(self.mass)
