"""A recorded component: at the end of each window it gives the fields recorded there."""

import numpy as np

from quintet.components.stand_ins.params import ReplayParams
from quintet.components.stand_ins.recorded import recorded, recorded_ports
from quintet.interfaces.component import Component, Fields, Keys, fields_of
from quintet.interfaces.errors import SceneError, StepError

SAMPLES = "samples"  # first part of the names under which a recording holds them
ROUNDING = 1e-9  # of a window, by which times may differ


class Replay(Component):
    """Plays the rows of a recording; a window must end at a recorded time."""

    gives_integrals = True  # as they were recorded, bit for bit

    def __init__(self, params: ReplayParams) -> None:
        self.takes, self.gives = recorded_ports(params)
        fields = fields_of(self.gives)
        self.impulses = {key for key, field in fields.items() if field.centring == "impulse"}
        with recorded(params) as file:
            name, group = params.component, file.component(params.component)
            marks = file.marks(name)
            self.times = marks["ticks"] * file.file.attrs["tick"]  # (rows,) s
            self.stable = marks["stable_steps"]  # (rows,) s
            self.rows = {key: file.field(name, key) for key in group["fields"]}
            static = {key: group[f"static/{key}"][()] for key in group.get("static", ())}
            self.static = {k: a for k, a in static.items() if not k.startswith(SAMPLES)}
            self.samples = {k: a for k, a in static.items() if k.startswith(SAMPLES)}
        self.row = 0
        self._into = 0.0  # s, since the last recorded time
        self._from = 0  # row at the beginning of the last step

    def describe(self) -> Fields:
        """Return the recorded static fields."""
        return {key: array.copy() for key, array in self.static.items()}

    def sample(self, request: Fields) -> Fields:
        """Answer as the recorded component did; of a mesh, from its nodes and faces."""
        port = next(iter(request)).partition(".")[0]
        if f"{port}.start" in self.static:
            # Left out of replays of bodies.
            from quintet.components.shared.geometry.surface_samples_mesh import mesh_answer

            return mesh_answer(port, request, self.static)
        for number in {key.split(".")[1] for key in self.samples}:
            start = f"{SAMPLES}.{number}."
            answer = {
                k.removeprefix(start): a for k, a in self.samples.items() if k.startswith(start)
            }
            if all(np.array_equal(answer.get(key, ()), array) for key, array in request.items()):
                return {key: array for key, array in answer.items() if key not in request}
        requested = ", ".join(f"{key} {array[0]:g}" for key, array in request.items())
        raise SceneError(
            "a replay of bodies can be sampled only as they were in the recorded run; found a "
            f"request for {requested}. Request the same, or record a run with this request."
        )

    def stable_dt(self) -> float:
        """Return the recorded stable step."""
        return float(self.stable[self.row])

    def take(self, fields: Fields) -> None:
        """Nothing moves a recording."""

    def step(self, dt: float) -> None:
        """Go on, to the next row when its time has come."""
        self._from = self.row
        self._into += dt
        while True:
            if self.row + 1 >= len(self.times):
                if self._into > ROUNDING * dt:
                    raise StepError(
                        f"a replay ends where its recording does, at t = {self.times[-1]:g} s. "
                        "End the run there, or record longer."
                    )
                break
            length = self.times[self.row + 1] - self.times[self.row]
            if self._into < length * (1.0 - ROUNDING):
                break
            self.row, self._into = self.row + 1, self._into - length
        if abs(self._into) <= ROUNDING * dt:
            self._into = 0.0

    def give(self, wanted: Keys) -> Fields:
        """Return the row of the present time; impulses of all rows that the last step passed."""
        if self._into and not wanted <= self.impulses:
            raise StepError(
                f"a replay can give only at recorded times; {self._into:g} s after row {self.row} "
                "is between two. Use the window of the recorded run."
            )
        values = {}
        for key in wanted:
            rows = self.rows[key]
            if key not in self.impulses or not self._from < self.row:
                nothing = key in self.impulses and self.row > 0
                values[key] = np.zeros_like(rows[0]) if nothing else rows[self.row].copy()
            else:
                values[key] = rows[self._from + 1 : self.row + 1].sum(axis=0)
        return values

    def save(self) -> Fields:
        """Copy out the place in the recording."""
        return {
            "row": np.array([self.row]),
            "into": np.array([self._into]),
            "from": np.array([self._from]),
        }

    def load(self, state: Fields) -> None:
        """Restore a place in the recording."""
        self.row, self._into = int(state["row"][0]), float(state["into"][0])
        self._from = int(state["from"][0])

    def items(self) -> int:
        """Count the items of its first port."""
        return len(next(iter(self.rows.values()))[0]) if self.rows else 0
