"""Drag and heat of single spheres, by their correlations."""

import math

import pytest

from quintet.components.meshless_gas.point_particles import laws

GAMMA = 1.4
# Loth 2021 and Henderson with a sphere as warm as the gas; computed apart from this code.
MACHS = (0.6, 1.2, 2.0, 3.0, 6.0)
TABLE = {
    100.0: ((1.137, 1.425, 1.475, 1.473, 1.397), (1.098, 1.372, 1.450, 1.371, 1.341)),
    300.0: ((0.729, 1.104, 1.256, 1.294, 1.273), (0.713, 1.054, 1.280, 1.216, 1.197)),
    1000.0: ((0.527, 0.975, 1.145, 1.169, 1.146), (0.528, 0.889, 1.157, 1.102, 1.083)),
    7267.0: ((0.493, 0.951, 1.071, 1.062, 1.022), (0.437, 0.798, 1.052, 1.002, 0.979)),
    1e5: ((0.517, 0.966, 1.020, 0.989, 0.939), (0.421, 0.774, 1.003, 0.956, 0.929)),
}


def coefficient(name, reynolds, mach):
    law = laws.DRAG[name]
    factor = laws.drag_factor(law, reynolds, mach, mach / reynolds, 1.0, GAMMA)
    return 24.0 / reynolds * factor


@pytest.mark.parametrize("reynolds", TABLE)
@pytest.mark.parametrize(("name", "row"), [("loth", 0), ("henderson", 1)])
def test_drag_coefficients_are_those_of_the_table(name, row, reynolds):
    coefficients = [coefficient(name, reynolds, mach) for mach in MACHS]
    assert coefficients == pytest.approx(TABLE[reynolds][row], abs=6e-4)


def test_incompressible_drag_has_its_known_values():
    """Of the standard drag curve (Clift, Grace & Weber, Bubbles, Drops, and Particles, 1978)."""
    standard = {1.0: 27.2, 10.0: 4.26, 100.0: 1.09, 1000.0: 0.471, 1e4: 0.40, 1e5: 0.48}
    for reynolds, value in standard.items():
        assert coefficient("clift_gauvin", reynolds, 0.0) == pytest.approx(value, rel=0.06)


@pytest.mark.parametrize("name", laws.DRAG)
def test_drag_at_rest_in_a_dense_gas_is_that_of_stokes(name):
    assert laws.drag_factor(laws.DRAG[name], 0.0, 0.0, 0.0, 1.0, GAMMA) == 1.0
    factor = laws.drag_factor(laws.DRAG[name], 1e-4, 1e-8, 1e-4, 1.0, GAMMA)
    assert factor == pytest.approx(1.0, abs=2e-3)


@pytest.mark.parametrize("name", ["henderson", "loth"])
def test_drag_of_free_molecules_at_rest_is_that_of_epstein(name):
    """f = 1/(c Kn), c = 3.3 (Cunningham's slip for Kn → ∞, 2.514 + 0.8), to 10 %."""
    rarefied = 1e3
    knudsen = math.sqrt(0.5 * math.pi * GAMMA) * rarefied
    factor = laws.drag_factor(laws.DRAG[name], 1e-8, 1e-5, rarefied, 1.0, GAMMA)
    assert factor * knudsen == pytest.approx(1.0 / 3.3, rel=0.1)


def test_heat_of_still_gas_has_a_nusselt_number_of_two():
    for law in laws.HEAT.values():
        assert laws.nusselt(law, 0.0, 0.0, 0.0, 0.72) == 2.0


def test_heat_of_moving_gas_has_its_known_values():
    ranz_marshall = 2.0 + 0.6 * 10.0 * 0.72 ** (1.0 / 3.0)
    assert laws.nusselt(laws.RANZ_MARSHALL, 100.0, 0.0, 0.0, 0.72) == pytest.approx(ranz_marshall)
    # Two correlations of the same dense gas, at a small Mach number.
    fox = laws.nusselt(laws.FOX, 100.0, 0.01, 1e-4, 0.72)
    assert fox == pytest.approx(ranz_marshall, rel=0.05)
    assert laws.nusselt(laws.FOX, 1.0, 2.0, 2.0, 0.72) < 0.4  # few molecules arrive
