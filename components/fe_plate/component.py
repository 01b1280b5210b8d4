"""A structure of finite elements, stepped by velocity Verlet."""

import math
from dataclasses import astuple, dataclass

import numpy as np

from quintet.components.fe_plate import MANIFEST
from quintet.components.fe_plate.build import initial_state, structure
from quintet.components.fe_plate.gauges import (
    at_nodes,
    in_elements,
    measured,
    of_element_sets,
    of_node_sets,
    of_parts,
    wanted_of,
)
from quintet.components.fe_plate.judgement import EVERY, Judge, hourglass_weights
from quintet.components.fe_plate.kernels.blocks import ENERGY
from quintet.components.fe_plate.kernels.eight_points import step_eight_points
from quintet.components.fe_plate.kernels.elements import step_elements
from quintet.components.fe_plate.kernels.flow import HUGE
from quintet.components.fe_plate.kernels.nodes import (
    kick,
    kick_and_drift,
    kinetic_energy,
    sum_parted,
)
from quintet.components.fe_plate.laws import add_pressure
from quintet.components.fe_plate.params import FePlateParams
from quintet.components.fe_plate.points import integration_notes, points_of
from quintet.components.fe_plate.ports import SHOWS
from quintet.components.fe_plate.state import Array, Resistance, Whole
from quintet.components.fe_plate.supports import supports
from quintet.components.fe_plate.view import view
from quintet.components.shared.threads import Team
from quintet.interfaces.component import (
    ONE_THREAD,
    Component,
    Fields,
    Keys,
    Resources,
    Totals,
)
from quintet.interfaces.errors import StepError

FEWEST = 128  # blocks that are worth handing to another thread
SHARES = 4  # of each thread: where they meet, forces are summed once more
SQUASHED = 4.0  # least steps in which what meets a wall moves by an element
SMALLEST = 0.02  # of an element's volume at the start: below it, it has been turned inside out
Stepped = tuple[float, float, int]  # largest step [s], least volume over the first one, of which
POSITION, VELOCITY = "faces.position", "faces.velocity"
MEAN_VELOCITY, ACTIVE = "node_glue.velocity", "face_activity.active"


@dataclass(slots=True)
class Accumulated:
    """What a run has added up."""

    time: float = 0.0  # s
    work: float = 0.0  # J, of the loads
    outside: float = 0.0  # J, of it that of pressures; less what mass damping took
    damped: float = 0.0  # J, that mass damping took
    hung: float = 0.0  # J, that came with what hangs on the nodes
    steps: int = 0


