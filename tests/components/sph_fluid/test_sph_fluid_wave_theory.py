"""Theory of wave makers: transfer functions, second order, spectra."""

import math

import numpy as np
import pytest

from quintet.components.sph_fluid.setup.paddle_motion import ForeseenSurface, PaddleMotion
from quintet.components.sph_fluid.setup.wave_spectra import components, jonswap
from quintet.components.sph_fluid.setup.wave_theory import (
    Paddle,
    bound_amplitude,
    modes,
    second_order,
    transfer,
    wave_number,
)

G, DEPTH = 9.81, 0.4


@pytest.mark.parametrize("period", [0.4, 1.1, 4.0, 40.0])
def test_wave_numbers_obey_the_dispersion_relation(period):
    omega = 2.0 * math.pi / period
    k = modes(omega, Paddle(DEPTH, None, G), 5)
    assert k[0].real == wave_number(omega, DEPTH, G)
    assert omega**2 / (G * k * np.tanh(k * DEPTH)) == pytest.approx(np.ones(6), rel=1e-9)
    assert (k[1:].imag < 0.0).all()


@pytest.mark.parametrize("period", [0.7, 1.1, 4.0])
def test_transfer_functions_are_those_of_biesel(period):
    omega = 2.0 * math.pi / period
    kh = wave_number(omega, DEPTH, G) * DEPTH
    piston = 2.0 * math.sinh(kh) ** 2 / (math.sinh(kh) * math.cosh(kh) + kh)
    flap = 4.0 * math.sinh(kh) / kh * (kh * math.sinh(kh) - math.cosh(kh) + 1.0)
    flap /= math.sinh(2.0 * kh) + 2.0 * kh
    for hinge, factor in ((None, piston), (DEPTH, flap)):
        assert transfer(omega, Paddle(DEPTH, hinge, G), 0)[1][0] == pytest.approx(factor, rel=1e-9)


def madsen(height, kh, stroke):
    """Amplitude [m] of sin 2ωt in a piston's motion; Madsen 1971."""
    ratio = 3.0 * math.cosh(kh) / math.sinh(kh) ** 3 - 2.0 * stroke / height
    return height**2 / (32.0 * DEPTH) * ratio


def by_volume(height, k, amplitude, area):
    """The same [m] by the volume of long Stokes waves that a paddle of an area [m] pushes."""
    a, t = 0.5 * height, math.tanh(k * DEPTH)
    return (a * a / 8.0 * (3.0 - t * t) / t**3 - 0.5 * amplitude * a) / area


@pytest.mark.parametrize(("period", "tolerance"), [(4.0, 0.01), (16.0, 1e-3), (32.0, 2e-4)])
def test_second_order_tends_to_madsen_in_long_waves(period, tolerance):
    omega, height = 2.0 * math.pi / period, 0.1 / period
    k = wave_number(omega, DEPTH, G)
    paddle = Paddle(DEPTH, None, G)
    stroke = height / transfer(omega, paddle, 0)[1][0].real
    motion = second_order(0.5 * stroke, omega, paddle)
    assert motion.real == pytest.approx(madsen(height, k * DEPTH, stroke), rel=tolerance)
    assert abs(motion.imag) < tolerance * motion.real


@pytest.mark.parametrize(("period", "tolerance"), [(16.0, 0.003), (32.0, 1e-3)])
def test_second_order_of_a_flap_tends_to_that_by_volume(period, tolerance):
    omega, height = 2.0 * math.pi / period, 0.1 / period
    k = wave_number(omega, DEPTH, G)
    paddle = Paddle(DEPTH, DEPTH, G)
    amplitude = 0.5 * height / transfer(omega, paddle, 0)[1][0].real
    motion = second_order(amplitude, omega, paddle)
    expected = by_volume(height, k, amplitude, 0.5 * DEPTH)
    assert motion.real == pytest.approx(expected, rel=tolerance)


def test_second_order_grows_with_the_square_of_the_motion():
    omega, paddle = 2.0 * math.pi / 1.1, Paddle(DEPTH, 0.3, G)
    once, twice = (second_order(a, omega, paddle) for a in (0.01, 0.02))
    assert twice == pytest.approx(4.0 * once)


