"""Spheres in flight: loads of a partner, gravity, tethers, impacts."""

import math
from functools import partial

import numpy as np

from quintet.components.particle_dynamics.integrators import LIMIT, STAGES
from quintet.components.particle_dynamics.spheres import MANIFEST
from quintet.components.particle_dynamics.spheres.accelerations import (
    Flags,
    acceleration,
    free_acceleration,
)
from quintet.components.particle_dynamics.spheres.build import build
from quintet.components.particle_dynamics.spheres.diagnostics import totals, warnings
from quintet.components.particle_dynamics.spheres.features import spheres_of
from quintet.components.particle_dynamics.spheres.kernels import fly
from quintet.components.particle_dynamics.spheres.params import ParticleSpheresParams
from quintet.components.particle_dynamics.spheres.ports import SHOWS
from quintet.components.particle_dynamics.spheres.state import (
    DEEPEST,
    HEATED,
    TIME,
    Spheres,
    State,
    launch,
)
from quintet.components.particle_dynamics.spheres.view import view
from quintet.components.shared.finite_items import require_finite_items
from quintet.components.shared.geometry.surface_samples import rigid_answer, sphere
from quintet.interfaces.component import (
    ONE_THREAD,
    Array,
    Component,
    Fields,
    Keys,
    Resources,
    Totals,
)
from quintet.interfaces.errors import StepError

HEAT_FLOW = "heat.heat_flow"
ROUNDING = 1e-9  # of a step, by which the time of a launch may be missed
CLOSING = 0.25  # of the smallest diameter, by which two may come nearer in a step
TOUCHING = 0.005  # of the smaller diameter: the largest overlap at the end of a step
LOADS = {"load.force": "force", "load.torque": "torque", HEAT_FLOW: "heat"}  # rows of the state
MOST_PARTS = 64  # into which a step is divided where several impacts of a sphere fall into it


