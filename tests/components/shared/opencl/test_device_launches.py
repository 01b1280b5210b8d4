"""Kernels that are run again set the arguments that changed."""

import numpy as np
import pytest

pytest.importorskip("pyopencl")
from quintet.components.shared.opencl.arrays import DeviceArray
from quintet.components.shared.opencl.devices import build, device_of
from quintet.components.shared.opencl.launches import Kernel, Launch

TEXT = """
__kernel void add(double summand, double2 others, int count, __global double *sums)
{
    const int i = get_global_id(0);
    if (i < count) sums[i] += summand + others.x;
}
"""
ROWS = 70  # more than a group


def test_arguments_that_change_are_set_and_others_stay():
    queue = device_of("opencl").queue()
    first, second = (DeviceArray.of(queue, np.zeros(ROWS)) for _ in range(2))
    launch = Launch(queue, build(queue, TEXT).add, ROWS, np.int32(ROWS), first)
    for summand, other in ((1.0, 10.0), (2.0, 10.0), (2.0, 20.0), (2.0, 20.0)):
        launch.run(np.float64(summand), np.array([other, 0.0]))
    assert (first.get() == 11.0 + 12.0 + 22.0 + 22.0).all()
    launch.fix(np.int32(ROWS - 1), second)
    launch.run(np.float64(2.0), np.array([20.0, 0.0]))
    assert (second.get()[:-1] == 22.0).all() and second.get()[-1] == 0.0


def test_a_kernel_without_rows_is_not_run():
    queue = device_of("opencl").queue()
    empty = DeviceArray.of(queue, np.zeros(0))
    launch = Launch(queue, build(queue, TEXT).add, 0, np.int32(0), empty)
    for _ in range(2):
        launch.run(np.float64(1.0), np.zeros(2))
    assert empty.get().shape == (0,)


def test_a_kernel_is_run_for_other_rows_and_arrays():
    queue = device_of("opencl").queue()
    first, second = (DeviceArray.of(queue, np.zeros(ROWS)) for _ in range(2))
    kernel = Kernel(queue, build(queue, TEXT).add)
    others = np.zeros(2)
    kernel.run(0, np.float64(1.0), others, np.int32(0), first)  # nothing
    for rows, array, summand in ((5, first, 1.0), (ROWS, second, 1.0), (ROWS, second, 2.0)):
        kernel.run(rows, np.float64(summand), others, np.int32(rows), array)
    kernel.run(5, np.float64(2.0), others, np.int32(5), first)
    assert (first.get()[:5] == 3.0).all() and not first.get()[5:].any()
    assert (second.get() == 3.0).all()
