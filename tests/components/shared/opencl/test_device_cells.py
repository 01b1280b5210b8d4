"""A device sorts and lists points as the processor does."""

import numpy as np
import pytest

pytest.importorskip("pyopencl")
from quintet.components.shared.opencl import cells
from quintet.components.shared.opencl.arrays import DeviceArray
from quintet.components.shared.opencl.devices import build, device_of
from quintet.components.shared.opencl.program import Program
from quintet.components.shared.search.cells import grid_around, sorted_into
from quintet.components.shared.search.neighbours import neighbours_within
from quintet.components.shared.threads import Team

REACH, SPLIT, COUNT = 0.11, 700, 1000


@pytest.fixture
def queue_and_kernels():
    queue, program = device_of("opencl").queue(), Program()
    kernels = cells.source(program)
    return queue, build(queue, program.text + kernels)


def points():
    """Fluid in a box and walls around it, some of them out of reach."""
    random = np.random.default_rng(3)
    inside, outside = random.random((SPLIT, 3)), 3.0 * random.random((COUNT - SPLIT, 3)) - 1.0
    rows = np.zeros((COUNT, 4))
    rows[:, :3] = np.concatenate([inside, outside])
    return rows


@pytest.mark.parametrize("by_rows", [True, False])
def test_devices_sort_and_list_as_the_processor_does(queue_and_kernels, by_rows):
    queue, kernels = queue_and_kernels
    rows = points()
    grid = grid_around(rows[:SPLIT], REACH)
    groups = [(0, SPLIT), (SPLIT, COUNT - SPLIT)]
    orders = [sorted_into(rows[first : first + count], grid)[2] for first, count in groups]
    device = cells.Cells(queue, kernels, by_rows)
    position = DeviceArray.of(queue, rows)
    for (first, count), order in zip(groups, orders, strict=True):
        key = device.sorted_keys(position, first, count, grid).get()[:count]
        assert np.array_equal((key & 0xFFFFFFFF) - first, order)
    rows = rows[np.concatenate([orders[0], SPLIT + orders[1]])]
    position, extremes = DeviceArray.of(queue, rows), DeviceArray(queue, (COUNT, 4))
    starts = [
        device.starts(device.sorted_keys(position, *group, grid), *group, grid) for group in groups
    ]
    device.width = 1  # too short at first
    lists = device.lists(position, None, SPLIT, COUNT, grid, tuple(starts), REACH, extremes)
    expected = neighbours_within(REACH, rows[:, :3], SPLIT, Team(1))
    near, middle, end = lists.near.get(), lists.middle.get(), lists.end.get()
    assert np.array_equal(middle, expected.middle - expected.begin)
    assert np.array_equal(end, expected.end - expected.begin) and end.max() > 8
    for i in range(COUNT):
        row = near[i * lists.row_stride + np.arange(end[i]) * lists.item_stride]
        assert np.array_equal(row, expected.list[expected.begin[i] : expected.end[i]])


def test_the_greatest_of_each_column_is_exact(queue_and_kernels):
    rows = np.random.default_rng(5).normal(size=(COUNT, 4))
    device = cells.Cells(*queue_and_kernels, by_rows=True)
    greatest = device.greatest(DeviceArray.of(queue_and_kernels[0], rows), SPLIT)
    assert np.array_equal(greatest, rows[:SPLIT].max(axis=0))