class ParticleSpheres(Component):
    """Moves spheres under loads that are constant over a step; flight without tethers is exact.

    Parameters
    ----------
    params : ParticleSpheresParams
        Spheres, walls, gravity.
    resources : Resources
        With a communicator of several ranks each moves its share of the spheres.
    """

    Params: type[ParticleSpheresParams] = ParticleSpheresParams
    manifest = MANIFEST
    shows = SHOWS

    def __init__(self, params: ParticleSpheresParams, resources: Resources = ONE_THREAD) -> None:
        self.params, (self.takes, self.gives) = params, self.ports_of(params)
        spheres = build(params.spheres)
        self.gravity = np.array(params.gravity)
        self.frequency = math.sqrt(float((spheres.tether / spheres.mass).max()))  # rad/s
        self.room = 2.0 * CLOSING * float(spheres.radius.min())  # m
        self.stages = np.array(STAGES[params.integrator])
        self.rows, self.impacts = spheres_of(resources, params, spheres)
        self.heat_flow = 0.0  # W, to all spheres
        launch(self.spheres, self.state, 0.0)

    @property
    def spheres(self) -> Spheres:
        """What never changes, of the spheres of this rank."""
        return self.rows.spheres

    @property
    def state(self) -> State:
        """What moves, of the spheres of this rank."""
        return self.rows.state

    def describe(self) -> Fields:
        """State radius and mass; for a gas also heat capacity and the size of parcels."""
        spheres, whole = self.spheres, self.rows.whole
        return {
            "motion.radius": whole(spheres.radius),
            "motion.mass": whole(spheres.mass),
            "spheres.mass": whole(spheres.mass),
            "spheres.heat_capacity": whole(spheres.capacity),
            "spheres.number": whole(spheres.parcel),
        }

    def sample(self, request: Fields) -> Fields:
        """Sample the surfaces of the spheres as a partner requests."""
        diameters = (2.0 * self.rows.whole(self.spheres.radius)).tolist()
        known = {diameter: partial(sphere, diameter) for diameter in set(diameters)}
        return rigid_answer("motion", request, [known[diameter] for diameter in diameters])

    def stable_dt(self) -> float:
        """Return what tethers, closing speeds and the scene allow; free flight has no limit."""
        limits = [self.params.longest_step or math.inf]
        if self.frequency > 0.0:
            limits.append(self.params.courant * LIMIT[self.params.integrator] / self.frequency)
        if self.impacts is None:
            return min(limits)
        state, launch = self.state, self.spheres.launch
        step = min(*limits, self._approaching(state.velocity, state.launched))
        waiting = np.where(state.launched, np.inf, launch)
        first = -self.rows.greatest(-float(waiting.min(initial=np.inf)))  # s, of all ranks
        rest = first - float(state.sums[TIME])  # s, until it is launched
        if not rest < step:
            return step
        due = waiting < first + step - rest  # launched within the step, with speeds of their own
        velocity = np.where(due[:, None], self.spheres.first_velocity, state.velocity)
        return min(step, max(rest, self._approaching(velocity, state.launched | due)))

    def _approaching(self, velocity: Array, flying: Flags) -> float:
        """Time [s] in which spheres with velocities (n, 3) m/s may come too near to each other."""
        assert self.impacts
        closing = self.impacts.closing_speed(velocity)
        pull = self.impacts.closing_speed(
            acceleration(self.spheres, self.state, self.gravity, flying)
        )
        if not closing + pull > 0.0:
            return math.inf
        root = math.sqrt(closing**2 + 2.0 * pull * self.room)
        return 2.0 * self.room / (closing + root)

    def take(self, fields: Fields) -> None:
        """Set force [N], torque [N m] and heat [W] on each sphere; they are 0 if absent."""
        self.heat_flow = 0.0
        for port, name in LOADS.items():
            loads = self.rows.here(fields[port]) if port in fields else 0.0
            getattr(self.state, name)[:] = loads
        if HEAT_FLOW in fields:
            self.heat_flow = float(fields[HEAT_FLOW].sum())

    def step(self, dt: float) -> None:
        """Advance by exactly dt [s], in parts where spheres would overlap by too much."""
        if self.impacts is None or not self.impacts.collide:
            self._advance(dt)
            return
        self.impacts.share_out()
        start, parts = {k: array.copy() for k, array in self.state._asdict().items()}, 1
        while not self._advance_in_parts(dt, parts, start["position"]) and parts < MOST_PARTS:
            parts *= 2
            for name, array in self.state._asdict().items():
                array[:] = start[name]
        self.state.sums[TIME] = start["sums"][TIME] + dt

    def _advance_in_parts(self, dt: float, parts: int, start: Array) -> bool:
        """Advance by equal parts of dt; return whether none overlap by more than at the start."""
        assert self.impacts
        for _ in range(parts):
            self._advance(dt / parts)
            overlap = self.impacts.overlap(self.state.position)
            if overlap > TOUCHING and overlap > self.impacts.overlap(start):
                if parts < MOST_PARTS:
                    return False
                self.state.sums[DEEPEST] = max(self.state.sums[DEEPEST], overlap)
        return True

    def _advance(self, dt: float) -> None:
        """Fly, then bounce; a sphere that is launched within the step flies for the rest of it."""
        spheres, state = self.spheres, self.state
        end, launched = float(state.sums[TIME]) + dt, state.launched.copy()
        launch(spheres, state, end + ROUNDING * dt)
        fly(
            dt, end, self.stages, self.gravity, spheres.launch, launched, spheres.start,
            spheres.mass, spheres.inertia, spheres.tether, state.force, state.torque,
            state.position, state.velocity, state.orientation, state.spin,
        )  # fmt: skip
        state.temperature[:] += dt * state.heat / spheres.capacity
        state.sums[HEATED] += dt * self.heat_flow
        state.sums[TIME] = end
        wrong = self.rows.not_finite(state.velocity)
        if wrong < self.rows.count:
            raise StepError(
                f"sphere {wrong}: its velocity must be finite; it is not, at {end:g} s. Check the "
                "loads on it.",
                state.position[min(wrong, len(state.position) - 1)],
            )
        if self.impacts is not None:
            self.impacts.resolve(dt, acceleration(spheres, state, self.gravity, state.launched))

    def check(self) -> None:
        """Refuse a sphere whose rotation or temperature is not finite."""
        state = self.state
        fields = {
            "temperature": state.temperature,
            "angular velocity": state.spin,
            "orientation": state.orientation,
        }
        advice = "Check the loads on it, and the heat that it gets."
        require_finite_items("sphere", fields, self.rows.ids, state.position, advice)

    def give(self, wanted: Keys) -> Fields:
        """Copy out motion, temperature and size."""
        state = self.state
        values: dict[str, Array] = {
            "position": state.position,
            "velocity": state.velocity,
            "orientation": state.orientation,
            "angular_velocity": state.spin,
            "temperature": state.temperature,
            "diameter": 2.0 * self.spheres.radius,
            "launched": state.launched.astype(float),
        }
        if "spheres.acceleration" in wanted:
            values["acceleration"] = free_acceleration(
                self.spheres, state, self.gravity, state.launched
            )
        # Both ports have some fields; all ranks go in one order.
        names = {key.partition(".")[2]: key for key in sorted(wanted)}
        rows = self.rows.give([values[name] for name in names])
        fields = dict(zip(names.values(), rows, strict=True))
        doubled = wanted - fields.keys()
        return fields | {key: fields[names[key.partition(".")[2]]].copy() for key in doubled}

    def save(self) -> Fields:
        """Copy out all state."""
        rows = {name: np.asarray(array, float) for name, array in self.state._asdict().items()}
        sums = rows.pop("sums").copy()
        return {name: self.rows.whole(array) for name, array in rows.items()} | {"sums": sums}

    def load(self, state: Fields) -> None:
        """Restore a saved state, bit for bit."""
        self.rows.load(state)
        self.heat_flow = float(state["heat"].sum())

    def begin_from(self, state: Fields) -> None:
        """Begin from the state of another run; launches that are to come count from now on."""
        super().begin_from(state)
        self.state.sums[TIME] = self.state.sums[DEEPEST] = 0.0

    def warnings(self) -> dict[str, str]:
        """Warn of spheres that were pressed into each other, or into walls."""
        return warnings(self.state)

    def totals(self) -> Totals:
        """Mass, momentum and energies; internal is heat, that of impacts included."""
        return totals(self.rows, self.gravity)

    def view(self) -> Fields:
        """Spheres with velocity and temperature."""
        return view(self.rows)

    def items(self) -> int:
        """Count the spheres."""
        return self.rows.count
