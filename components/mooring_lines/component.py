"""Mooring lines: loads on floating bodies, from where their fairleads are."""

import math

import numpy as np

from quintet.components.mooring_lines import MANIFEST, diagnostics, features
from quintet.components.mooring_lines.build import first_state, lines_of
from quintet.components.mooring_lines.joins import refuse_joins
from quintet.components.mooring_lines.kernels import add_loads, read_lines
from quintet.components.mooring_lines.params import MooringLinesParams
from quintet.components.mooring_lines.ports import GAUGE, SHOWS
from quintet.components.mooring_lines.state import State
from quintet.components.mooring_lines.view import view
from quintet.interfaces import rotation
from quintet.interfaces.component import Array, Component, Fields, Keys, Totals

MOTION = ("position", "velocity", "orientation", "angular_velocity")
GAUGES = tuple(f"line_gauge.{field.name}" for field in GAUGE.fields)


class MooringLines(Component):
    """Pulls at bodies of a partner; without a state of its own but for where they were.

    Parameters
    ----------
    params : MooringLinesParams
        Lines.
    """

    Params: type[MooringLinesParams] = MooringLinesParams

    manifest = MANIFEST
    shows = SHOWS
    compiles = True

    def __init__(self, params: MooringLinesParams) -> None:
        self.params, (self.takes, self.gives) = params, self.ports_of(params)
        self.lines = lines_of(params.lines)
        self.state = first_state(params.lines, 0)
        self.mass = np.ones(0)  # kg, of the bodies
        self.begun = False  # whether the state is that of another run

    def bind(self, static: Fields, joined: Keys) -> None:
        """Make room for the bodies that links bring."""
        refuse_joins(self.params, static, joined)
        self.mass = np.full(1 + int(self.lines.body.max()), math.inf)
        if "motion.mass" in static:
            self.mass = np.array(static["motion.mass"])
        self.state = first_state(self.params.lines, len(self.mass))

    def prime(self, fields: Fields) -> None:
        """Make the lines fast to the bodies, where these are as the run begins."""
        self.take(fields)
        if not self.begun:
            body, state = self.lines.body, self.state
            arm = state.fairlead - state.position[body]
            inverse = rotation.matrix(rotation.conjugate(state.orientation))[body]
            state.arm[:] = np.einsum("kij,kj->ki", inverse, arm)

    def _fairleads(self, time: float) -> Array:
        """Where the fairleads (k, 3) m are, a time [s] after the motion that is known."""
        body, state = self.lines.body, self.state
        arm = np.einsum("kij,kj->ki", rotation.matrix(state.orientation)[body], state.arm)
        velocity = state.velocity[body] + np.cross(state.angular_velocity[body], arm)
        return np.asarray(state.position[body] + arm + time * velocity)

    def stable_dt(self) -> float:
        """Allow any step: lines have no mass."""
        return math.inf

    def take(self, fields: Fields) -> None:
        """Take the motion of the bodies in the middle of the coming step."""
        for name in MOTION:
            if f"motion.{name}" in fields:
                getattr(self.state, name)[:] = fields[f"motion.{name}"]

    def step(self, dt: float) -> None:
        """Find the pull of all lines in the middle of a step of dt [s]."""
        state, fairlead = self.state, self._fairleads(0.0)
        # The step that compiles kernels has no length: lines allow any.
        dt = dt if math.isfinite(dt) else 0.0
        state.clock[:] = state.clock[0] + dt, dt
        state.load[:] = 0.0
        wrong = add_loads(fairlead, state.position, self.lines, state.pull, state.load)
        if wrong < len(fairlead):
            raise diagnostics.failure(wrong, fairlead, self.lines, state)

    def _read(self) -> tuple[float, Array]:
        """Energy [J] of the lines at the step's end, and what `read_lines` reads of each (k, 4)."""
        gauge = np.zeros((len(self.lines.length), 4))
        fairlead = self._fairleads(0.5 * self.state.clock[1])
        return read_lines(fairlead, self.lines, self.state.pull.copy(), gauge), gauge

    def give(self, wanted: Keys) -> Fields:
        """Copy out loads, and tension where it is wanted."""
        load = self.state.load
        fields = {"load.force": load[:, :3].copy(), "load.torque": load[:, 3:].copy()}
        if not wanted.isdisjoint(GAUGES):
            _, gauge = self._read()
            fields |= {key: gauge[:, column].copy() for column, key in enumerate(GAUGES)}
        return {key: array for key, array in fields.items() if key in wanted}

    def save(self) -> Fields:
        """Copy out all state."""
        return {name: array.copy() for name, array in self.state._asdict().items()}

    def load(self, state: Fields) -> None:
        """Restore a saved state, bit for bit."""
        self.state = State(**{name: np.array(state[name]) for name in State._fields})

    def begin_from(self, state: Fields) -> None:
        """Begin from the state of another run: lines stay fast where they were."""
        features.refuse_other_lines(self.state, state)
        self.load(state)
        self.state.clock[:] = 0.0
        self.begun = True

    def totals(self) -> Totals:
        """Energy of the lines."""
        return diagnostics.totals(self._read()[0])

    def warnings(self) -> dict[str, str]:
        """Warn of lines that are stretched too far, and of windows that are too long."""
        return diagnostics.warnings(
            self._read()[1], self.lines, self.mass, float(self.state.clock[1])
        )

    def notes(self) -> tuple[str, ...]:
        """Which body each line holds."""
        return diagnostics.notes(self.lines, self.state)

    def view(self) -> Fields:
        """Points along all lines."""
        return view(self._fairleads(0.5 * self.state.clock[1]), self.lines, self.state.pull)

    def items(self) -> int:
        """Count the lines."""
        return len(self.params.lines)
