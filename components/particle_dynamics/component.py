"""A lattice of mass points, stepped by velocity Verlet or Yoshida's scheme."""

import math

import numpy as np

from quintet.components.particle_dynamics import MANIFEST, diagnostics
from quintet.components.particle_dynamics.averages import BlockMeans
from quintet.components.particle_dynamics.build import build, initial_state
from quintet.components.particle_dynamics.diagnostics import AUDITED, CHECKED, ROUNDING, Losses
from quintet.components.particle_dynamics.features import bathed, model, rows_of, wall_of
from quintet.components.particle_dynamics.integrators import LIMIT
from quintet.components.particle_dynamics.params import ParticleLatticeParams
from quintet.components.particle_dynamics.ports import SHOWS
from quintet.components.particle_dynamics.state import TIME, WORK, State
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
        With a communicator of several ranks each steps its share of the points.
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
        temperature = np.array([bath.temperature for bath in baths], float)[self.bathed.bath]
        state = initial_state(params, built.start, whole, temperature)
        self.rows = rows_of(resources, params, built, state, whole)
        self.built = self.rows.reduced(built)
        self.wall = wall_of(self.bathed, baths, self.rows.bathed)
        stiffest = self.bathed.tether.max(initial=0.0)
        frequency = math.sqrt(built.frequency**2 + stiffest / self.lattice.mass)  # rad/s
        self.substep = params.courant * (LIMIT[params.integrator] / frequency)  # s
        self.means = BlockMeans(1 + len(baths), params.averages.begin, params.averages.block)
        self.losses = Losses()
        self.initial = sum(self._energies())  # J
        speed = self.lattice.spacing * frequency
        self.unit = self.lattice.mass * speed * speed  # J
        self.free = self.lattice.count - len(built.frozen)  # points
        self.means.add(0.0, self._integrals())

    @property
    def state(self) -> State:
        """What moves: of one rank all points, of several its points and copies of others."""
        return self.rows.state

    @property
    def time(self) -> float:
        """Time [s] of the present state."""
        return float(self.state.energies[TIME])

    def describe(self) -> Fields:
        """State where the points of the wall are."""
        if not len(self.wall.rows):
            return {}
        return {"wall_heat.position": self.bathed.rest[self.wall.rows]}

    def stable_dt(self) -> float:
        """Return the length of all substeps."""
        return self.params.substeps * self.substep

    def take(self, fields: Fields) -> None:
        """Set the temperatures [K] of the wall."""
        temperature = fields.get("wall_temperature.temperature")
        if temperature is not None:
            here = temperature[self.wall.of_wall]
            self.state.temperature[self.wall.here] = np.maximum(here, 0.0)

    def step(self, dt: float) -> None:
        """Advance by exactly dt [s], in equal steps of at most the stable one."""
        rows = self.rows
        # Without substeps a longer step is the scene's choice.
        longest = math.inf if self.params.substeps == 1 else self.substep
        steps = max(1, math.ceil(dt / longest * (1.0 - 1e-9)))
        heat = self.state.heat.copy()
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
        self.state.flow[:] = (heat - self.state.heat) / dt
        if self.means.needs(self.time):
            self.means.add(self.time, self._integrals())
        if self.losses.unchecked >= CHECKED:
            self._check()

    def _check(self) -> None:
        """Find lost points, broken bonds and missing energy; stop if the scene requires it."""
        self.losses.check(self.time, *self.rows.least_near(), self.rows.intact())
        self.losses.check_energy(self._audit(self._energies()), self.time)
        if self.params.if_point_lost == "stop" and self.losses.broken:
            raise StepError(" ".join(self.warnings().values()))

    def _energies(self) -> diagnostics.Energies:
        velocity, rows = self.rows.all("velocity"), self.rows
        mass = self.lattice.mass
        return diagnostics.energies(mass, velocity, rows.pair_energies(), rows.tether_energies())

    def _balance(self) -> diagnostics.Balance:
        dissipated = float(self.rows.all("dissipated").sum())
        work = float(self.rows.all("energies")[WORK])
        return diagnostics.Balance(work, self.rows.all("heat"), dissipated)

    def _audit(self, energies: diagnostics.Energies) -> float:
        """Share of the energy put in that the balance lacks."""
        balance, least = self._balance(), AUDITED * self.lattice.count * self.unit
        heat = diagnostics.heat_of_baths(balance.heat, self.bathed.bath, len(self.params.baths))
        return diagnostics.audit(energies, self.initial, balance, heat, least)

    def _integrals(self) -> Array:
        """Temperature [K s] of points that are not frozen, and heat of each bath [J]."""
        bath, baths = self.bathed.bath, len(self.params.baths)
        kinetic = self.rows.all("kinetic").sum()
        temperature = kinetic / (1.5 * self.params.boltzmann * max(self.free, 1))
        heat = diagnostics.heat_of_baths(self.rows.all("heat"), bath, baths)
        return np.concatenate([[temperature], heat])

    def _hotness(self) -> tuple[Array, Array]:
        since = self.time - self.params.averages.begin
        return diagnostics.hotness(self.rows.all("kinetic"), since, ROUNDING * self.unit)

    def give(self, wanted: Keys) -> Fields:
        """Copy out positions, hotness, energies, and the heat of baths."""
        values: dict[str, Array] = {}
        names = {key.partition(".")[0] for key in wanted}
        if "points" in names:
            mean, relative = self._hotness()
            values["points.position"] = self.rows.all("position").copy()
            values["points.velocity"] = self.rows.all("velocity").copy()
            values["points.hotness"], values["points.relative_hotness"] = mean, relative
            values["points.temperature"] = mean / (1.5 * self.params.boltzmann)
        if "energies" in names:
            values |= self._summary()
        if "baths" in names:
            values |= self._baths()
        if "wall_heat" in names:
            values["wall_heat.heat_flow"] = self.rows.all("flow")[self.wall.rows]
        return {key: values[key] for key in wanted}

    def _summary(self) -> dict[str, Array]:
        kinetic, potential = now = self._energies()
        balance = self._balance()
        numbers = {
            "kinetic": kinetic,
            "potential": potential,
            "dissipated": balance.dissipated,
            "work": balance.work,
            "heat": balance.heat.sum(),
            "audit": self._audit(now),
            "intact": self.rows.intact(),
            "temperature": self.means.means(self.time, self._integrals())[0],
            "temperature_error": self.means.errors()[0],
        }
        return {f"energies.{name}": np.array([number]) for name, number in numbers.items()}

    def _baths(self) -> dict[str, Array]:
        in_baths, mean = self.bathed, self._hotness()[0]
        energy = np.bincount(in_baths.bath, mean[in_baths.point], len(self.params.baths))
        return {
            "baths.temperature": energy
            / np.bincount(in_baths.bath)
            / (1.5 * self.params.boltzmann),
            "baths.heat_flow": self.means.means(self.time, self._integrals())[1:],
            "baths.heat_flow_error": self.means.errors()[1:],
        }

    def save(self) -> Fields:
        """Copy out all state; the bits of the generator as integers."""
        arrays = self.rows.save()
        arrays["generator"] = arrays["generator"].view(np.int64)
        numbers = np.array([self.losses.unchecked, self.initial, *self.losses.times])
        return arrays | {"means": self.means.sums.copy(), "rest": numbers}

    def load(self, state: Fields) -> None:
        """Restore a saved state, bit for bit."""
        self.rows.load({**state, "generator": state["generator"].view(np.uint64)})
        self.means.sums[:] = state["means"]
        self.losses.unchecked, self.initial = int(state["rest"][0]), float(state["rest"][1])
        self.losses.times[:] = state["rest"][2:]

    def totals(self) -> Totals:
        """Mass, momentum and energies; internal is that of pairs and tethers."""
        mass = self.lattice.mass
        kinetic, potential = self._energies()
        position, momentum = self.rows.all("position"), mass * self.rows.all("velocity")
        return Totals(
            mass=mass * len(position),
            momentum=momentum.sum(axis=0),
            angular_momentum=np.cross(position, momentum).sum(axis=0),
            kinetic=kinetic,
            internal=potential,
            work=diagnostics.outer_work(self._balance(), self.wall.rows),
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
        return view(position, velocity, *self._hotness(), boltzmann, spacing)

    def items(self) -> int:
        """Count the points."""
        return self.lattice.count
