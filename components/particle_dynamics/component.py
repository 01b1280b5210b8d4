"""A lattice of mass points, stepped by velocity Verlet or Yoshida's scheme."""

import math

import numpy as np

from quintet.components.particle_dynamics import MANIFEST, diagnostics
from quintet.components.particle_dynamics.averages import BlockMeans
from quintet.components.particle_dynamics.build import build, initial_state
from quintet.components.particle_dynamics.diagnostics import CHECKED, ROUNDING, Losses
from quintet.components.particle_dynamics.features import bathed, model, wall_of
from quintet.components.particle_dynamics.integrators import LIMIT
from quintet.components.particle_dynamics.kernels.motion import advance, begin
from quintet.components.particle_dynamics.neighbours import Neighbours
from quintet.components.particle_dynamics.params import ParticleLatticeParams
from quintet.components.particle_dynamics.ports import SHOWS
from quintet.components.particle_dynamics.potential import pair_damping
from quintet.components.particle_dynamics.state import DISSIPATED, TIME, WORK
from quintet.components.particle_dynamics.view import view
from quintet.interfaces.component import Array, Component, Fields, Keys, Totals
from quintet.interfaces.errors import StepError


class ParticleLattice(Component):
    """Moves a lattice of points by the forces of pairs, a drive, baths and collisions.

    Parameters
    ----------
    params : ParticleLatticeParams
        Points, forces, and what holds and heats them.
    """

    Params: type[ParticleLatticeParams] = ParticleLatticeParams
    manifest = MANIFEST
    shows = SHOWS
    compiles = True

    def __init__(self, params: ParticleLatticeParams) -> None:
        self.params, (self.takes, self.gives) = params, self.ports_of(params)
        self.lattice, baths = params.lattice, params.baths
        self.built = built = build(params)
        in_baths = bathed(built.start, baths)
        self.model = model(params, built, in_baths)
        damping = pair_damping(params.damping, self.lattice.spacing)
        self.forces = built.law, damping, built.period
        self.wall = wall_of(in_baths, baths)
        temperature = np.array([bath.temperature for bath in baths], float)[in_baths.bath]
        self.state = initial_state(params, built.start, self.model, temperature)
        stiffest = in_baths.tether.max(initial=0.0)
        frequency = math.sqrt(built.frequency**2 + stiffest / self.lattice.mass)  # rad/s
        self.substep = params.courant * (LIMIT[params.integrator] / frequency)  # s
        lowest = np.array(self.lattice.lowest)
        self.neighbours = Neighbours(built.law.cutoff2, lowest, built.period)
        self.neighbours.rebuild(self.state.listed)
        self.means = BlockMeans(1 + len(baths), params.averages.begin, params.averages.block)
        self.losses = Losses()
        self.flow = np.zeros(len(self.wall))  # W, out of the wall in the last step
        begin(self.model, self.state, self.neighbours.pairs, *self.forces)
        self.initial = sum(self._energies())  # J
        speed = self.lattice.spacing * frequency
        self.unit = self.lattice.mass * speed * speed  # J
        self.means.add(0.0, self._integrals())

    def describe(self) -> Fields:
        """State where the points of the wall are."""
        if not len(self.wall):
            return {}
        return {"wall_heat.position": self.model.bathed.rest[self.wall]}

    def stable_dt(self) -> float:
        """Return the length of all substeps."""
        return self.params.substeps * self.substep

    def take(self, fields: Fields) -> None:
        """Set the temperatures [K] of the wall."""
        temperature = fields.get("wall_temperature.temperature")
        if temperature is not None:
            self.state.temperature[self.wall] = np.maximum(temperature, 0.0)

    def step(self, dt: float) -> None:
        """Advance by exactly dt [s], in equal steps of at most the stable one."""
        state, params, neighbours = self.state, self.params, self.neighbours
        # Without substeps a longer step is the scene's choice.
        longest = math.inf if params.substeps == 1 else self.substep
        steps = max(1, math.ceil(dt / longest * (1.0 - 1e-9)))
        heat = state.heat[self.wall]
        remaining = steps
        while remaining:
            done = advance(
                remaining, dt / steps, neighbours.skin, params.averages.begin, params.boltzmann,
                self.model, state, neighbours.pairs, *self.forces,
            )  # fmt: skip
            if done < 0:
                raise diagnostics.failure(state, self.built.start, neighbours.skin, dt / steps)
            remaining -= done
            self.losses.unchecked += done
            if remaining or neighbours.needs_rebuild(state.position, state.listed):
                state.listed[:] = state.position
                neighbours.rebuild(state.listed)
        self.flow[:] = (heat - state.heat[self.wall]) / dt
        self.means.add(float(state.energies[TIME]), self._integrals())
        if self.losses.unchecked >= CHECKED:
            self._check()

    def _check(self) -> None:
        """Find lost points, broken bonds and missing energy; stop if the scene requires it."""
        self.losses.check(self.state, self.neighbours.pairs, self.built, self.lattice.spacing)
        self.losses.check_energy(self._audit(self._energies()), float(self.state.energies[TIME]))
        if self.params.if_point_lost == "stop" and self.losses.broken:
            raise StepError(" ".join(self.warnings().values()))

    def _energies(self) -> diagnostics.Energies:
        return diagnostics.energies(self.state, self.neighbours.pairs, self.built, self.model)

    def _audit(self, energies: diagnostics.Energies) -> float:
        """Share of the energy put in that the balance lacks."""
        bath, baths = self.model.bathed.bath, len(self.params.baths)
        heat = diagnostics.heat_of_baths(self.state, bath, baths)
        return diagnostics.audit(energies, self.initial, self.state, heat, self.unit)

    def _integrals(self) -> Array:
        """Temperature [K s] of points that are not frozen, and heat of each bath [J]."""
        free, bath = len(self.built.start) - len(self.model.frozen), self.model.bathed.bath
        baths = len(self.params.baths)
        temperature = self.state.kinetic.sum() / (1.5 * self.params.boltzmann * max(free, 1))
        return np.concatenate([[temperature], diagnostics.heat_of_baths(self.state, bath, baths)])

    def _hotness(self) -> tuple[Array, Array]:
        since = float(self.state.energies[TIME]) - self.params.averages.begin
        return diagnostics.hotness(self.state.kinetic, since, ROUNDING * self.unit)

    def give(self, wanted: Keys) -> Fields:
        """Copy out positions, hotness, energies, and the heat of baths."""
        values: dict[str, Array] = {}
        names = {key.partition(".")[0] for key in wanted}
        if "points" in names:
            mean, relative = self._hotness()
            values["points.position"] = self.state.position.copy()
            values["points.velocity"] = self.state.velocity.copy()
            values["points.hotness"], values["points.relative_hotness"] = mean, relative
            values["points.temperature"] = mean / (1.5 * self.params.boltzmann)
        if "energies" in names:
            values |= self._summary()
        if "baths" in names:
            values |= self._baths()
        if "wall_heat" in names:
            values["wall_heat.heat_flow"] = self.flow.copy()
        return {key: values[key] for key in wanted}

    def _summary(self) -> dict[str, Array]:
        energies, time = self.state.energies, float(self.state.energies[TIME])
        kinetic, potential = now = self._energies()
        built, spacing = self.built, self.lattice.spacing
        numbers = {
            "kinetic": kinetic,
            "potential": potential,
            "dissipated": energies[DISSIPATED],
            "work": energies[WORK],
            "heat": self.state.heat.sum(),
            "audit": self._audit(now),
            "intact": diagnostics.intact(self.state.position, built.bonds, spacing, built.period),
            "temperature": self.means.means(time, self._integrals())[0],
            "temperature_error": self.means.errors()[0],
        }
        return {f"energies.{name}": np.array([number]) for name, number in numbers.items()}

    def _baths(self) -> dict[str, Array]:
        in_baths, time = self.model.bathed, float(self.state.energies[TIME])
        mean, count = self._hotness()[0], len(self.params.baths)
        energy = np.bincount(in_baths.bath, mean[in_baths.point], count)
        return {
            "baths.temperature": energy
            / np.bincount(in_baths.bath)
            / (1.5 * self.params.boltzmann),
            "baths.heat_flow": self.means.means(time, self._integrals())[1:],
            "baths.heat_flow_error": self.means.errors()[1:],
        }

    def save(self) -> Fields:
        """Copy out all state; the bits of the generator as integers."""
        arrays = {name: array.copy() for name, array in self.state._asdict().items()}
        arrays["generator"] = arrays["generator"].view(np.int64)
        numbers = np.array([self.losses.unchecked, self.initial, *self.losses.times])
        return arrays | {"flow": self.flow.copy(), "means": self.means.sums.copy(), "rest": numbers}

    def load(self, state: Fields) -> None:
        """Restore a saved state, bit for bit."""
        for name, array in self.state._asdict().items():
            array[:] = state[name].view(np.uint64) if name == "generator" else state[name]
        self.flow[:], self.means.sums[:] = state["flow"], state["means"]
        self.losses.unchecked, self.initial = int(state["rest"][0]), float(state["rest"][1])
        self.losses.times[:] = state["rest"][2:]
        self.neighbours.rebuild(self.state.listed)

    def totals(self) -> Totals:
        """Mass, momentum and energies; internal is that of pairs and tethers."""
        mass, state = self.lattice.mass, self.state
        kinetic, potential = self._energies()
        momentum = mass * state.velocity
        return Totals(
            mass=mass * len(state.position),
            momentum=momentum.sum(axis=0),
            angular_momentum=np.cross(state.position, momentum).sum(axis=0),
            kinetic=kinetic,
            internal=potential,
            work=diagnostics.outer_work(state, self.wall),
        )

    def warnings(self) -> dict[str, str]:
        """Warn of points that left all others, of broken bonds and of missing energy."""
        return self.losses.warnings(self.built.start)

    def notes(self) -> tuple[str, ...]:
        """Note a strong drive."""
        return diagnostics.drive_notes(self.params.drive, self.lattice)

    def view(self) -> Fields:
        """Points with hotness, temperature and velocity."""
        state, boltzmann = self.state, self.params.boltzmann
        spacing = self.lattice.spacing
        return view(state.position, state.velocity, *self._hotness(), boltzmann, spacing)

    def items(self) -> int:
        """Count the points."""
        return len(self.state.position)
