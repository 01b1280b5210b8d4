"""Stages of the steps of balls on a device, and the numbers that they reduce over all rows."""

from typing import Any, NamedTuple

import numpy as np

from quintet.components.dem_bodies.opencl import programs
from quintet.components.dem_bodies.opencl.device_pairs import DevicePairs
from quintet.components.dem_bodies.opencl.device_rows import DeviceRows
from quintet.components.dem_bodies.state import Model, Numbers
from quintet.components.shared.opencl.arrays import GROUP, DeviceArray
from quintet.components.shared.opencl.devices import opencl
from quintet.components.shared.opencl.launches import Launch

COLUMNS = tuple(map(len, (programs.DRIFT, programs.PAIRS, programs.KICK)))
PLACES = np.cumsum([0, *COLUMNS])  # in the report, of the columns of drift, pairs, kick
IS_SUM = np.concatenate([
    np.arange(columns) < sums
    for columns, sums in zip(
        COLUMNS, (programs.DRIFT_SUMS, programs.PAIR_SUMS, programs.KICK_SUMS), strict=True
    )
])  # fmt: skip
NO_PAIRS = -np.inf, 0.0, 0.0  # columns of pairs where there are none


class Reduced(NamedTuple):
    """What a stage reduces over all rows or pairs: numbers by the names of their columns."""

    of_drift: dict[str, float]
    of_pairs: dict[str, float]
    of_kick: dict[str, float]
    on_ground: Numbers  # (6,) N and N m


class Tally:
    """The columns of one kernel, reduced by a second kernel."""

    def __init__(
        self, kernels: Any, items: int, place: int, sums: int, report: DeviceArray
    ) -> None:
        columns, groups = COLUMNS[place], -(-items // GROUP)
        self.part, self._sums = DeviceArray(report.queue, (columns, groups)), sums
        sizes = (np.int32(groups), np.int32(sums), np.int32(PLACES[place]))
        self._collect = Launch(
            report.queue, opencl().Kernel(kernels, "collect"), columns * GROUP, *sizes,
            self.part, report,
        )  # fmt: skip

    def collect(self) -> None:
        """Reduce what the groups of the last run found."""
        self._collect.run()

    def sums(self) -> Numbers:
        """Sums (columns, groups) of the groups of the last run."""
        return self.part.get(0, self._sums)


class Stages:
    """Kernel launches of a step.

    Parameters
    ----------
    kernels : pyopencl.Program
        Of `programs.source`.
    rows : DeviceRows
    model : Model
    lanes : int
        How many pairs are computed at once.
    """

    def __init__(self, kernels: Any, rows: DeviceRows, model: Model, lanes: int) -> None:
        self._kernels, self._rows, self._model, self._lanes = kernels, rows, model, lanes
        self._gravity = np.array([*model.gravity, 0.0])
        self._of_kernels = {name: opencl().Kernel(kernels, name) for name in ("touch", "kick")}
        self._report = DeviceArray(rows.queue, (int(PLACES[-1]),))
        self._drift_tally = self._tally(rows.count, 0, programs.DRIFT_SUMS)
        self._kick_tally = self._tally(rows.count, 2, programs.KICK_SUMS)
        arrays = rows.arrays
        self._drift = Launch(
            rows.queue, opencl().Kernel(kernels, "drift"), rows.count, np.int32(rows.count),
            self._gravity, rows.inverse, arrays["contact_load"], arrays["load"], rows.listed,
            arrays["motion"], arrays["orientation"], self._drift_tally.part,
        )  # fmt: skip

    def _tally(self, items: int, place: int, sums: int) -> Tally:
        return Tally(self._kernels, items, place, sums, self._report)

    def follow(self, pairs: DevicePairs) -> None:
        """Follow new lists."""
        rows, kernels, arrays = self._rows, self._of_kernels, self._rows.arrays
        count, stride = np.int32(pairs.count), np.int32(pairs.stride)
        rows_with_ground = np.int32(rows.count + rows.copies + 1)
        of_pairs = (
            count, stride, rows_with_ground, pairs.row, pairs.partner, pairs.constants_row,
            pairs.constants, rows.plane, arrays["motion"], pairs.history, pairs.push,
        )  # fmt: skip
        items = pairs.stride // self._lanes
        self._pair_tally = self._tally(items, 1, programs.PAIR_SUMS)
        self._touch = Launch(
            rows.queue, kernels["touch"], items, *of_pairs, self._pair_tally.part
        )  # fmt: skip
        self._roll: Launch | None = None
        if pairs.spring is not None:
            if "roll" not in kernels:
                kernels["roll"] = opencl().Kernel(self._kernels, "roll")
            rolling = (pairs.spring, pairs.moment)
            self._roll = Launch(rows.queue, kernels["roll"], pairs.count, *of_pairs, *rolling)
        self._kick = Launch(
            rows.queue, kernels["kick"], rows.count, np.int32(rows.count), rows_with_ground,
            self._gravity, rows.inverse, arrays["load"], pairs.begin, pairs.partner,
            pairs.incoming_begin, pairs.incoming, pairs.push, pairs.moment, arrays["motion"],
            arrays["contact_load"], self._kick_tally.part,
        )  # fmt: skip
        self._pairs = pairs.count

    def drift(self, dt: float, loaded: bool) -> float:
        """Half kick and drift by dt [s]; return the square of the largest displacement [m²]."""
        self._drift.run(np.float64(dt), np.int32(loaded))
        self._drift_tally.collect()
        return float(self._report.get()[programs.DRIFT.index("TRAVEL")])

    def touch(self, dt: float) -> None:
        """Loads of all pairs in a step of dt [s]."""
        if self._pairs:
            self._touch.run(np.float64(dt))
            self._pair_tally.collect()
            if self._roll:
                self._roll.run(np.float64(dt))

    def kick(self, dt: float, loaded: bool) -> None:
        """Loads of all rows, and the second half kick of a step of dt [s]."""
        self._kick.run(np.float64(dt), np.int32(loaded))
        self._kick_tally.collect()

    def numbers(self) -> Numbers:
        """Numbers of all columns, after the kick."""
        numbers: Numbers = self._report.get()
        if not self._pairs:
            numbers[PLACES[1] : PLACES[2]] = NO_PAIRS
        return numbers

    def reduced(self) -> Reduced:
        """What the step reduced over all rows and pairs, after the kick."""
        return reduced_of(self.numbers())

    def sums_of_drift(self) -> Numbers:
        """Sums (columns, groups) of groups of rows."""
        return self._drift_tally.sums()

    def sums_of_kick(self) -> Numbers:
        """Sums (columns, groups) of groups of rows."""
        return self._kick_tally.sums()


def reduced_of(numbers: Numbers) -> Reduced:
    """Numbers of all columns, by their names."""
    drift, pairs, kick, _ = np.split(numbers, PLACES[1:])
    return Reduced(
        _named(programs.DRIFT, drift),
        _named(programs.PAIRS, pairs),
        _named(programs.KICK, kick),
        kick[programs.GROUND : programs.GROUND + 6],
    )


def _named(names: tuple[str, ...], numbers: Numbers) -> dict[str, float]:
    """Numbers by the names of their columns."""
    return dict(zip(names, numbers.tolist(), strict=True))
