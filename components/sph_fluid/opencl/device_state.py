"""The state of a fluid in the memory of a device, sorted by cell there."""

from typing import Any

import numpy as np

from quintet.components.shared.opencl.arrays import DeviceArray, run
from quintet.components.shared.opencl.cells import Cells, NearLists
from quintet.components.shared.search.cells import Grid, grid_between
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import State


class DeviceState:
    """Rows of a fluid and its walls on a device; the counters stay in the host's `State`.

    Parameters
    ----------
    queue : pyopencl.CommandQueue
    kernels : pyopencl.Program
        Of `programs.rows_program`.
    params : SphFluidParams
    reach : float, m
        Of the neighbour lists.
    by_rows : bool
        As of `Cells`.
    """

    def __init__(
        self, queue: Any, kernels: Any, params: SphFluidParams, reach: float, by_rows: bool
    ) -> None:
        self.queue, self.reach, self.mirrored = queue, reach, params.mirrored
        self.cells = Cells(queue, kernels, by_rows)
        self._survey, self._note_places = kernels.survey, kernels.note_places
        self._gather_fluid, self._gather_boundary = kernels.gather_fluid, kernels.gather_boundary
        walls = params.boundary.tank
        low, high = walls or ((0.0,) * 3, (0.0,) * 3)
        self._walls = np.int32(walls is not None), np.array([*low, 0.0]), np.array([*high, 0.0])

    def put(self, state: State) -> None:
        """Copy a state to the device; lists that it has are made again."""
        self.split, self.count = state.fluid, state.particles
        self.position = DeviceArray.of(self.queue, state.position_density)
        self.velocity = DeviceArray.of(self.queue, state.velocity_pressure)
        self.previous = DeviceArray.of(self.queue, state.previous_density_rate)
        self.identity = DeviceArray.of(self.queue, state.identity)
        self.mirror = DeviceArray.of(self.queue, state.mirror_point)
        self.reference = DeviceArray(self.queue, (self.count, 3))
        self.extremes = DeviceArray(self.queue, (self.count, 4))
        self._most, self._least = (DeviceArray(self.queue, (self.split, 4)) for _ in range(2))
        self._spare = [
            DeviceArray(self.queue, each.shape, each.dtype)
            for each in (self.position, self.velocity, self.previous, self.identity, self.mirror)
        ]
        if len(state.reference):
            self.reference.put(state.reference[: self.count])
            self._list_as_noted(state)

    def get(self, state: State) -> None:
        """Copy the rows into a host's state."""
        state.position_density = self.position.get()
        state.velocity_pressure = self.velocity.get()
        state.previous_density_rate = self.previous.get()
        state.identity = self.identity.get()
        state.mirror_point = self.mirror.get()
        if len(state.reference):
            points = [self.reference.get(), state.mirror_point]
            state.reference = np.concatenate(points)

    def survey(self) -> tuple[np.ndarray, np.ndarray, float, bool]:
        """Corners (3,) m of the fluid, its greatest density, whether any of it left the tank."""
        run(
            self.queue, self._survey, self.split, self.position, np.int32(self.split),
            *self._walls, self._most, self._least,
        )  # fmt: skip
        most = self.cells.greatest(self._most, self.split)
        least = self.cells.greatest(self._least, self.split)
        return -least[:3], most[:3], float(most[3]), bool(least[3] > 0.0)

    def sort(self, low: np.ndarray, high: np.ndarray, state: State) -> None:
        """Bring near rows together and list neighbours; nothing may be outside of the tank."""
        grid = grid_between(low, high, self.reach)
        split, walls = self.split, self.count - self.split
        fluid_key = self.cells.sorted_keys(self.position, 0, split, grid)
        wall_key = self.cells.sorted_keys(self.position, split, walls, grid)
        rows = self.position, self.velocity, self.previous
        position, velocity, previous, identity, mirror = self._spare
        run(
            self.queue, self._gather_fluid, split, fluid_key, np.int32(split), *rows,
            self.identity, position, velocity, previous, identity,
        )  # fmt: skip
        mirrored = (self.mirror if self.mirrored else None, position, velocity, previous, mirror)
        run(
            self.queue, self._gather_boundary, walls, wall_key, np.int32(split), np.int32(walls),
            *rows, *mirrored,
        )  # fmt: skip
        self._spare = [*rows, self.identity, self.mirror]
        self.position, self.velocity, self.previous = position, velocity, previous
        self.identity, self.mirror = identity, mirror
        run(
            self.queue, self._note_places, self.count, self.position, np.int32(self.count),
            self.reference,
        )  # fmt: skip
        self._list(self.position, grid, fluid_key, wall_key)
        state.exit_face[:] = 0
        state.reference, state.moved = np.zeros((self.count + len(state.mirror_point), 3)), 0.0

    def _list_as_noted(self, state: State) -> None:
        """List neighbours from where rows were when they were sorted, as they are in order."""
        points = state.reference[: self.split]
        grid = grid_between(points.min(axis=0), points.max(axis=0), self.reach)
        rows = np.zeros((self.count, 4))
        rows[:, :3] = state.reference[: self.count]
        noted = DeviceArray.of(self.queue, rows)
        split, walls = self.split, self.count - self.split
        fluid_key = self.cells.sorted_keys(noted, 0, split, grid)
        wall_key = self.cells.sorted_keys(noted, split, walls, grid)
        self._list(noted, grid, fluid_key, wall_key)

    def _list(
        self, position: DeviceArray, grid: Grid, fluid_key: DeviceArray, wall_key: DeviceArray
    ) -> None:
        split, count = self.split, self.count
        starts = (
            self.cells.starts(fluid_key, 0, split, grid),
            self.cells.starts(wall_key, split, count - split, grid),
        )
        look = self.mirror if self.mirrored else None
        self.lists: NearLists = self.cells.lists(
            position, look, split, count, grid, starts, self.reach, self.extremes
        )
