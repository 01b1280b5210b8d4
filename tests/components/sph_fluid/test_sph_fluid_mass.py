"""Fluid has the mass of its shapes at any spacing, or the scene is refused."""

import math

import numpy as np
import pytest
from fluid_params import fluid_params, nested

from quintet.components.sph_fluid import SphFluidParams
from quintet.components.sph_fluid.component import SphFluid
from quintet.components.sph_fluid.constants import constants
from quintet.interfaces.params import read

SPACING = 0.02


def pool(size, **changes):
    box = ((0.0, 0.0, 0.0), tuple(size))
    settings = {"spacing": SPACING, "sound_speed": 30.0, "fluid": (box,)}
    return fluid_params(**(settings | changes))


@pytest.mark.parametrize(
    "size",
    [
        (0.1, 0.1, 0.1),
        (0.11, 0.11, 0.11),
        (0.1, 0.1, 0.05),
        (0.029, 0.029, 0.029),
        (0.2, 0.2, 0.011),
    ],
    ids=["a multiple", "half a cell over", "one edge", "a cell and a half", "half a layer"],
)
def test_a_box_weighs_what_it_holds(size):
    assert SphFluid(pool(size)).totals().mass == pytest.approx(1000.0 * math.prod(size), rel=1e-9)


def test_a_slab_weighs_what_it_holds():
    params = pool((0.11, 0.3, 0.05), dimensions=2)
    assert SphFluid(params).totals().mass == pytest.approx(1000.0 * 0.11 * 0.3 * 0.05, rel=1e-9)


def test_where_the_spacing_divides_all_edges_a_particle_has_its_cube():
    assert constants(pool((0.1, 0.06, 0.3))).mass == 1000.0 * SPACING**3


def test_a_mass_that_was_fitted_is_told_with_what_it_would_have_been():
    assert SphFluid(pool((0.1, 0.1, 0.1))).notes() == ()
    (note,) = SphFluid(pool((0.029, 0.029, 0.029))).notes()
    assert "would hold 67 % too little mass; the mass of each was raised by 2e+02 %" in note


def mistakes(*boxes):
    settings = {"spacing": SPACING, "sound_speed": 30.0, "fluid": boxes}
    return read(SphFluidParams, nested(settings), "water")[1]


def test_boxes_that_would_hold_too_much_or_too_little_are_refused():
    deep = [[0.0, 0.0, 0.0], [0.2, 0.2, 0.2]]
    assert mistakes(deep, [[0.2, 0.0, 0.0], [0.4, 0.2, 0.1]]) == []
    (sentence,) = mistakes(deep, [[0.2, 0.0, 0.0], [0.8, 0.2, 0.011]])
    assert "fluid[0] must hold its mass to within 2 % of the mass of all fluid" in sentence
    assert "Choose a spacing" in sentence
    # A box is accepted if its error is small beside the mass of all fluid.
    assert mistakes(deep, [[0.2, 0.0, 0.0], [0.22, 0.02, 0.029]]) == []


def test_water_whose_edges_the_spacing_does_not_divide_stays_at_rest():
    size, top = (0.209, 0.2, 0.17), 0.17
    fluid = SphFluid(
        pool(
            size,
            boundary__method="mdbc",
            boundary__walls=((0.0,) * 3, (0.209, 0.2, 0.3)),
            density_diffusion=0.1,
            gauges__level_gauges=((0.1, 0.1),),
            gauges__motion_gauge=True,
        )
    )
    for _ in range(150):
        fluid.step(fluid.stable_dt())
    readings = fluid.give(frozenset({"level_gauge.height", "motion_gauge.speed"}))
    assert readings["level_gauge.height"] == pytest.approx([top], abs=0.1 * SPACING)
    assert readings["motion_gauge.speed"][0] < 0.03 * math.sqrt(9.81 * top)
    assert np.isfinite(fluid.state.position_density).all()
