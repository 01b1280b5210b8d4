"""A lattice of mass points, stepped by velocity Verlet or Yoshida's scheme."""

import math

import numpy as np

from quintet.components.particle_dynamics import MANIFEST
from quintet.components.particle_dynamics.averages import BlockMeans
from quintet.components.particle_dynamics.build import CLOSE, build, initial_state
from quintet.components.particle_dynamics.integrators import LIMIT
from quintet.components.particle_dynamics.kernels.forces import (
    Pairs,
    count_intact,
    count_near,
    sum_energies,
)
from quintet.components.particle_dynamics.kernels.motion import EARLY, advance, begin
from quintet.components.particle_dynamics.neighbours import pairs_within
from quintet.components.particle_dynamics.params import ParticleLatticeParams
from quintet.components.particle_dynamics.ports import SHOWS
from quintet.components.particle_dynamics.state import DISSIPATED, TIME, WORK
from quintet.components.particle_dynamics.view import hotness, view
from quintet.components.shared.search.verlet_list import furthest
from quintet.interfaces.component import (
    Array,
    Component,
    Fields,
    Keys,
    Totals,
    fields_of,
)
from quintet.interfaces.errors import StepError

SKIN = 0.1  # of the cut-off
CHECKED = 20  # steps between two looks for lost points
INTACT = 0.95  # share of the bonds below which the lattice is broken
MISSING = 0.01  # of the energy put in, beyond which the audit is told
# Of m a² ω², for each point: energies that are rounding, and the least that an audit is told of.
ROUNDING, AUDITED = 1e-20, 1e-9


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

    def __init__(self, params: ParticleLatticeParams) -> None:
        self.params, (self.takes, self.gives) = params, self.ports_of(params)
        self.lattice = params.lattice
        self.built = build(params)
        self.state = initial_state(params, self.built)
        self.skin = SKIN * math.sqrt(self.built.law.cutoff2)  # m
        average = params.averages
        self.means = BlockMeans(1 + len(params.baths), average.begin, average.block)
        self.unchecked = 0  # steps since points were last looked for
        # When a point was lost, bonds were broken, energy was missing [s]; which point. -1: not.
        self.told = np.full(4, -1.0)
        self.flow = np.zeros(len(self.built.wall))  # W, out of the wall in the last step
        self._list()
        model, law = self.built.model, self.built.law
        begin(model, self.state, self.pairs, law, self.built.damping, self.built.period)
        self.initial = sum(self._energies())  # J
        speed = self.lattice.spacing * self.built.frequency
        self.unit = self.lattice.mass * speed * speed  # J
        self.means.add(0.0, self._integrals())

    def describe(self) -> Fields:
        """State where the points of the wall are."""
        if not len(self.built.wall):
            return {}
        return {"wall_heat.position": self.built.model.bathed.rest[self.built.wall]}

    def prepare(self, fields: Fields) -> None:
        """Compile all kernels: try one step, and come back."""
        kept = self.save()
        self.take(fields)
        self.step(self._step())
        self.give(frozenset(fields_of(self.gives)))
        self.load(kept)

    def stable_dt(self) -> float:
        """Return so many steps at once as are asked for."""
        return self.params.substeps * self._step()

    def _step(self) -> float:
        """Share [s] of the greatest step that the highest frequency allows."""
        limit = LIMIT[self.params.integrator] / self.built.frequency
        return self.params.courant * limit

    def take(self, fields: Fields) -> None:
        """Set the temperatures [K] of the wall."""
        told = fields.get("wall_temperature.temperature")
        if told is not None:
            self.state.temperature[self.built.wall] = np.maximum(told, 0.0)

    def step(self, dt: float) -> None:
        """Advance by exactly dt [s], in equal steps of at most the stable one."""
        state, built, params = self.state, self.built, self.params
        steps = max(1, math.ceil(dt / self._longest() * (1.0 - 1e-9)))
        heat = state.heat[built.wall]
        done = 0
        while done < steps:
            made = advance(
                steps - done, dt / steps, self.skin, params.averages.begin, params.boltzmann,
                built.model, state, self.pairs, built.law, built.damping, built.period,
            )  # fmt: skip
            if made < 0:
                raise self._failure(dt / steps)
            done += made
            self.unchecked += made
            if done < steps or self._is_outworn():
                self._list()
        self.flow[:] = (heat - state.heat[built.wall]) / dt
        self.means.add(float(state.energies[TIME]), self._integrals())
        if self.unchecked >= CHECKED:
            self._look_for_losses()

    def _longest(self) -> float:
        """Longest step [s] that is made; a single longer one is what is asked for."""
        return math.inf if self.params.substeps == 1 else self._step()

    def _is_outworn(self) -> bool:
        moved = furthest(self.state.position, self.state.listed)
        return bool(2.0 * moved > EARLY * self.skin)

    def _list(self) -> None:
        """Make the neighbour lists anew."""
        self.state.listed[:] = self.state.position
        self.pairs = self._pairs_around(self.state.listed)

    def _pairs_around(self, places: Array) -> Pairs:
        reach = math.sqrt(self.built.law.cutoff2) + self.skin
        lowest = np.array(self.lattice.lowest)
        return pairs_within(reach, places, lowest, self.built.period)

    def _failure(self, dt: float) -> StepError:
        moved = ((self.state.position - self.state.listed) ** 2).sum(axis=1)
        point = int(np.argmax(np.where(np.isfinite(moved), moved, np.inf)))
        return StepError(
            f"point {point}, at {self.built.start[point]} m at the start: it must move by less "
            f"than {0.2 * self.skin:.3g} m in a step of {dt:.3g} s, and did not, at "
            f"{self.state.energies[TIME]:g} s. Take a smaller courant, or drive and heat less."
        )

    def _look_for_losses(self) -> None:
        """Find points that left all others behind, broken bonds, and energy that is missing."""
        state, built = self.state, self.built
        self.unchecked = 0
        time = float(state.energies[TIME])
        near = np.empty(len(state.position), np.int64)
        count_near(state.position, self.pairs, built.law.cutoff2, built.period, near)
        if self.told[0] < 0.0 and (near == 0).any():
            self.told[0], self.told[3] = time, int(np.argmin(near))
        if self.told[1] < 0.0 and self._intact() < INTACT:
            self.told[1] = time
        if self.told[2] < 0.0 and abs(self._audit(*self._energies())) > MISSING:
            self.told[2] = time
        if self.params.if_point_lost == "stop" and (self.told[:2] >= 0.0).any():
            raise StepError(" ".join(self.warnings().values()))

    def warnings(self) -> dict[str, str]:
        """Warn of points that left all others, of broken bonds and of missing energy."""
        lost, broken, missing, point = self.told.tolist()
        found = {}
        if lost >= 0.0:
            place = self.built.start[int(point)]
            found["lost point"] = (
                f"point {int(point)}, at {place} m at the start, has left all others behind, at "
                f"{lost:g} s: drive or heat less, or damp more."
            )
        if broken >= 0.0:
            found["broken bonds"] = (
                f"less than {INTACT:.0%} of the bonds between nearest points are intact, at "
                f"{broken:g} s: the lattice has broken up. Drive or heat less, or damp more."
            )
        if missing >= 0.0:
            found["energy"] = (
                f"the energy audit lacks more than {MISSING:.0%} of what was put in, at "
                f"{missing:g} s: take a smaller courant."
            )
        return found

    def notes(self) -> tuple[str, ...]:
        """Tell of a strong drive."""
        drive, spacing = self.params.drive, self.lattice.spacing
        strong = []
        if drive is not None and drive.amplitude >= 0.1 * spacing * CLOSE:
            strong.append(
                f"drive: an amplitude of {drive.amplitude / spacing:.2g} spacings breaks most "
                "lattices up; 0.05 to 0.08 do not."
            )
        return tuple(strong)

    def _intact(self) -> float:
        bonds, spacing = self.built.bonds, self.lattice.spacing
        found = count_intact(self.state.position, bonds, spacing, self.built.period)
        return float(found / max(len(bonds), 1))

    def _energies(self) -> tuple[float, float]:
        """Kinetic and potential energy [J]."""
        state, built = self.state, self.built
        bathed = built.model.bathed
        kinetic = 0.5 * self.lattice.mass * float((state.velocity**2).sum())
        away = ((state.position[bathed.point] - bathed.rest) ** 2).sum(axis=1)
        potential = sum_energies(state.position, self.pairs, built.law, built.period)
        return kinetic, float(potential + 0.5 * (bathed.tether * away).sum())

    def _audit(self, kinetic: float, potential: float) -> float:
        """Energy that is missing over what was put in since the start, of energies [J] now."""
        state = self.state
        put_in = float(state.energies[WORK] + state.heat.sum())
        gained = kinetic + potential - self.initial + float(state.energies[DISSIPATED])
        baths = np.bincount(self.built.model.bathed.bath, state.heat, len(self.params.baths))
        size = abs(float(state.energies[WORK])) + float(np.abs(baths).sum())
        size = max(size, kinetic, AUDITED * len(state.position) * self.unit)
        return (gained - put_in) / size

    def _outer_work(self) -> float:
        """Energy [J] of drive, damping and baths so far, but for a wall that a partner heats."""
        state, wall = self.state, self.built.wall
        heat = float(state.heat.sum() - state.heat[wall].sum())
        return float(state.energies[WORK] - state.energies[DISSIPATED]) + heat

    def _integrals(self) -> Array:
        """Temperature [K s] of what is free to move, and heat of each bath [J], since the start."""
        free = len(self.built.start) - len(self.built.model.frozen)
        temperature = self.state.kinetic.sum() / (1.5 * self.params.boltzmann * max(free, 1))
        return np.concatenate([[temperature], self._heat_of_baths()])

    def _heat_of_baths(self) -> Array:
        bath, count = self.built.model.bathed.bath, len(self.params.baths)
        return np.bincount(bath, self.state.heat, count).astype(np.float64)[:count]

    def _since(self) -> float:
        """How long [s] kinetic energies have been averaged."""
        return float(self.state.energies[TIME]) - self.params.averages.begin

    def give(self, wanted: Keys) -> Fields:
        """Copy out places, hotness, energies, and what flows from baths."""
        given: dict[str, Array] = {}
        names = {key.partition(".")[0] for key in wanted}
        if "points" in names:
            mean, relative = hotness(self.state, self._since(), ROUNDING * self.unit)
            given["points.position"] = self.state.position.copy()
            given["points.velocity"] = self.state.velocity.copy()
            given["points.hotness"], given["points.relative_hotness"] = mean, relative
            given["points.temperature"] = mean / (1.5 * self.params.boltzmann)
        if "energies" in names:
            given |= self._summary()
        if "baths" in names:
            given |= self._baths()
        if "wall_heat" in names:
            given["wall_heat.heat_flow"] = self.flow.copy()
        return {key: given[key] for key in wanted}

    def _summary(self) -> dict[str, Array]:
        kinetic, potential = self._energies()
        energies, time = self.state.energies, float(self.state.energies[TIME])
        numbers = {
            "kinetic": kinetic,
            "potential": potential,
            "dissipated": energies[DISSIPATED],
            "work": energies[WORK],
            "heat": self.state.heat.sum(),
            "audit": self._audit(kinetic, potential),
            "intact": self._intact(),
            "temperature": self.means.means(time, self._integrals())[0],
            "temperature_error": self.means.errors()[0],
        }
        return {f"energies.{name}": np.array([one]) for name, one in numbers.items()}

    def _baths(self) -> dict[str, Array]:
        bathed, since = self.built.model.bathed, self._since()
        mean, _ = hotness(self.state, since, ROUNDING * self.unit)
        count = len(self.params.baths)
        own = np.bincount(bathed.bath, mean[bathed.point], count) / np.bincount(bathed.bath)
        time = float(self.state.energies[TIME])
        return {
            "baths.temperature": own / (1.5 * self.params.boltzmann),
            "baths.heat_flow": self.means.means(time, self._integrals())[1:],
            "baths.heat_flow_error": self.means.errors()[1:],
        }

    def save(self) -> Fields:
        """Copy out all state; of the generator the bits, as whole numbers."""
        kept = {name: array.copy() for name, array in self.state._asdict().items()}
        kept["generator"] = kept["generator"].view(np.int64)
        numbers = np.array([self.unchecked, self.initial, *self.told])
        return kept | {"flow": self.flow.copy(), "means": self.means.kept.copy(), "rest": numbers}

    def load(self, state: Fields) -> None:
        """Come back to a saved state, bit for bit."""
        for name, array in self.state._asdict().items():
            array[:] = state[name].view(np.uint64) if name == "generator" else state[name]
        self.flow[:], self.means.kept[:] = state["flow"], state["means"]
        self.unchecked, self.initial = int(state["rest"][0]), float(state["rest"][1])
        self.told[:] = state["rest"][2:]
        self.pairs = self._pairs_around(self.state.listed)

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
            work=self._outer_work(),
        )

    def view(self) -> Fields:
        """Points with hotness, temperature and velocity."""
        spacing, boltzmann = self.lattice.spacing, self.params.boltzmann
        return view(self.state, self._since(), ROUNDING * self.unit, boltzmann, spacing)

    def items(self) -> int:
        """Count the points."""
        return len(self.state.position)
