"""Sorting the rows of balls by cell, and listing their pairs, on a device."""

from typing import Any, NamedTuple

import numpy as np

from quintet.components.dem_bodies.opencl.device_pairs import DevicePairs
from quintet.components.dem_bodies.opencl.device_rows import DeviceRows
from quintet.components.dem_bodies.opencl.programs import WIDTH
from quintet.components.dem_bodies.state import Model, Short
from quintet.components.shared.opencl.arrays import DeviceArray, run
from quintet.components.shared.opencl.devices import opencl

KERNELS = (
    "number_balls", "sort_keys", "take_rows", "note_places", "count_near", "list_near",
    "list_incoming", "carry_history", "write_constants",
)  # fmt: skip


class Listed(NamedTuple):
    """New pairs, and the most that a row has."""

    pairs: DevicePairs
    most: int


class Search:
    """Sorts and lists as `contact/ball_search.py` does, in the same order.

    Parameters
    ----------
    kernels : pyopencl.Program
        Of `programs.source`.
    rows : DeviceRows
    model : Model
    skin : float, m
        Gap up to which pairs are listed.
    rolls : bool
        Whether any pair resists rolling.
    """

    def __init__(
        self, kernels: Any, rows: DeviceRows, model: Model, skin: float, rolls: bool
    ) -> None:
        queue = rows.queue
        self._rows, self._model, self._rolls = rows, model, rolls
        self._kernels = {name: opencl().Kernel(kernels, name) for name in KERNELS}
        self._skin = np.float64(skin)
        radius = float(model.bounding_radius.max())
        self._width = np.float64(2.0 * radius + skin)
        self._planes, self._materials = len(model.plane), len(model.material_pairs)
        self._material = DeviceArray(queue, (rows.count,), np.int64)
        self._plane_material = DeviceArray.of(queue, model.plane_material)
        self._material_pairs = DeviceArray.of(queue, model.material_pairs)

    def _run(self, name: str, items: int, *arguments: Any) -> None:
        run(self._rows.queue, self._kernels[name], items, *arguments)

    def put(self) -> None:
        """Copy the materials of the host's rows to the device."""
        self._material.put(self._model.material[: self._rows.count])

    def renew(self, former: DevicePairs) -> Listed:
        """Sort the rows, list their pairs, and take over the history of the former ones."""
        rows, queue, key = self._rows, self._rows.queue, self._sorted_keys()
        self._sort_rows(key)
        balls, motion = np.int32(rows.count), rows.arrays["motion"]
        search_arguments = (balls, np.int32(self._planes), self._skin, key, motion, rows.plane)
        later, earlier = (DeviceArray(queue, (rows.count,), np.int32) for _ in range(2))
        self._run("count_near", rows.count, *search_arguments, later, earlier)
        counts = later.get(), earlier.get()
        pairs = self._room(*counts)
        self._run("list_near", rows.count, *search_arguments, pairs.begin, pairs.row, pairs.partner)
        self._run(
            "list_incoming", rows.count, balls, self._skin, key, motion, pairs.begin,
            pairs.partner, pairs.incoming_begin, pairs.incoming,
        )  # fmt: skip
        self._carry(former, pairs, key)
        return Listed(pairs, int(np.sum(counts, axis=0).max()))

    def _sort_rows(self, key: DeviceArray) -> None:
        """Bring all rows into the order of keys, and note where they are listed."""
        rows, balls = self._rows, np.int32(self._rows.count)
        for array in (*rows.sorted_arrays(), self._material):
            source, words = rows.spare_of(array), np.int32(np.prod(array.shape[1:]))
            source.copy_from(array)
            self._run("take_rows", rows.count, balls, words, key, source, array)
        self._run("note_places", rows.count, balls, rows.arrays["motion"], rows.listed)
        rows.is_sorted_apart = True

    def _room(self, later: Short, earlier: Short) -> DevicePairs:
        """Room for pairs; rows (b,) have so many with later rows and planes, and with earlier."""
        queue = self._rows.queue
        count, listed = int(later.sum()), int(earlier.sum())
        begin, incoming_begin = (
            DeviceArray.of(queue, np.concatenate([[0], np.cumsum(counts)]).astype(np.int32))
            for counts in (later, earlier)
        )
        row, partner, constants_row = (DeviceArray(queue, (count,), np.int32) for _ in range(3))
        spring, moment = (DeviceArray(queue, (count, 4)) if self._rolls else None for _ in range(2))
        return DevicePairs(
            count=count,
            stride=count,
            begin=begin,
            row=row,
            partner=partner,
            constants_row=constants_row,
            constants=DeviceArray(queue, (count, 4 * WIDTH)),
            incoming_begin=incoming_begin,
            incoming=DeviceArray(queue, (listed,), np.int32),
            history=DeviceArray(queue, (4, count)),
            push=DeviceArray(queue, (count, 8)),
            spring=spring,
            moment=moment,
        )

    def _sorted_keys(self) -> DeviceArray:
        """Keys (any, 2) of all balls' cells, and their rows, in rising order."""
        rows, size = self._rows, max(1 << (self._rows.count - 1).bit_length(), 64)
        key = DeviceArray(rows.queue, (size, 2), np.int64)
        sizes = np.int32(rows.count), self._width
        self._run("number_balls", size, *sizes, rows.arrays["motion"], key)
        part = 2
        while part <= size:
            distance = part >> 1
            while distance:
                self._run("sort_keys", size, key, np.int32(part), np.int32(distance))
                distance >>= 1
            part <<= 1
        return key

    def _carry(self, former: DevicePairs, pairs: DevicePairs, key: DeviceArray) -> None:
        """Write the constants of new pairs; copy the history of pairs that were in contact."""
        rows, count = self._rows, np.int32(pairs.count)
        rows_with_ground = np.int32(rows.count + 1)
        self._run(
            "carry_history", pairs.count, count, rows_with_ground, key, pairs.row, pairs.partner,
            np.int32(former.stride), former.begin, former.partner, former.history, former.spring,
            np.int32(pairs.stride), pairs.history, pairs.spring,
        )  # fmt: skip
        self._run(
            "write_constants", pairs.count, count, rows_with_ground, np.int32(self._materials),
            pairs.row, pairs.partner, rows.arrays["motion"], rows.inverse, self._material,
            self._plane_material, self._material_pairs, pairs.constants_row, pairs.constants,
        )  # fmt: skip
