"""Units are legal, and known by their powers of base units."""

import pytest

from quintet.interfaces.units import INTEGRATED, UNITS, dimensions


@pytest.mark.parametrize(
    ("unit", "powers"),
    [
        ("1", {}),
        ("rad/s", {"s": -1}),
        ("1/s", {"s": -1}),
        ("m2/s2", {"m": 2, "s": -2}),
        ("W/m2", {"kg": 1, "s": -3}),
        ("W/(m K)", {"kg": 1, "m": 1, "s": -3, "K": -1}),
        ("kg/(m s)", {"kg": 1, "m": -1, "s": -1}),
        ("mol/(m3 s) K", {"mol": 1, "m": -3, "s": -1, "K": 1}),
    ],
)
def test_a_unit_is_known_by_its_powers_of_base_units(unit, powers):
    assert dimensions(unit) == powers


@pytest.mark.parametrize(
    ("unit", "same_unit"), [("N m", "J"), ("Pa", "N/m2"), ("N m/s", "W"), ("J/kg", "m2/s2")]
)
def test_units_of_one_dimension_have_the_same_powers(unit, same_unit):
    assert dimensions(unit) == dimensions(same_unit)


@pytest.mark.parametrize(("unit", "integral"), INTEGRATED.items())
def test_an_integral_has_a_second_more(unit, integral):
    powers = dimensions(unit)
    powers["s"] = powers.get("s", 0) + 1
    assert {base: power for base, power in powers.items() if power} == dimensions(integral)


def test_every_unit_can_be_read():
    assert set().union(*map(dimensions, UNITS)) == {"kg", "m", "s", "K"}
