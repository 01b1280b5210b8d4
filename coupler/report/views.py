"""What components show, as arrays: the views that a run wrote for pictures and ParaView."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from quintet.coupler.files import vtkhdf_reader
from quintet.coupler.files.run_files import VIEWS
from quintet.coupler.report.view_steps import view_files
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import unknown

BEYOND = 1e-6  # of the times of a view: so much later than its last step is rounding


@dataclass(frozen=True)
class ViewStep(Mapping[str, Array]):
    """A component at one time, a mapping of names to arrays, in float32.

    ``points`` (n, 3) m; where it shows faces ``cells`` (m, k): numbers of their corners, -1 after
    the last; all other arrays have a row for each point or for each cell.

    Attributes
    ----------
    time : float, s
    arrays : mapping of str to arrays
    units : mapping of str to str
        "" where it is not known.
    """

    time: float
    arrays: Mapping[str, Array]
    units: Mapping[str, str]

    def __getitem__(self, name: str) -> Array:
        if name not in self.arrays:
            raise KeyError(unknown(f"view at {self.time:g} s: {name}", name, self.arrays))
        return self.arrays[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.arrays)

    def __len__(self) -> int:
        return len(self.arrays)

    def __repr__(self) -> str:
        fields = [f"{name} {array.shape}" for name, array in self.arrays.items()]
        return f"ViewStep(t = {self.time:g} s: {', '.join(fields)})"


class View:
    """All steps of what a component shows, each read when it is asked for."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.times = vtkhdf_reader.times(path)  # (steps,) s
        self.units = {"points": "m", **vtkhdf_reader.units(path)}

    def at(self, time: float) -> ViewStep:
        """The step next to a time [s]; a time before the first or after the last is refused."""
        first, last = float(self.times[0]), float(self.times[-1])
        slack = BEYOND * max(abs(last), abs(first))
        if not first - slack <= time <= last + slack:
            raise SceneError(
                f"view {self.path}: a time must be from {first:g} to {last:g} s; found {time:g}. "
                "Choose another, or run longer."
            )
        return self[int(np.abs(self.times - time).argmin())]

    def __getitem__(self, step: int) -> ViewStep:
        """One of the steps, by its number."""
        steps = len(self.times)
        if not -steps <= step < steps:
            raise IndexError(f"view {self.path}: it has {steps} steps; there is no step {step}.")
        return ViewStep(*vtkhdf_reader.read_step(self.path, step % steps), self.units)

    def __len__(self) -> int:
        return len(self.times)

    def __repr__(self) -> str:
        return f"View({self.path.name}: {len(self)} steps to {self.times[-1]:g} s)"


class Views(Mapping[str, View]):
    """What the components of a run show, by their names."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def _files(self) -> dict[str, Path]:
        return {path.name.removesuffix(VIEWS): path for path in view_files(self._folder)}

    def __getitem__(self, name: str) -> View:
        files = self._files()
        if name not in files:
            raise KeyError(unknown(f"run {self._folder}: view of {name}", name, files))
        return View(files[name])

    def __iter__(self) -> Iterator[str]:
        return iter(self._files())

    def __len__(self) -> int:
        return len(self._files())

    def __repr__(self) -> str:
        return f"Views({', '.join(self) or 'nothing shown'})"