class FePlate(Component):
    """Moves a structure under the loads it is given, pressures, gravity and rigid walls.

    A class of one's own may derive from it, with a `Params` that derives from `FePlateParams`: in
    a scene it is a kind, ``module:Class``, with all ports of this one.

    Parameters
    ----------
    params : FePlateParams
        Parts, supports, loads.
    """

    Params: type[FePlateParams] = FePlateParams

    manifest = MANIFEST
    shows = SHOWS

    def __init__(self, params: FePlateParams, resources: Resources = ONE_THREAD) -> None:
        self.params, (self.takes, self.gives) = params, self.ports_of(params)
        self.team = Team(resources.threads, FEWEST, SHARES)
        built = structure(params, self.team.ends)
        self.mesh, self.model, self.mass = built.mesh, built.model, built.mass
        self.laws, self.first, self.pressed = built.laws, built.first, built.pressed
        self.parted = built.parted
        self.places, self.volume = built.places, built.volume
        self.element_mass = (
            built.volume * np.array([one.density for one in self.laws])[self.mesh.part]
        )
        self.measured = measured(self.mesh, params.gauges)
        self.faces = self.mesh.side[built.coupled]  # (f, 4) nodes
        self.owner = self.mesh.owner[built.coupled]  # (f,) elements
        self.surface = np.unique(self.faces[self.faces >= 0])  # nodes
        own = np.searchsorted(self.surface, self.faces)
        self.corner = np.where(self.faces < 0, -1, own)  # (f, 4) among these; -1 ends an edge
        self.state = initial_state(params, built)
        self.resistance = Resistance(
            params.hourglass,
            params.viscosity_linear,
            params.viscosity_quadratic,
            params.stiffness_damping,
        )
        # Compiled where it is asked for alone.
        self.kernel = _one_point if points_of(params) == 1 else _eight_points
        self.loads = np.zeros((len(self.surface), 3))  # N, of partners
        self.hung = np.zeros(len(self.surface))  # kg, mass that hangs on the nodes
        self.glued = False  # whether particles hang on it
        self.early = np.zeros((len(self.surface), 3))  # m/s, that velocities at a step's end lack
        self.accumulated = Accumulated()
        self.shortest = self._shortest()  # m
        self.bound = self._write_forces(0.0)  # s
        self.judge = Judge(params, self.places, self.element_mass, built, self._hourglass())

    def _hourglass(self) -> Array:
        """Energy (e,) that elements lack over that of the springs of their patterns."""
        if not len(self.state.springs):
            return np.zeros(len(self.mesh.corner))
        return hourglass_weights(self.mesh, self.laws, self.params.hourglass)

    def _shortest(self) -> float:
        """Least edge [m] of cubes, or squares, as large as the elements."""
        return float(self.volume.min() ** (1.0 / self.params.dimensions))

    def describe(self) -> Fields:
        """State where the nodes of the surface are, and the corners of its faces."""
        mesh = {
            "start": self.mesh.node[self.surface],
            "corner": self.corner.astype(np.float64),
        }
        if self.params.dimensions == 2:
            mesh["dimensions"] = np.array([2.0])
        return {
            f"{port}.{key}": one.copy()
            for port in ("faces", "node_glue")
            for key, one in mesh.items()
        }

    def bind(self, static: Fields, joined: Keys) -> None:
        """Let mass hang on the nodes."""
        self.glued = "node_glue" in joined
        # Glued particles push in the first half of a step alone: the link has that balance.
        self.judge.closed = not self.glued
        if "node_load.added_mass" in static:
            self._hang(static["node_load.added_mass"])

    def _hang(self, mass: Array) -> None:
        """Let a mass (nodes of the surface,) kg hang on the nodes, in the place of what did.

        What is let go goes on with the mean velocity of the last step, as its nodes gave it out.
        """
        rows, before = self.surface, self.mass[self.surface] + self.hung
        whole = self.mass[rows] + mass
        mean = self.state.mean_velocity[rows]
        rest = (before / whole)[:, None] * (self.state.velocity[rows] - mean)
        changed = whole != before
        energy = kinetic_energy(self.model, self.state)
        self.state.velocity[rows[changed]] = (mean + rest)[changed]
        self.model.inverse_mass[rows] = 1.0 / whole
        self.accumulated.hung += kinetic_energy(self.model, self.state) - energy
        self.hung = np.array(mass)

    def stable_dt(self) -> float:
        """Return a share of the proven bound."""
        return self.params.courant * self.bound

    def take(self, fields: Fields) -> None:
        """Set the forces [N] on the surface's nodes, without them none; and what hangs on them."""
        force = fields.get("node_load.force")
        self.loads[:] = 0.0 if force is None else force
        added = fields.get("node_mass.added")
        if added is not None and not np.array_equal(added, self.hung):
            self._hang(added)

    def step(self, dt: float) -> None:
        """Advance by exactly dt [s]: half kick, drift, stresses, half kick."""
        self._write_loads()
        if self.glued:
            self._hasten(dt)
        total, damping = self.accumulated, self.params.mass_damping
        kept = math.exp(-0.5 * damping * dt)  # of the kinetic energy, in either half
        if total.steps % EVERY == 0:
            self._note_energies()
        total.steps += 1
        if damping:
            self._note_damped((1.0 - kept) * kinetic_energy(self.model, self.state))
        done = kick_and_drift(self.model, self.state, dt, damping)
        total.time += dt
        total.work += done
        if self.params.pressures:
            mean = self.state.mean_velocity[self.surface]
            total.outside += done - dt * float((mean * self.loads).sum())
        self.bound = self._write_forces(dt)
        if damping:
            self._note_damped((1.0 / kept - 1.0) * kinetic_energy(self.model, self.state))
        if self.glued:
            self.state.velocity[self.surface] -= self.early

    def _note_damped(self, energy: float) -> None:
        """Take down an energy [J] that mass damping took."""
        self.accumulated.damped += energy
        self.accumulated.outside -= energy

    def _note_energies(self) -> None:
        """Take down the energies of the state between two steps, and what was done on it."""
        total = self.accumulated
        kinetic, potential = self._motion()
        done = total.work + total.hung - total.damped + float(self.state.wall_work.sum())
        self.judge.note(self.state, kinetic, potential, done, total.steps == 0)

    def _hasten(self, dt: float) -> None:
        """Let the loads of partners act in the step's first half, and not in its second one.

        Forces of glued particles are those where a step begins: felt half a step late they would
        feed energy in.
        """
        rows = self.surface
        push = 0.5 * dt * self.model.inverse_mass[rows, None] * self.loads * self.model.free[rows]
        self.state.velocity[rows] += push
        self.early = push

    def _write_loads(self) -> None:
        load, time = self.state.load, self.accumulated.time
        load[:] = 0.0
        load[self.surface] = self.loads
        for one, faces in zip(self.params.pressures, self.pressed, strict=True):
            if pressure := one.at(time):
                add_pressure(self.mesh, self.state, self._is_left(faces), pressure)

    def _is_left(self, faces: Whole) -> Whole:
        """Those of some outer faces whose elements are not eroded."""
        return faces[self.places.active(self.state)[self.mesh.owner[faces]] > 0.0]

    def _write_forces(self, dt: float) -> float:
        """Advance the elements by a step and the nodes' velocities by half; return the bound."""
        bound = math.inf
        for law, first, last in zip(self.laws, self.first, self.first[1:], strict=False):
            found = self.team.run(
                self.kernel, last - first, first, self.model, self.state, law, self.resistance, dt
            )
            bound = min(bound, *(one[0] for one in found))
            least, worst = min((one[1], one[2]) for one in found)
            if not least > SMALLEST:
                raise self._inside_out(worst, least)
        sum_parted(self.parted, self.state.forces)
        ahead = 2.0 * min(bound, 1.0)  # s
        squares, closing = kick(self.model, self.state, dt, self.params.mass_damping, ahead)
        if not math.isfinite(squares):
            node = int(np.argmin(np.isfinite(self.state.velocity).all(axis=1)))
            raise StepError(
                f"node {node} at {self.mesh.node[node]} m: its velocity is not finite, at "
                f"{self.accumulated.time:g} s. Take a smaller courant."
            )
        if bound >= HUGE:  # nothing is left
            return math.inf
        # What meets a wall is squashed by what it moves in a step: a small share of an element.
        return bound / (1.0 + SQUASHED * closing * bound / self.shortest)

    def _inside_out(self, place: int, ratio: float) -> StepError:
        element = int(np.flatnonzero((self.places.point == place).any(axis=1))[0])
        middle = self.mesh.node[self.mesh.corner[element]].mean(axis=0)
        return StepError(
            f"element {element} of {ratio:.3g} of its volume, at "
            f"{np.array2string(middle, precision=4)} m at the start: it is inside out, at "
            f"{self.accumulated.time:g} s. Let it erode by failure_strain, or refine the mesh."
        )

    def give(self, wanted: Keys) -> Fields:
        """Copy out the motion of the surface, and which faces are still there."""
        given: dict[str, Array] = {}
        for key, array in (
            (POSITION, self.state.position),
            (VELOCITY, self.state.velocity),
            (MEAN_VELOCITY, self.state.mean_velocity),
        ):
            if key in wanted:
                given[key] = array[self.surface]
        if ACTIVE in wanted:
            given[ACTIVE] = self.places.active(self.state)[self.owner]
        return given | {key: one for key, one in self._measure(wanted).items() if key in wanted}

    def _measure(self, wanted: Keys) -> Fields:
        """Gauges that any partner, expectation or output asks for."""
        found: dict[str, Array] = {}
        if wanted_of("node_gauge", wanted):
            found |= at_nodes(self.state, self.measured.node)
        if wanted_of("element_gauge", wanted):
            found |= in_elements(self.places, self.state, self.measured.element)
        if wanted_of("node_set_gauge", wanted):
            found |= of_node_sets(self.state, self.measured.node_sets)
        if wanted_of("element_set_gauge", wanted):
            sets = self.measured.element_sets
            found |= of_element_sets(self.mesh, self.places, self.state, self.element_mass, sets)
        if wanted_of("part_gauge", wanted):
            found |= of_parts(self.mesh, self.places, self.state, self.element_mass)
        return found

    def _arrays(self) -> dict[str, Array]:
        """All that moves; of the forces those on nodes: the others are none between steps."""
        return {**self.state._asdict(), "forces": self.state.internal}

    def save(self) -> Fields:
        """Copy out all state."""
        kept = {name: array.copy() for name, array in self._arrays().items()}
        total = self.accumulated
        kept["accumulated"] = np.array([*astuple(total), self.bound])
        kept["judge"] = self.judge.save()
        own = {"loads": self.loads, "hung": self.hung, "early": self.early}
        return kept | {name: array.copy() for name, array in own.items()}

    def load(self, state: Fields) -> None:
        """Come back to a saved state, bit for bit."""
        self.state.forces[:] = 0.0
        for name, array in self._arrays().items():
            array[:] = state[name]
        self.loads[:] = state["loads"]
        self.hung, self.early = np.array(state["hung"]), np.array(state["early"])
        self.model.inverse_mass[self.surface] = 1.0 / (self.mass[self.surface] + self.hung)
        time, work, outside, damped, hung, steps, self.bound = state["accumulated"].tolist()
        self.accumulated = Accumulated(time, work, outside, damped, hung, int(steps))
        self.judge.load(state["judge"])

    def totals(self) -> Totals:
        """Mass, momentum and energies, with what hangs on the nodes.

        Internal is strain, plastic work and stabilisation; work is that of pressures, rigid walls
        and mass damping.
        """
        s, whole = self.state, self._whole_mass()
        momentum = whole[:, None] * s.velocity
        kinetic, potential = self._motion()
        energy = self.element_mass @ self.places.of(s, ENERGY) + self.places.spring_energy(s).sum()
        return Totals(
            mass=float(whole.sum()),
            momentum=momentum.sum(axis=0),
            angular_momentum=np.cross(s.position, momentum).sum(axis=0),
            kinetic=kinetic,
            potential=potential,
            internal=float(energy),
            work=self.accumulated.outside + float(s.wall_work.sum()),
        )

    def _whole_mass(self) -> Array:
        """Mass (n,) kg of the nodes with what hangs on them."""
        whole = self.mass.copy()
        whole[self.surface] += self.hung
        return whole

    def _motion(self) -> tuple[float, float]:
        """Kinetic and potential energy [J]."""
        whole, moving = self._whole_mass(), self.state.velocity
        if self.glued:
            moving = moving.copy()
            moving[self.surface] += self.early
        kinetic = 0.5 * float((whole[:, None] * moving * moving).sum())
        gravity = self.model.gravity
        return kinetic, -float(whole @ (self.state.position @ gravity)) if gravity.any() else 0.0

    def warnings(self) -> dict[str, str]:
        """Energy from nowhere, hourglassing, and motion that bulk viscosity takes."""
        return self.judge.warnings()

    def notes(self) -> tuple[str, ...]:
        """Sizes of meshes from files and what of them is left out; integration in thin parts."""
        return (*self.mesh.notes, *integration_notes(self.params))

    def view(self) -> Fields:
        """Outer faces with velocity, stress, plastic strain and temperature."""
        return view(self.mesh, self.places, self.state)

    def walls(self) -> Fields:
        """Return rigid walls, clamped faces and planes of symmetry."""
        return supports(self.params, self.mesh)

    def items(self) -> int:
        """Count the elements."""
        return len(self.mesh.corner)


def _one_point(begin: int, end: int, first: int, *arguments: object) -> Stepped:
    """Step blocks that are counted from a part's first one on."""
    found: Stepped = step_elements(first + begin, first + end, *arguments)
    return found


def _eight_points(begin: int, end: int, first: int, *arguments: object) -> Stepped:
    """The same of elements with eight points."""
    found: Stepped = step_eight_points(first + begin, first + end, *arguments)
    return found
