"""Steps of bodies on a device: motion, materials, sums over pairs, and whether lists still hold."""

from typing import Any

import numpy as np

from quintet.components.shared.materials.solid import Solid
from quintet.components.shared.opencl.arrays import DeviceArray, run
from quintet.components.shared.opencl.devices import build
from quintet.components.shared.opencl.sums import Sums
from quintet.components.shared.opencl.types import bytes_of
from quintet.components.sph_solid.laws import PairLaw
from quintet.components.sph_solid.neighbours import FEW, SolidLists
from quintet.components.sph_solid.opencl.device_state import DeviceState
from quintet.components.sph_solid.opencl.features import CopiesOnDevice, device_sums
from quintet.components.sph_solid.opencl.programs import source, width
from quintet.components.sph_solid.pair_sums import PairSums
from quintet.components.sph_solid.state import Array, State
from quintet.interfaces.params import Vector

LANES_OF_PROCESSORS = 4  # doubles in one of its vectors; other devices make lanes of rows
ADVANCED = (
    "heating", "deviator", "density_ratio", "pressure", "energy", "strain", "temperature", "damage",
    "failed", "sound", "position", "velocity", "acceleration",
)  # fmt: skip
ENDED = "velocity", "acceleration", "heating", "energy"


class Stepping:
    """Steps of one solid.

    Parameters
    ----------
    queue : pyopencl.CommandQueue
    is_processor : bool
        Whether the device is the processor.
    law : PairLaw
    materials : list of Solid
    lists : SolidLists
        Of the host: planes of symmetry, and how far pairs act.
    pair_sums : PairSums
        Of the host.
    gravity : Vector, m/s2
    copies : CopiesOnDevice
    """

    def __init__(
        self, queue: Any, is_processor: bool, law: PairLaw, materials: list[Solid],
        lists: SolidLists, pair_sums: PairSums, gravity: Vector, copies: CopiesOnDevice,
    ) -> None:  # fmt: skip
        self.queue, self.lists = queue, lists
        lanes = LANES_OF_PROCESSORS if is_processor else 1
        rings, keeps = lists.is_axisymmetric, lists.are_for_good
        text = source(law, materials[0], lanes, rings, keeps)
        kernels = build(self.queue, text + copies.source)
        self.rows = DeviceState(
            self.queue, kernels, lists.images.planes, lists.mirrors, width(law, keeps),
            is_processor, law.smoothing.length if rings else 0.0, copies.make,
        )  # fmt: skip
        of_pairs = bytes_of(law, np.float64)
        self.pairs = device_sums(self.queue, kernels, of_pairs, pair_sums, lists)
        self._sums = Sums(self.queue, kernels, is_processor)
        self._kick, self._finish, self._advance = kernels.kick, kernels.finish, kernels.advance
        self._displacements, self._mark_fast = kernels.displacements, kernels.mark_fast
        self._meet_few = kernels.meet_few
        self._gravity = np.array([*gravity, 0.0])
        self._laws, self._tables, self._table_start = self._of_materials(materials)
        planes = [(plane.axis, plane.position, plane.inward, 0.0) for plane in lists.mirrors]
        self._planes = DeviceArray.of(self.queue, np.array(planes).reshape(-1, 4))

    def _of_materials(self, materials: list[Solid]) -> tuple[DeviceArray, ...]:
        """Numbers of the materials, tables of their isentropes, and where each of these starts."""
        tables = [law.isentrope for law in materials]
        numbers = np.array([
            bytes_of(law._replace(isentrope=None), np.float64)  # type: ignore[arg-type]
            for law in materials
        ])  # fmt: skip
        start = np.cumsum([0, *map(len, tables)]).astype(np.int32)
        arrays = (numbers, np.concatenate(tables), start)
        return tuple(DeviceArray.of(self.queue, array) for array in arrays)

    def put(self, state: State) -> None:
        """Copy a state to the device, and make the lists that it had."""
        group = None
        if self.lists.are_for_good:
            group = self.lists.group(state).astype(np.float64)
        self.rows.put(state, group)
        self.pairs.make(self.rows, state)

    def kick(self, dt: float) -> tuple[Array, Array]:
        """Bring velocities and places to the middle of a step of dt [s].

        Return the least and greatest (3,) m by which particles will have moved at its end.
        """
        rows, arrays = self.rows, self.rows.arrays
        names = ("position", "velocity", "acceleration", "failed", "volume")
        run(
            self.queue, self._kick, rows.count, np.int32(rows.count), np.float64(dt),
            arrays["glue"], rows.active, rows.pulled, *(arrays[name] for name in names),
            self.pairs.listed(rows), rows.place, rows.motion, rows.most, rows.least,
        )  # fmt: skip
        low, high = rows.ends()
        return low, high[:3]

    def may_miss(self, state: State, low: Array, high: Array, dt: float) -> bool:
        """Whether the lists may lack a pair that acts in a step; as `SolidLists.may_miss`.

        Displacements, from `low` to `high` (3,) m, are those that `kick` returned.
        """
        skin = state.reach - self.lists.support
        if not self.pairs.may_miss(low, high) or self.lists.spread(low, high) <= skin:
            return False
        if self.rows.copies:
            return self._some_rank_may_miss(state, self.lists.spread(low, high), dt)
        rows, arrays, count = self.rows, self.rows.arrays, np.int32(self.rows.count)
        position, velocity = arrays["position"], arrays["velocity"]
        displacements = rows.most, rows.least  # room for those in the middle and at the end
        run(
            self.queue, self._displacements, rows.count, count, np.float64(dt), rows.place,
            position, velocity, rows.reference, *displacements,
        )  # fmt: skip
        means = np.zeros((2, 4))
        if not self.lists.mirrors:
            sums = [self._sums.of(array, rows.count) for array in displacements]
            means = np.array(sums) / rows.count
        marks = DeviceArray(self.queue, (rows.count,), np.uint8)
        limit = np.float64(0.25 * skin * skin)
        run(self.queue, self._mark_fast, rows.count, count, *means, limit, *displacements, marks)
        fast = np.flatnonzero(marks.get())
        if not 0 < len(fast) <= FEW:
            return len(fast) > FEW
        run(
            self.queue, self._meet_few, rows.count, count, np.int32(len(fast)),
            DeviceArray.of(self.queue, fast.astype(np.int32)), np.int32(len(self.lists.mirrors)),
            self._planes, np.float64(self.lists.support), np.float64(skin), np.float64(dt),
            rows.place, position, velocity, rows.reference, rows.extremes,
        )  # fmt: skip
        return bool(rows.cells.greatest(rows.extremes, rows.count)[0] > 0.0)

    def _some_rank_may_miss(self, state: State, spread: float, dt: float) -> bool:
        """Whether lists of some rank may lack a pair, as hosts find it."""
        arrays = self.rows.arrays
        state.position, state.velocity = (arrays[name].get() for name in ("position", "velocity"))
        middle = self.rows.place.get()[: self.rows.count]
        return self.lists.may_miss(state, spread, middle, dt)

    def finish(self, dt: float) -> Array:
        """Advance materials by dt [s], with places and velocities in its middle; end the step.

        Return minus the stable step [s] of all particles, and 1 if a velocity is not finite.
        """
        rows, arrays, count = self.rows, self.rows.arrays, np.int32(self.rows.count)
        duration, places = np.float64(dt), (rows.place, rows.motion)
        rows.images.write_rows(*places, rows.count)
        self.pairs.write_gradients(rows)
        run(
            self.queue, self._advance, rows.count, count, duration, self._laws, self._tables,
            self._table_start, arrays["material"], rows.gradient, rows.correction,
            *(arrays[name] for name in ADVANCED), *places, rows.stress,
        )  # fmt: skip
        rows.images.write_rows(*places, rows.count)
        self.pairs.write_accelerations(rows)
        run(
            self.queue, self._finish, rows.count, count, duration, self._gravity, self._laws,
            arrays["material"], arrays["volume"], arrays["fixed"], arrays["glue"], rows.active,
            rows.force, *(arrays[name] for name in ENDED), rows.extremes, *self.pairs.forces(rows),
        )  # fmt: skip
        return rows.cells.greatest(rows.extremes, rows.count)[:2]
