"""Predicted limits of the coupling of cube and water, against those of simple partners."""

import numpy as np
import pytest

from quintet.scenarios.floating_cube.window_limit import growth, masses

MASS, WINDOW = 2.0, 0.1  # kg, s
TIMES = np.linspace(0.0, 40.0 * WINDOW, 401)  # s


@pytest.mark.parametrize(("share", "is_stable"), [(0.97, True), (1.03, False)])
def test_staggered_windows_hold_an_impedance_to_twice_the_mass(
    share: float, is_stable: bool
) -> None:
    impedance = share * 2.0 * MASS / WINDOW  # kg/s
    assert (
        growth(masses(TIMES, 0.5 * impedance * TIMES**2, WINDOW), MASS) < 1.0 + 1e-9
    ) is is_stable


def test_added_mass_comes_back_a_window_later_over_the_mass() -> None:
    added = masses(TIMES, 3.0 * TIMES, WINDOW)
    assert added[0] == pytest.approx(3.0)
    assert growth(added, MASS) == pytest.approx(1.5)
