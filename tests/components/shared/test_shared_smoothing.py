"""Smoothing kernels: sums, gradients, and other smoothing lengths."""

import math

import numpy as np
import pytest
from numba import njit

from quintet.components.shared.smoothing import smoothing as kernels
from quintet.components.shared.smoothing.smoothing import KERNELS, smoothing


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("dimensions", [2, 3])
def test_a_kernel_sums_to_one(dimensions: int, kernel: kernels.Kernel) -> None:
    law = smoothing(kernel, dimensions, 0.3)
    line = 0.1 * np.arange(-6, 7)
    x, y, z = np.meshgrid(line, line if dimensions == 3 else np.zeros(1), line)
    r2 = (x * x + y * y + z * z).ravel()
    values = [kernels.kernel.py_func(float(square), law) for square in r2]
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
    law = kernels.with_length.py_func(smoothing(kernel, dimensions, 0.15), 0.2, dimensions)
    for number, expected in zip(law, smoothing(kernel, dimensions, 0.2), strict=True):
        assert number is expected or number == pytest.approx(expected, rel=1e-14)


def test_normalisation_of_the_cubic_spline_is_monaghans() -> None:
    assert smoothing("cubic", 3, 1.0).height * 4.0 == pytest.approx(1.0 / math.pi)


def test_normalisation_of_the_quintic_spline_is_that_of_morris() -> None:
    """In two dimensions 7/(478π) over the square of a smoothing length that is 2h/3."""
    middle = kernels.kernel.py_func(0.0, smoothing("quintic", 2, 1.0))
    assert middle == pytest.approx(66.0 * 7.0 / (478.0 * math.pi) * 2.25, rel=1e-6)


def sheared_sum(kernel: kernels.Kernel, dimensions: int, strain: float) -> float:
    """Σ V W of a lattice, longer along x and shorter along z by a strain, at h of 1.5 spacings."""
    law, line = smoothing(kernel, dimensions, 1.5), np.arange(-4.0, 5.0)
    across = line if dimensions == 3 else np.zeros(1)
    x, y, z = np.meshgrid(line * math.exp(strain), across, line * math.exp(-strain))
    return sum(kernels.kernel.py_func(float(r2), law) for r2 in (x * x + y * y + z * z).ravel())


@pytest.mark.parametrize(
    ("kernel", "dimensions", "stiffness"),
    [
        ("quintic", 2, 0.003),
        ("quintic", 3, 0.004),
        ("wendland", 2, 0.095),
        ("wendland", 3, 0.145),
        ("cubic", 2, -0.50),
        ("cubic", 3, -0.28),
    ],
)
def test_rows_of_particles_resist_shear_least_with_the_quintic_spline(
    kernel: kernels.Kernel, dimensions: int, stiffness: float
) -> None:
    """Density rises by half the stiffness times the square of a strain at constant volume."""
    strain = 0.02
    ends = sum(sheared_sum(kernel, dimensions, sign * strain) for sign in (-1.0, 1.0))
    curvature = (ends - 2.0 * sheared_sum(kernel, dimensions, 0.0)) / strain**2
    assert curvature == pytest.approx(stiffness, abs=0.02 * abs(stiffness) + 0.001)


def test_single_precision_stays_single() -> None:
    law = smoothing("quintic", 3, 1.5)
    single = law._replace(
        **{name: np.float32(getattr(law, name)) for name in ("length", "tiny", "height", "slope")}
    )

    @njit
    def kernel_and_gradient(r2, per_r, law):  # type: ignore[no-untyped-def]
        return kernels.kernel(r2, law), kernels.gradient(r2, per_r, law)

    kernel_and_gradient(np.float32(1.0), np.float32(1.0), single)
    assert str(kernel_and_gradient.nopython_signatures[0].return_type) == "UniTuple(float32 x 2)"
