"""A lattice of mass points, stepped by velocity Verlet or Yoshida's scheme."""

import math

import numpy as np

from quintet.components.particle_dynamics import MANIFEST, diagnostics
from quintet.components.particle_dynamics.build import build, initial_state
from quintet.components.particle_dynamics.diagnostics import CHECKED, Losses
from quintet.components.particle_dynamics.energies import EnergyBudget
from quintet.components.particle_dynamics.features import (
    bath_temperatures,
    bathed,
    model,
    rows_of,
    wall_of,
)
from quintet.components.particle_dynamics.integrators import LIMIT, damped_step
from quintet.components.particle_dynamics.params import ParticleLatticeParams
from quintet.components.particle_dynamics.ports import SHOWS
from quintet.components.particle_dynamics.state import TIME, State
from quintet.components.particle_dynamics.view import view
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


class ParticleLattice(Component):
    """Moves a lattice of points by the forces of pairs, a drive, baths and collisions.

    Parameters
    ----------
    params : ParticleLatticeParams
        Points, forces, and what holds and heats them.
    resources : Resources
        With a communicator of several ranks each steps its share of the points; with a device the
        points are there, and their arrays are copied to the host when they are read.
    """

    Params: type[ParticleLatticeParams] = ParticleLatticeParams
    manifest = MANIFEST
    shows = SHOWS
    compiles = True

    def __init__(self, params: ParticleLatticeParams, resources: Resources = ONE_THREAD) -> None:
        self.params, (self.takes, self.gives) = params, self.ports_of(params)
        self.lattice, baths = params.lattice, params.baths
        built = build(params)
        self.bathed = bathed(built.start, baths)
        whole = model(params, built, self.bathed)
        state = initial_state(
            params, built.start, whole, bath_temperatures(self.bathed, self.params.baths)
        )
        self.rows = rows_of(resources, params, built, state, whole)
        self.built = self.rows.reduced(built)
        self.wall = wall_of(self.bathed, baths, self.rows.bathed)
        stiffest = self.bathed.tether.max(initial=0.0)
        frequency = math.sqrt(built.frequency**2 + stiffest / self.lattice.mass)  # rad/s
        driven = 2.0 * math.pi * (params.drive.frequency if params.drive else 0.0)  # rad/s
        vibrating = params.courant * (LIMIT[params.integrator] / max(frequency, driven))  # s
        mass, count = self.lattice.mass, self.lattice.count
        damped = damped_step(params.damping, mass, count, params.integrator)
        self.substep = min(vibrating, damped)  # s
        self.losses, free = Losses(), self.lattice.count - len(built.frozen)
        self.budget = EnergyBudget(params, self.rows, self.bathed, frequency, free)
        self.started = 0.0  # s, when this run began

    @property
    def state(self) -> State:
        """What moves: of one rank all points, of several its points and copies of others."""
        return self.rows.read()

    @property
    def time(self) -> float:
        """Time [s] of the present state."""
        return float(self.rows.state.energies[TIME])

    def describe(self) -> Fields:
        """State where the points of the wall are."""
        if not len(self.wall.rows):
            return {}
        return {"wall_heat.position": self.bathed.rest[self.wall.rows]}

    def rank_rows(self, port: str) -> Array | None:
        """Points of the wall whose heat this rank computes."""
        return self.wall.of_wall if port == "wall_heat" else None

    def stable_dt(self) -> float:
        """Return the length of all substeps."""
        return self.params.substeps * self.substep

    def take(self, fields: Fields) -> None:
        """Set the temperatures [K] of the wall."""
        temperature = fields.get("wall_temperature.temperature")
        if temperature is not None:
            here = temperature[self.wall.of_wall]
            self.rows.state.temperature[self.wall.here] = np.maximum(here, 0.0)

    def step(self, dt: float) -> None:
        """Advance by exactly dt [s], in equal steps of at most the stable one."""
        rows = self.rows
        # Without substeps a longer step is the scene's choice.
        longest = math.inf if self.params.substeps == 1 else self.substep
        steps = max(1, math.ceil(dt / longest * (1.0 - 1e-9)))
        heat = rows.state.heat.copy()
        remaining = steps
        while remaining:
            done = rows.advance(remaining, dt / steps)
            if done < 0:
                point, step = rows.furthest(), dt / steps
                raise diagnostics.failure(point, self.lattice, self.time, rows.skin, step)
            remaining -= done
            self.losses.unchecked += done
            if remaining or rows.needs_lists():
                rows.make_lists()
        rows.state.flow[:] = (heat - rows.state.heat) / dt  # new lists may come with a new state
        self.budget.note()
        if self.losses.unchecked >= CHECKED:
            self._check()

    def check(self) -> None:
        """Refuse a point whose velocity or kinetic energy is not finite."""
        state = self.rows.read("position", "velocity", "kinetic")
        diagnostics.check(state, self.rows.ids, self.rows.owned)

    def _check(self) -> None:
        """Find lost points, broken bonds and missing energy; stop if the scene requires it."""
        self.losses.check(self.time, *self.rows.least_near(), self.rows.intact())
        self.losses.check_energy(self.budget.audit(self.budget.energies()), self.time)
        if self.params.if_point_lost == "stop" and self.losses.broken:
            raise StepError(" ".join(self.warnings().values()))

    def give(self, wanted: Keys) -> Fields:
        """Copy out positions, hotness, energies, and the heat of baths."""
        values: dict[str, Array] = {}
        names = {key.partition(".")[0] for key in wanted}
        if "points" in names:
            mean, relative = self.budget.hotness()
            position, velocity = self.rows.give("position", "velocity")
            values["points.position"], values["points.velocity"] = position, velocity
            values["points.hotness"], values["points.relative_hotness"] = mean, relative
            values["points.temperature"] = self.budget.temperature(mean)
        if "energies" in names:
            values |= self.budget.summary()
        if "baths" in names:
            values |= self.budget.of_baths()
        if "wall_heat" in names:
            values["wall_heat.heat_flow"] = self.rows.all("flow")[self.wall.rows]
        return {key: values[key] for key in wanted}

    def save(self) -> Fields:
        """Copy out all state; the bits of the generator as integers."""
        arrays = self.rows.save()
        arrays["generator"] = arrays["generator"].view(np.int64)
        numbers = np.array(
            [self.started, self.losses.unchecked, self.budget.initial, *self.losses.times]
        )
        return arrays | {"means": self.budget.means.sums.copy(), "rest": numbers}

    def load(self, state: Fields) -> None:
        """Restore a saved state, bit for bit."""
        self.rows.load({**state, "generator": state["generator"].view(np.uint64)})
        started, unchecked, initial, *times = state["rest"].tolist()
        self._begin_averages(started)
        self.budget.means.sums[:] = state["means"]
        self.losses.unchecked, self.budget.initial = int(unchecked), initial
        self.losses.times[:] = times

    def _begin_averages(self, started: float) -> None:
        """Count the begin of averages from when a run was started [s]."""
        self.started, begin = started, started + self.params.averages.begin
        self.rows.average_from(begin)
        self.budget.begin_averages(begin)

    def begin_from(self, state: Fields) -> None:
        """Begin from the state of another run, with the baths and frozen points of this one.

        Averages begin again; a drive keeps its phase.
        """
        begun = {**state, "kinetic": np.zeros_like(state["kinetic"])}
        if len(state["temperature"]) == len(self.bathed.point):
            begun["temperature"] = bath_temperatures(self.bathed, self.params.baths)
        for name in ("velocity", "acceleration"):
            begun[name] = np.array(state[name])
            begun[name][self.built.frozen] = 0.0
        super().begin_from(begun)
        self._begin_averages(self.time)
        self.budget.note()
        self.losses.times[:] = -1.0

    def totals(self) -> Totals:
        """Mass, momentum and energies; internal is that of pairs and tethers."""
        mass = self.lattice.mass
        kinetic, potential = self.budget.energies()
        position, momentum = self.rows.all("position"), mass * self.rows.all("velocity")
        return Totals(
            mass=mass * len(position),
            momentum=momentum.sum(axis=0),
            angular_momentum=np.cross(position, momentum).sum(axis=0),
            kinetic=kinetic,
            internal=potential,
            work=self.budget.outer_work(self.wall.rows),
            dissipated=0.0,
        )

    def warnings(self) -> dict[str, str]:
        """Warn of points that left all others, of broken bonds and of missing energy."""
        return self.losses.warnings(self.lattice)

    def notes(self) -> tuple[str, ...]:
        """Note a strong drive."""
        return diagnostics.drive_notes(self.params.drive, self.lattice)

    def view(self) -> Fields:
        """Points with hotness, temperature and velocity."""
        position, velocity = self.rows.all("position"), self.rows.all("velocity")
        boltzmann, spacing = self.params.boltzmann, self.lattice.spacing
        return view(position, velocity, *self.budget.hotness(), boltzmann, spacing)

    def items(self) -> int:
        """Count the points."""
        return self.lattice.count
