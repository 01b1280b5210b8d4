"""Spheres in flight: loads of a partner, gravity, tethers, impacts."""

import math
from functools import partial

import numpy as np

from quintet.components.particle_dynamics.integrators import LIMIT, STAGES
from quintet.components.particle_dynamics.spheres import MANIFEST
from quintet.components.particle_dynamics.spheres.build import build, initial_state
from quintet.components.particle_dynamics.spheres.diagnostics import totals, warnings
from quintet.components.particle_dynamics.spheres.features import Impacts, impacts
from quintet.components.particle_dynamics.spheres.kernels import fly
from quintet.components.particle_dynamics.spheres.params import ParticleSpheresParams
from quintet.components.particle_dynamics.spheres.ports import SHOWS
from quintet.components.particle_dynamics.spheres.state import DEEPEST, HEATED, TIME
from quintet.components.particle_dynamics.spheres.view import view
from quintet.components.shared.geometry.surface_samples import rigid_answer, sphere
from quintet.interfaces.component import Array, Component, Fields, Keys, Totals
from quintet.interfaces.errors import StepError

ROUNDING = 1e-9  # of a step, by which the time of a launch may be missed
CLOSING = 0.25  # of the smallest diameter, by which two may come nearer in a step
TOUCHING = 0.005  # of the smaller diameter: the largest overlap at the end of a step
MOST_PARTS = 64  # into which a step is divided where several impacts of a sphere fall into it


