"""Escapes of a lattice from its minimum of energy, and the temperatures that a scene predicts."""

import tomllib

import numpy as np
import pytest

from quintet.coupler.scene.read import library
from quintet.scenarios.hot_bar_baths.escapes import (
    TIMES,
    break_up,
    climb,
    lattice_of_scene,
    leads_back,
    saddle_at,
    saddles,
    warmth,
)


@pytest.fixture(scope="module")
def lattice():
    return lattice_of_scene()[0]


def test_slopes_and_stiffnesses_are_derivatives_of_the_energy(lattice):
    place = lattice.start + 0.01 * lattice.spacing * np.random.default_rng(0).normal(
        size=lattice.start.shape
    )
    moved = np.zeros_like(place)
    moved[3, 1] = 1e-6 * lattice.spacing
    rise = lattice.energy(place + moved) - lattice.energy(place - moved)
    assert rise == pytest.approx(2.0 * moved[3, 1] * lattice.slope(place)[3, 1], rel=1e-6)
    change = (lattice.slope(place + moved) - lattice.slope(place - moved)).ravel()
    column = 2.0 * moved[3, 1] * lattice.stiffness(place)[10]
    assert change == pytest.approx(column, abs=1e-6 * np.abs(column).max())


def test_a_point_that_is_moved_aside_climbs_to_a_saddle_that_leads_back(lattice):
    mode = np.zeros_like(lattice.start)
    mode[0, 1] = -1.0
    place = climb(lattice, lattice.start + 0.15 * lattice.spacing * mode, mode.ravel())
    values = np.linalg.eigvalsh(lattice.stiffness(place))
    assert values[0] < 0.0 < values[1] and leads_back(lattice, place)
    assert np.abs(lattice.slope(place)).max() < 1e-9 * values[-1] * lattice.spacing
    saddle = saddle_at(lattice, place)
    assert saddle.shares.argmax() == 0 and saddle.shares.sum() == pytest.approx(1.0)
    # Of one way out alone: the rate at this temperature and ln 2 share the time.
    time, even = 40.0, np.ones(len(place))
    hot = break_up(lattice, [saddle], even, time)
    rate = saddle.attempts * np.exp(-saddle.height / lattice.boltzmann / hot)
    assert rate * time == pytest.approx(np.log(2.0), rel=1e-6)


@pytest.mark.full
def test_the_scene_predicts_what_all_escapes_say(lattice):
    share, ways = warmth(lattice_of_scene()[1]), saddles(lattice)
    (limit,) = tomllib.loads(library()["hot_bar_baths"].read_text("utf-8"))["stability"]
    temperatures = [break_up(lattice, ways, share, time) for time in TIMES]
    assert temperatures == pytest.approx(limit["predicted"], rel=0.01)
