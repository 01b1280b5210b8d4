"""The state of bodies in the memory of a device, sorted by cell there, and their neighbours."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from quintet.components.shared.opencl.arrays import DeviceArray, run
from quintet.components.shared.opencl.cells import Cells, NearLists
from quintet.components.shared.search.cells import Grid, grid_between
from quintet.components.shared.symmetry import Plane
from quintet.components.sph_solid.opencl.images import DeviceImages
from quintet.components.sph_solid.state import OF_PARTICLES, Array, State

if TYPE_CHECKING:
    from quintet.components.sph_solid.opencl.ranks import DeviceCopies
    from quintet.components.sph_solid.opencl.rings import DeviceRings

MakeCopies = Callable[[DeviceImages, Any], "DeviceCopies"]
IN_ROWS = tuple(name for name in OF_PARTICLES if name != "reference")


class DeviceState:
    """Particles on a device, and rows of them and their images that pairs are computed from.

    Numbers of all particles together stay in the host's `State`.

    Parameters
    ----------
    queue : pyopencl.CommandQueue
    kernels : pyopencl.Program
        Of `programs.source`.
    planes, mirrors : list of Plane
        As of `DeviceImages`.
    width : int
        Rows of four numbers that the stress of a particle has.
    by_rows : bool
        As of `Cells`.
    ring_length : float, m
        Smoothing length of rings; 0 of bodies that are not axisymmetric.
    copies
        Makes copies of other ranks' particles, of images and kernels; None on one rank.
    """

    def __init__(
        self, queue: Any, kernels: Any, planes: list[Plane], mirrors: list[Plane], width: int,
        by_rows: bool, ring_length: float, copies: "MakeCopies | None" = None,
    ) -> None:  # fmt: skip
        self.queue, self.width = queue, width
        self.cells = Cells(queue, kernels, by_rows)
        self._of_planes = DeviceImages(planes, mirrors, kernels, self.take_rows)
        self.copies = copies(self._of_planes, kernels) if copies else None
        self.images = self.copies or self._of_planes
        self.lists: NearLists
        self.turn: DeviceArray | None = None  # of the rings that are listed
        self.turns: DeviceArray | None = None  # table of turns
        self._rings = device_rings(queue, kernels, ring_length)
        self._gather, self._survey, self._fill = kernels.gather, kernels.survey, kernels.fill
        self._note_places, self._find_not_finite = kernels.note_places, kernels.find_not_finite

    def put(self, state: State, group: Array | None = None) -> None:
        """Copy a state to the device, and make the lists that it had.

        Each row of `place` then has the place in these lists, and the volume, or the number (n,) of
        a group if there are such numbers; `motion` has velocities, and what has failed.
        """
        queue, self.count = self.queue, state.particles
        self.arrays = {name: DeviceArray.of(queue, getattr(state, name)) for name in IN_ROWS}
        self.spare = {
            name: DeviceArray(queue, array.shape, array.dtype)
            for name, array in self.arrays.items()
        }
        self.reference = DeviceArray.of(queue, state.reference)
        rows = (self.count, 4)
        self.extremes, self.most, self.least = (DeviceArray(queue, rows) for _ in range(3))
        self.gradient = DeviceArray(queue, (self.count, 9))
        self.correction = DeviceArray(queue, (self.count, 6))
        self.force = DeviceArray.of(queue, state.force)
        self.active = DeviceArray.of(queue, state.active)
        self.pulled = DeviceArray.of(queue, state.pulled)
        fourth = state.volume if group is None else group
        self.place, self.motion = (
            DeviceArray.of(queue, np.column_stack(columns))
            for columns in ((state.reference, fourth), (state.velocity, state.failed))
        )
        if self.copies:
            self._list_with_copies(self.copies, state)
            return
        low, high = state.reference.min(axis=0), state.reference.max(axis=0)
        grid = grid_between(low, high, state.reach)
        key = self.cells.sorted_keys(self.place, 0, self.count, grid)
        self._list(state.reference, state.reach, grid, key)

    def _list_with_copies(self, copies: "DeviceCopies", state: State) -> None:
        """List neighbours of particles at their references, among copies and images too."""
        copies.find(self.queue, state)
        self.place, self.motion = (
            copies.with_room(rows, self.count, copies.number) for rows in (self.place, self.motion)
        )
        copies.write_rows(self.place, self.motion, self.count)
        self._make_stress(copies.number)
        self.lists = copies.lists(self.cells, state, self.extremes, self.reference)

    def _make_stress(self, others: int) -> None:
        """Make room for rows of stress of particles, and of so many behind them."""
        self.stress = DeviceArray(self.queue, (self.count + others, 4 * self.width))

    def put_glue(self, state: State) -> None:
        """Copy which glued particles are attached, and the velocities of the mesh."""
        self.active.put(state.active)
        self.pulled.put(state.pulled)

    def get(self, state: State) -> None:
        """Copy the particles into a host's state."""
        for name, array in self.arrays.items():
            setattr(state, name, array.get())
        state.reference = self.reference.get()

    def is_finite(self) -> bool:
        """Whether energies, strains, temperatures and damage are finite; overwrites `extremes`."""
        names = ("energy", "strain", "temperature", "damage")
        arrays = (self.arrays[name] for name in names)
        count = np.int32(self.count)
        run(self.queue, self._find_not_finite, self.count, count, *arrays, self.extremes)
        return not (self.cells.greatest(self.extremes, self.count) > 0.0).any()

    def extremes_of(self, rows: DeviceArray) -> tuple[Array, Array, bool]:
        """Least and greatest (3,) of vectors in rows (n, 4), and whether one is not finite."""
        count = np.int32(self.count)
        run(self.queue, self._survey, self.count, count, rows, self.most, self.least)
        low, high = self.ends()
        return low, high[:3], bool(high[3] > 0.0)

    def ends(self) -> tuple[Array, Array]:
        """Least (3,) of the negated rows in `least`, and greatest (4,) of those in `most`."""
        least = self.cells.greatest(self.least, self.count)
        return -least[:3], self.cells.greatest(self.most, self.count)

    def reflect(self, dt: float) -> None:
        """Reflect particles that passed a plane of symmetry in a step of dt [s]."""
        if self._of_planes.mirrors:
            arrays = self.arrays
            self._of_planes.reflect(self.queue, self.count, arrays)
            places = arrays["position"], arrays["velocity"], self.place, self.motion
            numbers = np.int32(self.count), np.float64(dt)
            run(self.queue, self._fill, self.count, *numbers, *places)

    def sort(self, state: State) -> None:
        """Bring particles that are near into near rows by their places, and list neighbours."""
        low, high, _ = self.extremes_of(self.place)
        grid = grid_between(low, high, state.reach)
        key = self.cells.sorted_keys(self.place, 0, self.count, grid)
        for name in IN_ROWS:
            self.take_rows(key, self.arrays[name], self.spare[name])
        self.arrays, self.spare = self.spare, self.arrays
        self.place, self.motion = (
            self.take_rows(key, rows, DeviceArray(self.queue, (self.count, 4)))
            for rows in (self.place, self.motion)
        )
        self.note_places(self.reference)
        points = self.reference.get() if self._of_planes.mirrors else np.zeros((0, 3))
        self._list(points, state.reach, grid, key)

    def note_places(self, target: DeviceArray) -> None:
        """Write the present places of particles (n, 3) m."""
        run(self.queue, self._note_places, self.count, np.int32(self.count), self.place, target)

    def take_rows(
        self, key: DeviceArray, source: DeviceArray, target: DeviceArray, base: int = 0
    ) -> DeviceArray:
        """Copy rows in the order of keys, which count all particles: the first of them is `base`.

        Return the target.
        """
        count, words = target.shape[0], int(np.prod(source.shape[1:]))
        numbers = map(np.int32, (count, 0, base, words))
        run(self.queue, self._gather, count, key, *numbers, source, target)
        return target

    def _list(self, points: Array, reach: float, grid: Grid, key: DeviceArray) -> None:
        """List neighbours of particles at points (n, 3) m; `place` has them in its rows."""
        cells, count = self.cells, self.count
        starts = cells.starts(key, 0, count, grid)
        images = self._of_planes.find(self.queue, points, reach)
        self.place, self.motion = (
            self._of_planes.with_room(rows, count, images) for rows in (self.place, self.motion)
        )
        self._make_stress(images)
        image_starts = DeviceArray.of(self.queue, np.zeros(grid.cells + 2, np.int32))
        if images:
            image_starts = self._of_planes.sort(cells, self.place, self.motion, count, grid)
        self.lists = cells.lists(
            self.place, None, count, count, grid, (starts, image_starts), reach, self.extremes
        )
        if self._rings:
            radius = self._of_planes.of_all(points[:, 0])
            self.lists, self.turn = self._rings.images(
                cells, self.lists, self.place, radius, count, reach, self.extremes
            )
            self.turns = self._rings.turns


def device_rings(queue: Any, kernels: Any, length: float) -> "DeviceRings | None":
    """Azimuthal images of rings of a smoothing length [m], if it is not 0."""
    if length == 0.0:
        return None
    # Left out of scenes without rings.
    from quintet.components.sph_solid.opencl.rings import DeviceRings

    return DeviceRings(queue, kernels, length)
