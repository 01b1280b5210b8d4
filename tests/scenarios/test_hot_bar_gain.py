"""Growth of an exchange of heat between elements and points."""

import pytest

from quintet.scenarios.hot_bar_coupled.gain import (
    AREA,
    LENGTH,
    RESISTANCE,
    least_conductivity,
)


@pytest.mark.parametrize("relaxation", [1.0, 0.5])
def test_long_windows_hold_to_the_gain_of_two_resistances(relaxation: float) -> None:
    gain = 2.0 / relaxation - 1.0
    steady = LENGTH / (AREA * RESISTANCE * gain)
    assert least_conductivity(1e6, relaxation) == pytest.approx(steady, rel=1e-3)


def test_heat_that_fills_the_points_raises_the_gain_of_short_windows() -> None:
    assert least_conductivity(5.0, 1.0) > 1.1 * least_conductivity(1e6, 1.0)