class ParticleSpheres(Component):
    """Moves spheres under loads that are constant over a step; flight without tethers is exact.

    Parameters
    ----------
    params : ParticleSpheresParams
        Spheres, walls, gravity.
    """

    Params: type[ParticleSpheresParams] = ParticleSpheresParams
    manifest = MANIFEST
    shows = SHOWS

    def __init__(self, params: ParticleSpheresParams) -> None:
        self.params, (self.takes, self.gives) = params, self.ports_of(params)
        self.spheres = build(params.spheres)
        self.impacts = impacts(params, self.spheres)
        self.gravity = np.array(params.gravity)
        self.stiff = (self.spheres.tether / self.spheres.mass)[:, None]  # (n, 1) 1/s2
        self.frequency = math.sqrt(float(self.stiff.max()))  # rad/s, of the stiffest tether
        self.stages = np.array(STAGES[params.integrator])
        self.state = initial_state(self.spheres)
        self._launch(0.0)

    def _launch(self, until: float) -> None:
        """Give the first velocities to spheres that are launched by a time [s]."""
        spheres, state = self.spheres, self.state
        rows = ~state.launched & (spheres.launch <= until)
        state.velocity[rows] = spheres.first_velocity[rows]
        state.spin[rows] = spheres.first_spin[rows]
        state.launched[rows] = True

    def describe(self) -> Fields:
        """State radius and mass; for a gas also heat capacity and the size of parcels."""
        spheres = self.spheres
        return {
            "motion.radius": spheres.radius.copy(),
            "motion.mass": spheres.mass.copy(),
            "spheres.mass": spheres.mass.copy(),
            "spheres.heat_capacity": spheres.capacity.copy(),
            "spheres.number": spheres.parcel.copy(),
        }

    def sample(self, request: Fields) -> Fields:
        """Sample the surfaces of the spheres as a partner requests."""
        diameters = (2.0 * self.spheres.radius).tolist()
        known = {diameter: partial(sphere, diameter) for diameter in set(diameters)}
        return rigid_answer("motion", request, [known[diameter] for diameter in diameters])

    def stable_dt(self) -> float:
        """Return what tethers, closing speeds and the scene allow; free flight has no limit."""
        limits = [self.params.longest_step or math.inf]
        if self.frequency > 0.0:
            limits.append(self.params.courant * LIMIT[self.params.integrator] / self.frequency)
        if self.impacts is not None:
            closing = self.impacts.closing_speed(self.state.velocity)
            pull = self.impacts.closing_speed(self._acceleration())
            room = 2.0 * CLOSING * float(self.spheres.radius.min())
            if closing + pull > 0.0:
                limits.append(2.0 * room / (closing + math.sqrt(closing**2 + 2.0 * pull * room)))
        return min(limits)

    def _acceleration(self) -> Array:
        """Accelerations (n, 3) m/s2 of launched spheres, by all forces."""
        loaded = self.state.force / self.spheres.mass[:, None] * self.state.launched[:, None]
        return np.asarray(loaded + self._free_acceleration())

    def _free_acceleration(self) -> Array:
        """Accelerations (n, 3) m/s2 of launched spheres, by gravity and tethers."""
        pull = self.gravity
        if self.frequency > 0.0:
            pull = pull - self.stiff * (self.state.position - self.spheres.start)
        return np.asarray(pull * self.state.launched[:, None])

    def take(self, fields: Fields) -> None:
        """Set force [N], torque [N m] and heat [W] on each sphere; they are 0 if absent."""
        self.state.force[:] = fields.get("load.force", 0.0)
        self.state.torque[:] = fields.get("load.torque", 0.0)
        self.state.heat[:] = fields.get("heat.heat_flow", 0.0)

    def step(self, dt: float) -> None:
        """Advance by exactly dt [s], in parts where spheres would overlap by too much."""
        if self.impacts is None or not self.impacts.collide:
            self._advance(dt)
            return
        start, parts = self.save(), 1
        while not self._advance_in_parts(dt, parts, start, self.impacts) and parts < MOST_PARTS:
            parts *= 2
            self.load(start)
        self.state.sums[TIME] = start["sums"][TIME] + dt

    def _advance_in_parts(self, dt: float, parts: int, start: Fields, impacts: Impacts) -> bool:
        """Advance by equal parts of dt; return whether none overlap by more than at the start."""
        for _ in range(parts):
            self._advance(dt / parts)
            overlap = impacts.overlap(self.state.position)
            if overlap > TOUCHING and overlap > impacts.overlap(start["position"]):
                if parts < MOST_PARTS:
                    return False
                self.state.sums[DEEPEST] = max(self.state.sums[DEEPEST], overlap)
        return True

    def _advance(self, dt: float) -> None:
        """Fly, then bounce; a sphere that is launched within the step flies for the rest of it."""
        spheres, state = self.spheres, self.state
        end, launched = float(state.sums[TIME]) + dt, state.launched.copy()
        self._launch(end + ROUNDING * dt)
        fly(
            dt, end, self.stages, self.gravity, spheres.launch, launched, spheres.start,
            spheres.mass, spheres.inertia, spheres.tether, state.force, state.torque,
            state.position, state.velocity, state.orientation, state.spin,
        )  # fmt: skip
        state.temperature[:] += dt * state.heat / spheres.capacity
        state.sums[HEATED] += dt * float(state.heat.sum())
        state.sums[TIME] = end
        finite = np.isfinite(state.velocity)
        if not finite.all():
            raise StepError(
                f"sphere {int(np.argmin(finite.all(axis=1)))}: its velocity must be finite; it is "
                f"not, at {end:g} s. Check the loads on it."
            )
        if self.impacts is not None:
            self.impacts.resolve(dt, state, self._acceleration())

    def give(self, wanted: Keys) -> Fields:
        """Copy out motion, temperature and size."""
        state = self.state
        values: dict[str, Array] = {
            "motion.position": state.position,
            "motion.velocity": state.velocity,
            "motion.orientation": state.orientation,
            "motion.angular_velocity": state.spin,
            "spheres.position": state.position,
            "spheres.velocity": state.velocity,
            "spheres.temperature": state.temperature,
            "spheres.diameter": 2.0 * self.spheres.radius,
            "spheres.launched": state.launched.astype(float),
        }
        if "spheres.acceleration" in wanted:
            values["spheres.acceleration"] = self._free_acceleration()
        return {key: values[key].copy() for key in wanted}

    def save(self) -> Fields:
        """Copy out all state."""
        return {name: np.array(array, float) for name, array in self.state._asdict().items()}

    def load(self, state: Fields) -> None:
        """Restore a saved state, bit for bit."""
        for name, array in self.state._asdict().items():
            array[:] = state[name]

    def warnings(self) -> dict[str, str]:
        """Warn of spheres that were pressed into each other, or into walls."""
        return warnings(self.state)

    def totals(self) -> Totals:
        """Mass, momentum and energies; internal is heat, that of impacts included."""
        return totals(self.spheres, self.state, self.gravity)

    def view(self) -> Fields:
        """Spheres with velocity and temperature."""
        return view(self.spheres, self.state)

    def items(self) -> int:
        """Count the spheres."""
        return len(self.spheres.mass)
