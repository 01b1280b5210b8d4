"""Rows of a fluid that comes and goes, on a device; imported only by a scene that asks.

Before neighbours are listed, the host lets particles come and go (`open_boundaries/flow.py`). The
device marks the rows that this reads, those of buffers and of the fluid beside them; only these are
copied to the host, and what changed of them back.
"""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from quintet.components.shared.opencl.arrays import DeviceArray, run
from quintet.components.sph_fluid.open_boundaries.flow import Flow
from quintet.components.sph_fluid.opencl.device_state import OF_ALL, OF_FLUID, DeviceState
from quintet.components.sph_fluid.state import State, Whole

SOURCE = Path(__file__).with_name("open_rows.cl")
CHANGED = ("position_density", "velocity_pressure", "previous_density_rate", "role")


class DeviceFlow:
    """The inflows and outflows of one fluid.

    Parameters
    ----------
    flow : Flow
        Of the host.
    kernels : pyopencl.Program
        Built from a text that has `SOURCE`.
    rows : DeviceState
    """

    def __init__(self, flow: Flow, kernels: Any, rows: DeviceState) -> None:
        self.flow, self.rows = flow, rows
        self._mark, self._number = kernels.mark_near_face, kernels.number_staying
        self._scatter, self._hold = kernels.scatter, kernels.hold

    def renew(self, state: State) -> bool:
        """Add and remove particles; return whether there were any.

        The host's state gets counts and array sizes, no values.
        """
        chosen = self._near_faces()
        part = self._read(state, chosen)
        before = part.identity
        self.flow.renew(part)
        state.born, state.carried, state.returned = part.born, part.carried, part.returned
        stays = np.isin(before, part.identity, assume_unique=True)
        self._write(part, chosen[stays])
        count = int(stays.sum())
        removed, added = chosen[~stays], part.fluid - count
        if not (len(removed) or added):
            return False
        self._replace(removed, part, count)
        resize_fluid(state, removed, added)
        return True

    def _near_faces(self) -> Whole:
        """Rows (k,) that the host needs, in order."""
        rows = self.rows
        mark = DeviceArray(rows.queue, (rows.split,), np.uint8)
        mark.clear()
        split, role = np.int32(rows.split), rows.arrays["role"]
        for zone in self.flow.zones:
            depth = (1.0 + 1e-9) * self.flow.reads_to(zone)  # numpy rounds otherwise
            numbers = map(np.float64, (zone.face, zone.inward, depth))
            run(
                rows.queue, self._mark, rows.split, split, np.int32(zone.axis), *numbers,
                rows.position, role, mark,
            )  # fmt: skip
        return np.flatnonzero(mark.get())

    def _read(self, state: State, chosen: Whole) -> State:
        """Copy some rows (k,) of the fluid into a state of their own."""
        rows = self.rows
        columns: dict[str, Any] = {
            "sample": np.zeros(0, np.int64),
            "mirror_point": np.zeros((0, 3)),
        }
        key = DeviceArray.of(rows.queue, chosen)
        for name in (*OF_ALL, *OF_FLUID):
            source = rows.arrays[name]
            count = len(chosen) if source.shape[0] else 0
            target = DeviceArray(rows.queue, (count, *source.shape[1:]), source.dtype)
            numbers = map(np.int32, (count, 0, 0, _words(source)))
            run(rows.queue, rows.gather, count, key, *numbers, source, target)
            columns[name] = target.get()
        return replace(state, **columns, exit_face=state.exit_face[chosen])

    def _write(self, part: State, row: Whole) -> None:
        """Copy the first k rows of a state to rows (k,) of the device."""
        rows, count = self.rows, np.int32(len(row))
        key = DeviceArray.of(rows.queue, row)
        for name in CHANGED:
            target = rows.arrays[name]
            source = DeviceArray.of(rows.queue, getattr(part, name)[: len(row)])
            width = np.int32(_words(target))
            run(rows.queue, self._scatter, len(row), key, count, width, source, target)

    def _replace(self, removed: Whole, part: State, first: int) -> None:
        """Remove rows (k,) of the fluid; add those of a state from the first one on behind it."""
        rows, queue = self.rows, self.rows.queue
        staying, shifted = rows.split - len(removed), removed - np.arange(len(removed))
        key = DeviceArray(queue, (staying,), np.int64)
        arguments = (np.int32(staying), DeviceArray.of(queue, shifted), np.int32(len(removed)))
        run(queue, self._number, staying, *arguments, key)
        split, boundary_count = staying + part.fluid - first, rows.count - rows.split
        for name in (*OF_ALL, *OF_FLUID):
            source = rows.arrays[name]
            if source.shape[0]:
                count = split + (boundary_count if name in OF_ALL else 0)
                target = DeviceArray(queue, (count, *source.shape[1:]), source.dtype)
                numbers = map(np.int32, (staying, 0, 0, _words(source)))
                run(queue, rows.gather, staying, key, *numbers, source, target)
                target.put(getattr(part, name)[first:], staying)
                target.copy_from(source, rows.split, split)
                rows.arrays[name] = target
        rows.split, rows.count = split, split + boundary_count
        rows.make_room()

    def hold(self, rate: DeviceArray, drift: DeviceArray | None) -> None:
        """Keep velocities and densities of buffer rows: set rates (n, 4), drift (fluid, 3) to 0."""
        rows, minus_rho_div_u = self.rows, self.rows.arrays["minus_rho_div_u"]
        damped = minus_rho_div_u if minus_rho_div_u.shape[0] else None
        numbers = (np.int32(rows.split), rows.arrays["role"])
        run(rows.queue, self._hold, rows.split, *numbers, rate, drift, damped)


def resize_fluid(state: State, removed: Whole, added: int) -> None:
    """Give a host's state the sizes of the device's rows; rows of the boundary stay as they are.

    Those of the fluid are 0 until they are read.
    """
    split, end = state.fluid, state.particles
    fluid = split - len(removed) + added

    def resized(array: NDArray[Any], boundary: NDArray[Any]) -> NDArray[Any]:
        target = np.zeros((fluid + len(boundary), *array.shape[1:]), array.dtype)
        target[fluid:] = boundary
        return target

    names = [name for name in (*OF_ALL, *OF_FLUID) if len(getattr(state, name))]
    for name in names:
        array = getattr(state, name)
        setattr(state, name, resized(array, array[split:end] if name in OF_ALL else array[:0]))
    exits = np.delete(state.exit_face, removed)
    state.exit_face = np.concatenate([exits, np.zeros(added, np.int64)])


def _words(array: DeviceArray) -> int:
    """Words of 8 bytes in a row of an array."""
    return int(np.prod(array.shape[1:]))
