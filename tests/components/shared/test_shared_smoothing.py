"""Smoothing kernels: their sums, their gradients, and other lengths."""

import math

import numpy as np
import pytest

from quintet.components.shared.smoothing import smoothing as kernels
from quintet.components.shared.smoothing.smoothing import KERNELS, smoothing


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("dimensions", [2, 3])
def test_a_kernel_sums_to_one(dimensions: int, kernel: kernels.Kernel) -> None:
    law = smoothing(kernel, dimensions, 0.3)
    line = 0.1 * np.arange(-6, 7)
    x, y, z = np.meshgrid(line, line if dimensions == 3 else np.zeros(1), line)
    r2 = (x * x + y * y + z * z).ravel()
    values = [kernels.kernel.py_func(float(one), law) for one in r2]
    assert sum(values) * 0.1**dimensions == pytest.approx(1.0, abs=2e-4)


@pytest.mark.parametrize("kernel", KERNELS)
def test_the_gradient_is_the_derivative_of_the_kernel(kernel: kernels.Kernel) -> None:
    law = smoothing(kernel, 3, 0.15)
    for r in (0.02, 0.1, 0.14, 0.17, 0.25, 0.29):
        step = 1e-6
        low, high = (kernels.kernel.py_func((r + d) ** 2, law) for d in (-step, step))
        assert kernels.gradient.py_func(r * r, 1.0 / r, law) * r == pytest.approx(
            (high - low) / (2 * step), rel=1e-5
        )


@pytest.mark.parametrize("kernel", KERNELS)
def test_a_kernel_ends_at_its_support(kernel: kernels.Kernel) -> None:
    law = smoothing(kernel, 3, 0.15)
    assert law.support == 0.3
    assert kernels.kernel.py_func(0.3**2, law) == 0.0 < kernels.kernel.py_func(0.29**2, law)


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("dimensions", [2, 3])
def test_a_kernel_of_another_length_is_the_one_made_with_it(
    dimensions: int, kernel: kernels.Kernel
) -> None:
    found = kernels.with_length.py_func(smoothing(kernel, dimensions, 0.15), 0.2, dimensions)
    for number, other in zip(found, smoothing(kernel, dimensions, 0.2), strict=True):
        assert number is other or number == pytest.approx(other, rel=1e-14)


def test_normalisation_of_the_cubic_spline_is_monaghans() -> None:
    assert smoothing("cubic", 3, 1.0).height * 4.0 == pytest.approx(1.0 / math.pi)
