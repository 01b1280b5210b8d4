"""Longest window of a sphere that a partner moves through a gas."""

from pathlib import Path

import numpy as np
import pytest

from quintet.components.meshless_gas.analysis.driven_window import (
    driven_gas,
    growth,
    longest_window,
    response,
)

SCENE = Path(__file__).resolve().parents[3] / "scenarios" / "shock_layer_particle" / "scene.toml"


def test_an_added_mass_at_once_holds_while_it_is_lighter_than_the_sphere() -> None:
    times, impulses = np.array([0.0, 1e-6, 1.0]), np.array([0.0, 1.0, 1.0])
    assert growth(0.1, 1.01, times, impulses) < 1.0 < growth(0.1, 0.99, times, impulses)


@pytest.mark.full
def test_a_sphere_gains_the_impulse_of_its_added_mass_and_the_window_of_the_scene() -> None:
    gas, radius = driven_gas(SCENE)
    times, impulses = response(gas, radius, 1.0)
    volume = 4.0 / 3.0 * np.pi * radius**3
    assert impulses[-1] == pytest.approx(0.5 * volume, rel=0.03)
    assert longest_window(0.1 * volume, times, impulses, radius) == pytest.approx(0.0234, rel=0.03)
