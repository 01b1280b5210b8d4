"""A recorded component, again: gives at each window's end what was recorded there."""

import h5py
import numpy as np

from quintet.components.stand_ins.params import ReplayParams, recorded_ports, recording_file
from quintet.interfaces.component import Component, Fields
from quintet.interfaces.errors import StepError

ROUNDING = 1e-9  # of a window, by which times may differ


class Replay(Component):
    """Plays the rows of a recording; a window must end at a recorded time."""

    def __init__(self, params: ReplayParams) -> None:
        self.takes, self.gives = recorded_ports(params)
        impulses = {
            f"{port.name}.{field.name}"
            for port in self.gives
            for field in port.fields
            if field.centring == "impulse"
        }
        with h5py.File(recording_file(params.recording), "r", locking=False) as file:
            group = file[f"components/{params.component}"]
            self.times = group["times"][()]  # (rows,) s
            self.rows = {key: group[f"fields/{key}"][()] for key in group["fields"]}
            self.static = {key: group[f"static/{key}"][()] for key in group.get("static", ())}
        windows = np.diff(self.times, prepend=0.0)
        for key in impulses:
            rows = self.rows[key]
            lengths = np.where(windows > 0, windows, 1.0).reshape(-1, *[1] * (rows.ndim - 1))
            self.rows[key] = rows / lengths
        self.row = 0
        self._into = 0.0  # s, since the last recorded time

    def describe(self) -> Fields:
        """Give what was described then."""
        return dict(self.static)

    def stable_dt(self) -> float:
        """Return the time to the next row."""
        if self.row + 1 >= len(self.times):
            raise StepError(
                f"a replay ends where its recording does, at t = {self.times[-1]:g} s. End the "
                "run there, or record longer."
            )
        return float(self.times[self.row + 1] - self.times[self.row] - self._into)

    def take(self, fields: Fields) -> None:
        """Nothing moves a recording."""

    def step(self, dt: float) -> None:
        """Go on, to the next row when its time has come."""
        length = self.times[self.row + 1] - self.times[self.row]
        self._into += dt
        if self._into >= length * (1.0 - ROUNDING):
            self.row, self._into = self.row + 1, 0.0

    def give(self) -> Fields:
        """Return the row of the present time."""
        if self._into:
            raise StepError(
                f"a replay can give only at recorded times; {self._into:g} s after row {self.row} "
                "is between two. Use the window of the recorded run."
            )
        return {key: rows[self.row].copy() for key, rows in self.rows.items()}

    def save(self) -> Fields:
        """Copy out the place in the recording."""
        return {"row": np.array([self.row]), "into": np.array([self._into])}

    def load(self, state: Fields) -> None:
        """Come back to a place."""
        self.row, self._into = int(state["row"][0]), float(state["into"][0])

    def items(self) -> int:
        """Count the items of its first port."""
        return len(next(iter(self.rows.values()))[0]) if self.rows else 0
