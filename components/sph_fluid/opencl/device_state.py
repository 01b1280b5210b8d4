"""The state of a fluid in the memory of a device, sorted by cell there."""

from typing import Any

import numpy as np

from quintet.components.shared.opencl.arrays import DeviceArray, run
from quintet.components.shared.opencl.cells import Cells, NearLists
from quintet.components.shared.search.cells import Grid, grid_between, sorted_into
from quintet.components.shared.search.neighbours import Around, Lists
from quintet.components.sph_fluid.boundary.kernels.mirrored_density import BY_POTENTIAL
from quintet.components.sph_fluid.opencl.copies import Copies
from quintet.components.sph_fluid.params import SphFluidParams
from quintet.components.sph_fluid.state import State, Whole

# Arrays of `State` that are on the device, by the rows that they have.
OF_ALL = ("position_density", "velocity_pressure", "previous_density_rate", "minus_rho_div_u")
OF_FLUID = ("identity", "acceleration", "role")
OF_BOUNDARY = ("mirror_point", "sample")


class DeviceState:
    """Rows of a fluid and its boundary on a device; the counters stay in the host's `State`.

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
    copies : Copies
        Of other ranks' rows, behind all others in `position` and `velocity`.
    """

    def __init__(
        self, queue: Any, kernels: Any, params: SphFluidParams, reach: float, by_rows: bool,
        copies: Copies,
    ) -> None:  # fmt: skip
        self.copies = copies
        self.queue, self.reach, self.mirrored = queue, reach, params.mirrored
        self.walls_look = params.boundary.method != "potential"
        self.by_potential: Whole = np.zeros(0, np.int64)  # (k,) samples under the contact potential
        self.cells = Cells(queue, kernels, by_rows)
        self._survey, self.gather = kernels.survey, kernels.gather
        self._note_places, self._look_from = kernels.note_places, kernels.look_from
        self._place, self._find_not_finite = kernels.place_samples, kernels.find_not_finite
        walls = params.boundary.tank
        low, high = walls or ((0.0,) * 3, (0.0,) * 3)
        self._walls = np.int32(walls is not None), np.array([*low, 0.0]), np.array([*high, 0.0])

    @property
    def position(self) -> DeviceArray:
        """Positions and densities (n, 4) of all rows."""
        return self.arrays["position_density"]

    @property
    def velocity(self) -> DeviceArray:
        """Velocities and p/ρ² (n, 4) of all rows."""
        return self.arrays["velocity_pressure"]

    @property
    def mirror(self) -> DeviceArray | None:
        """Mirror points (boundary, 3) of mirrored walls and samples."""
        return self.arrays["mirror_point"] if self.mirrored else None

    def put(self, state: State, around: Around | None = None) -> None:
        """Copy a state to the device; lists that it has are made again.

        `around` is what may be near, where that is more than the rows of the state.
        """
        row = state.sample_rows()
        self.split, self.count, self.samples = state.fluid, state.particles, len(row)
        names = (*OF_ALL, *OF_FLUID, *OF_BOUNDARY)
        self.arrays = {name: DeviceArray.of(self.queue, getattr(state, name)) for name in names}
        self._put_numbers(state, row)
        self.make_room()
        self.row = DeviceArray.of(self.queue, row.astype(np.int32))
        self._placed = DeviceArray(self.queue, (self.samples, 9))
        if len(state.reference):
            self.reference.put(state.reference)
            if around is None:
                self._list_as_noted(state)
            else:
                self._list_around(around)

    def make_room(self) -> None:
        """Make room for what is computed of all rows; lists are made again."""
        self._spare = {}
        if not self.copies.are_there:  # else rows are sorted on the host
            self._spare = {
                name: DeviceArray(self.queue, array.shape, array.dtype)
                for name, array in self.arrays.items()
            }
        rows = self.count + self.arrays["mirror_point"].shape[0]
        self.reference = DeviceArray(self.queue, (rows, 3))
        self.extremes = DeviceArray(self.queue, (self.count + self.samples, 4))
        self._most, self._least = (DeviceArray(self.queue, (self.split, 4)) for _ in range(2))

    def _put_numbers(self, state: State, row: Whole) -> None:
        """Number samples, of rows (k,), where other ranks or the contact potential have some."""
        self._own_numbers: DeviceArray | None = None
        if self.copies.are_there or len(self.by_potential):
            numbers = np.full(len(state.sample), -1)
            numbers[row - self.split] = np.arange(len(row))
            numbers[row[self.by_potential] - self.split] = BY_POTENTIAL
            self._own_numbers = DeviceArray.of(self.queue, numbers)

    @property
    def numbers(self) -> DeviceArray:
        """Numbers (boundary,) of the samples among those of this rank; -1 for walls."""
        return self._own_numbers or self.arrays["sample"]

    @property
    def role(self) -> DeviceArray | None:
        """Numbers (fluid,) of the buffers that hold rows, 0 for none, if there are any buffers."""
        return self.arrays["role"] if self.arrays["role"].shape[0] else None

    def get(self, state: State) -> None:
        """Copy the rows into a host's state."""
        for name, array in self.arrays.items():
            setattr(state, name, array.get())
        if len(state.reference):
            state.reference = self.reference.get()

    def follow_boundary(self, state: State) -> None:
        """Bring the boundary of a host's state into the order of the device.

        Of positions, velocities and densities those of samples alone; `get` brings the others.
        """
        row = state.sample_rows()
        for name in OF_BOUNDARY:
            setattr(state, name, self.arrays[name].get())
        state.reference[self.split :] = self.reference.get(self.split)
        for array in (state.position_density, state.velocity_pressure):
            array[state.sample_rows()] = array[row]
        if not self.walls_look:  # how stiff walls are limits the step
            state.velocity_pressure[self.split :] = self.velocity.get(self.split)

    def make_acceleration(self) -> bool:
        """Make room for accelerations (fluid, 3) m/s2; False where they are there."""
        if self.arrays["acceleration"].shape[0]:
            return False
        for arrays in (self.arrays, *([self._spare] if self._spare else [])):
            arrays["acceleration"] = DeviceArray(self.queue, (self.split, 3))
        return True

    def reflect_crossed(self) -> None:
        """Bring back fluid that passed a plane of symmetry."""
        acceleration = self.arrays["acceleration"]
        there = acceleration if acceleration.shape[0] else None
        self.copies.reflect_crossed(self.split, self.position, self.velocity, there)

    def place(self, state: State, row: Whole) -> None:
        """Put the samples, which have rows (samples,) in a host's state, where that has them."""
        sample_rows = np.zeros((self.samples, 3, 3))
        sample_rows[:, 0] = state.position_density[row, :3]
        sample_rows[:, 1] = state.velocity_pressure[row, :3]
        if self.mirrored:
            sample_rows[:, 2] = state.mirror_point[row - self.split]
        stiffness = None
        if len(self.by_potential):
            stiff = np.full(self.samples, -1.0)
            stiff[self.by_potential] = state.velocity_pressure[row[self.by_potential], 3]
            stiffness = DeviceArray.of(self.queue, stiff)
        self._placed.put(sample_rows.reshape(-1, 9))
        run(
            self.queue, self._place, self.samples, np.int32(self.samples), np.int32(self.split),
            self.row, self._placed, stiffness, self.position, self.velocity, self.mirror,
        )  # fmt: skip

    def survey(self) -> tuple[np.ndarray, np.ndarray, float, bool]:
        """Corners (3,) m of the fluid, its greatest density, whether any of it left the tank."""
        run(
            self.queue, self._survey, self.split, self.position, np.int32(self.split),
            *self._walls, self._most, self._least,
        )  # fmt: skip
        greatest = self.cells.greatest(self._most, self.split)
        least = self.cells.greatest(self._least, self.split)
        return -least[:3], greatest[:3], float(greatest[3]), bool(least[3] > 0.0)

    def is_finite(self) -> bool:
        """Whether all velocities and pressures of the fluid are finite; overwrites `extremes`."""
        split = np.int32(self.split)
        run(self.queue, self._find_not_finite, self.split, self.velocity, split, self.extremes)
        return not self.cells.greatest(self.extremes, self.split).any()

    def sort(self, low: np.ndarray, high: np.ndarray, state: State) -> None:
        """Bring near rows together and list neighbours; nothing may be outside of the tank.

        Where there are samples, the boundary of the host's state follows the order of the device.
        """
        grid = grid_between(low, high, self.reach)
        split, boundary_count = self.split, self.count - self.split
        fluid_key = self.cells.sorted_keys(self.position, 0, split, grid)
        boundary_key = self.cells.sorted_keys(self.position, split, boundary_count, grid)
        for name in (*OF_ALL, *OF_FLUID):
            self._take_rows(name, fluid_key, split, 0, 0)
        for name in OF_ALL:
            self._take_rows(name, boundary_key, boundary_count, split, 0)
        for name in OF_BOUNDARY:
            self._take_rows(name, boundary_key, boundary_count, 0, split)
        self.arrays, self._spare = self._spare, self.arrays
        rows = self.reference.shape[0]
        run(
            self.queue, self._note_places, rows, self.position, np.int32(self.count), self.mirror,
            np.int32(rows), self.reference,
        )  # fmt: skip
        state.exit_face[:] = 0
        state.reference, state.moved = np.zeros((rows, 3)), 0.0
        if self.samples:
            self.follow_boundary(state)
            row = state.sample_rows()
            self.row.put(row)
            self._put_numbers(state, row)
        self._list(self.position, grid, fluid_key, boundary_key)

    def _take_rows(self, name: str, key: DeviceArray, count: int, first: int, base: int) -> None:
        """Copy so many rows in the order of keys, which count rows from `base`, to `first` on."""
        source, target = self.arrays[name], self._spare[name]
        if source.shape[0]:
            width = int(np.prod(source.shape[1:]))
            numbers = map(np.int32, (count, first, base, width))
            run(self.queue, self.gather, count, key, *numbers, source, target)

    def _list_as_noted(self, state: State) -> None:
        """List neighbours from where rows were when they were sorted, as they are in order."""
        points = state.reference[: self.split]
        grid = grid_between(points.min(axis=0), points.max(axis=0), self.reach)
        rows = np.zeros((self.count, 4))
        rows[:, :3] = state.reference[: self.count]
        position = DeviceArray.of(self.queue, rows)
        split, boundary_count = self.split, self.count - self.split
        fluid_key = self.cells.sorted_keys(position, 0, split, grid)
        boundary_key = self.cells.sorted_keys(position, split, boundary_count, grid)
        self._list(position, grid, fluid_key, boundary_key)

    def _list(
        self, position: DeviceArray, grid: Grid, fluid_key: DeviceArray, boundary_key: DeviceArray
    ) -> None:
        split, boundary_count = self.split, self.count - self.split
        starts = (
            self.cells.starts(fluid_key, 0, split, grid),
            self.cells.starts(boundary_key, split, boundary_count, grid),
        )
        query_points, last = None, self.count
        if self.first_listed >= 0:
            last = self.first_listed
            looking = last - split  # boundary rows that look from their mirror points
            query_points = DeviceArray(self.queue, (looking + self.samples, 3))
            numbers = map(np.int32, (self.count, looking, query_points.shape[0]))
            run(
                self.queue, self._look_from, query_points.shape[0], *numbers, self.row,
                self.reference, query_points,
            )  # fmt: skip
        self.lists: NearLists = self.cells.lists(
            position, query_points, split, last, grid, starts, self.reach, self.extremes
        )

    def _list_around(self, around: Around) -> None:
        """List neighbours among this rank's rows and copies, where they are as they are listed."""
        points, groups, first = around.points, [], 0
        starts = []
        for group in (around.first, around.second):  # images are not in order yet
            _, start, order = sorted_into(points.take(group, axis=0), around.grid)
            groups.append(group[order])
            starts.append(DeviceArray.of(self.queue, (first + start).astype(np.int32)))
            first += len(group)
        names = np.concatenate(groups)
        rows = np.zeros((len(names), 4))
        rows[:, :3] = points.take(names, axis=0)
        self.lists = self.cells.lists(
            DeviceArray.of(self.queue, rows), DeviceArray.of(self.queue, around.looking),
            self.split, 0, around.grid, (starts[0], starts[1]), self.reach, self.extremes,
            DeviceArray.of(self.queue, names.astype(np.int32)),
        )  # fmt: skip

    @property
    def first_listed(self) -> int:
        """Where the lists of samples that look from where they are begin; -1: at their rows."""
        if self.mirrored:
            return self.count
        return -1 if self.walls_look else self.split

    def listed(self, row: Whole) -> Whole:
        """Rows (samples,) of the neighbour lists around samples with these rows (samples,)."""
        first = self.first_listed
        return first + np.arange(len(row)) if first >= 0 else row

    def lengths(self) -> Lists:
        """How many neighbours samples have, as lists of the host without the neighbours."""
        first = max(self.first_listed, self.split)
        end = np.zeros(self.lists.end.shape[0], np.int64)
        end[first:] = self.lists.end.get(first)
        return Lists(np.zeros(len(end), np.int64), end, end, np.zeros(0, np.int32))