def test_spectrum_has_its_height_and_peak_and_the_bits_of_its_seed():
    amplitude, omega, phase = components(0.1, 1.4, 3.3, 200, 7)
    assert 4.0 * math.sqrt(0.5 * (amplitude**2).sum()) == pytest.approx(0.1, rel=1e-12)
    assert omega[np.argmax(amplitude)] == pytest.approx(2.0 * math.pi / 1.4, rel=0.02)
    assert (np.diff(omega) > 0.0).all() and (0.0 <= phase).all() and phase.max() < 2.0 * math.pi
    same_seed, other_seed = components(0.1, 1.4, 3.3, 200, 7), components(0.1, 1.4, 3.3, 200, 8)
    for rows, expected in zip(same_seed, (amplitude, omega, phase), strict=True):
        assert np.array_equal(rows, expected)
    assert not np.array_equal(other_seed[2], phase)
    r = np.array([0.7, 1.0, 1.6])
    pierson = r**-5.0 * np.exp(-1.25 * r**-4.0)
    assert jonswap(r, 1.0) == pytest.approx(pierson)
    assert jonswap(r, 3.3)[1] / jonswap(r, 1.0)[1] == pytest.approx(3.3)


def test_rates_of_a_paddle_are_derivatives_of_its_place():
    vector = np.array([0.0, 0.0, 0.0, 2.5])
    motion = PaddleMotion(vector, np.array([0.03, 0.01 - 0.02j]), np.array([4.0, 8.0]), 2.0)
    for time in (0.0, 0.9, 1.7, 3.3):
        step = 1e-5
        before, now, after = (motion.at(time + share * step) for share in (-1.0, 0.0, 1.0))
        if time > 0.0:
            rate = (after.place - before.place) / (2.0 * step)
            assert now.rate == pytest.approx(rate, abs=1e-8)
            second = (after.rate - before.rate) / (2.0 * step)
            assert now.second == pytest.approx(second, abs=1e-6)
        else:
            assert not now.place.any() and not now.rate.any()
    largest = max(abs(motion.at(2.0 + t).place[3]) for t in np.linspace(0.0, 3.2, 400))
    assert np.abs(motion.course()[:, 3]).max() == pytest.approx(largest, rel=1e-3)


def test_the_surface_far_from_a_paddle_is_the_wave():
    omega, paddle, height = 2.0 * math.pi / 1.1, Paddle(DEPTH, None, G), 0.1
    k, factors = transfer(omega, paddle, 20)
    amplitude = 0.5 * height / factors[0].real
    motion = PaddleMotion(np.array([1.0, 0, 0, 0]), np.array([amplitude]), np.array([omega]), 1.0)
    distance, number = 3.0, k[0].real
    surface = ForeseenSurface(motion, paddle, distance, height)
    second = bound_amplitude(height, number, DEPTH)
    for time in (2.0, 2.3, 2.9):
        phase = omega * time - number * distance
        expected = 0.05 * math.cos(phase) + second * math.cos(2.0 * phase)
        assert surface.at(time) == pytest.approx(expected, abs=1e-6)


def test_the_surface_is_foreseen_where_a_paddle_has_gone_and_as_its_motion_grows():
    omega, paddle, height = 2.0 * math.pi / 1.1, Paddle(DEPTH, None, G), 0.1
    k, factors = transfer(omega, paddle)
    amplitude, number = 0.5 * height / factors[0].real, k[0].real
    motion = PaddleMotion(np.array([1.0, 0, 0, 0]), np.array([amplitude]), np.array([omega]), 2.0)
    surface = ForeseenSurface(motion, paddle, 3.0, height)
    second = bound_amplitude(height, number, DEPTH)
    for time, displacement in ((2.5, 0.08), (2.9, -0.05), (1.0, 0.02)):
        phase, r = omega * time - number * (3.0 + displacement), motion.growth(time)[0]
        expected = 0.05 * r * math.cos(phase) + second * r * r * math.cos(2.0 * phase)
        assert surface.at(time, displacement) == pytest.approx(expected, abs=1e-5)
