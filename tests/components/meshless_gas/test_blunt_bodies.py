"""Laws of supersonic flow round blunt bodies, against tables and other people's numbers."""

import math

import numpy as np
import pytest

from quintet.components.meshless_gas.blunt_bodies import (
    Stream,
    fay_riddell,
    normal_shock,
    pitot_pressure,
    shock_radius,
    standoff,
)


@pytest.mark.parametrize(
    ("mach", "ratio"), [(2.0, 5.6404), (3.0, 12.061), (6.0, 46.815), (10.0, 129.22)]
)
def test_pitot_pressure_is_that_of_tables(mach: float, ratio: float) -> None:
    assert pitot_pressure(mach, 1.4) == pytest.approx(ratio, rel=1e-4)


def test_pitot_pressure_below_the_speed_of_sound_is_isentropic() -> None:
    assert pitot_pressure(0.5, 1.4) == pytest.approx(1.18621, rel=1e-5)


def test_normal_shock_keeps_mass_momentum_and_energy() -> None:
    gamma, mach = 1.4, 3.0
    density, pressure = normal_shock(mach, gamma)
    before, after = gamma * mach**2, gamma * mach**2 / density  # ρ u² over the pressure ahead
    assert before + 1.0 == pytest.approx(after + pressure)
    heat = gamma / (gamma - 1.0)
    assert heat + 0.5 * before == pytest.approx(heat * pressure / density + 0.5 * after / density)


def test_billigs_shock_is_a_hyperbola_at_the_tabled_distance() -> None:
    assert standoff(6.0) == pytest.approx(0.1565, abs=1e-4)
    angle = np.array([0.0, 0.5 * math.pi, 2.5])
    radius = shock_radius(angle, 6.0)
    assert radius[0] == pytest.approx(1.1565, abs=1e-4)
    x, y = radius * np.cos(angle), radius * np.sin(angle)
    tangent, curvature = math.tan(math.asin(1.0 / 6.0)), 1.236
    fall = np.sqrt(1.0 + (y * tangent / curvature) ** 2) - 1.0
    assert x == pytest.approx(1.1565 - curvature / tangent**2 * fall, abs=0.02)


def test_fay_riddell_is_that_of_the_study_of_particles_in_a_shock_layer() -> None:
    # M = 6, a sphere of 75 mm, wall of 300 K, stream of 100 K and 2493 Pa: 293 kW/m2.
    air = Stream(6.0, 2493.0, 100.0, 1.4, 287.05, 0.72, (1.78e-5, 273.15, 110.4))
    assert fay_riddell(air, 0.0375, 300.0) == pytest.approx(293e3, rel=2e-3)
    assert fay_riddell(air, 0.15, 300.0) == pytest.approx(0.5 * 293e3, rel=2e-3)
