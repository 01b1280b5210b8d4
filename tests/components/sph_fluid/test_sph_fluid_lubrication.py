"""Films in gaps narrower than a particle: their pressure, and how they fill."""

import math

import numpy as np
import pytest
from fluid_params import fluid_params

from quintet.components.sph_fluid.boundary import lubrication
from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.component import outputs_of

JOINED = frozenset({"surface", "surface_load"})
DEPTH, WIDTH, EDGE, SPACING = 0.2, 0.4, 0.1, 0.025
LOW, HIGH = 0.5 * (WIDTH - EDGE), 0.5 * (WIDTH + EDGE)
AROUND = (
    ((0.0, 0.0, 0.0), (LOW, WIDTH, DEPTH)),
    ((HIGH, 0.0, 0.0), (WIDTH, WIDTH, DEPTH)),
    ((LOW, 0.0, 0.0), (HIGH, LOW, DEPTH)),
    ((LOW, HIGH, 0.0), (HIGH, WIDTH, DEPTH)),
    ((LOW, LOW, EDGE), (HIGH, HIGH, DEPTH)),
)


def cube():
    """Samples of a cube of `EDGE` about the origin, two layers, and their mirror points."""
    line = (np.arange(4) - 1.5) * SPACING
    arm = np.stack([a.ravel() for a in np.meshgrid(line, line, line, indexing="ij")], axis=1)
    below = 0.5 * EDGE - np.abs(arm)
    nearest = below < below.min(axis=1)[:, None] + 1e-9
    return arm, arm + 2.0 * np.where(nearest, np.sign(arm) * below, 0.0)


def standing(gaps, heights=(0.5 * EDGE,), fluid=AROUND):
    params = fluid_params(
        spacing=SPACING,
        sound_speed=20.0 * math.sqrt(9.81 * DEPTH),
        fluid=fluid,
        boundary__method="mdbc",
        density_diffusion=0.1,
        negative_pressure=True,
        boundary__walls=((0.0,) * 3, (WIDTH, WIDTH, 0.35)),
        boundary__lubrication_films=gaps,
    )
    solver = SphFluid(params)
    arm, image = cube()
    centres = [np.array([0.5 * WIDTH, 0.5 * WIDTH, height]) for height in heights]
    static = {
        "surface.normal": np.tile([0.0, 0.0, 1.0], (len(arm) * len(centres), 1)),
        "surface.volume": np.full(len(arm) * len(centres), SPACING**3),
        "surface.body": np.repeat(np.arange(len(centres)), len(arm)).astype(float),
    }
    solver.bind(static, JOINED)
    position = np.concatenate([centre + arm for centre in centres])
    moves = {"surface.position": position, "surface.velocity": np.zeros_like(position)}
    solver.take({**moves, "surface.mirror": np.concatenate([c + image for c in centres])})
    return solver


def mean_force(fluid, steps):
    forces = []
    for number in range(steps):
        fluid.step(fluid.stable_dt())
        if number >= steps // 2:
            forces.append(outputs_of(fluid)["surface_load.force"].reshape(-1, 64, 3).sum(axis=1))
    return np.mean(forces, axis=0)


def test_a_cube_that_stands_in_water_is_lifted_by_the_film_below_it():
    top, bottom = 9810.0 * (DEPTH - EDGE) * EDGE**2, 9810.0 * DEPTH * EDGE**2
    lifted = mean_force(standing(True), 120)[0]
    pressed = mean_force(standing(False), 120)[0]
    assert lifted[2] == pytest.approx(bottom - top, rel=0.05)
    assert pressed[2] == pytest.approx(-top, rel=0.05)
    assert np.abs(lifted[:2]).max() < 0.01 * bottom


def test_a_film_presses_both_bodies_alike():
    fluid = standing(True, heights=(0.5 * EDGE, 1.5 * EDGE + 0.004), fluid=AROUND[:4])
    for _ in range(5):
        fluid.step(fluid.stable_dt())
    before = fluid.state.force.copy()
    fluid.films.advance(fluid.state, fluid.lists.arrays, 1e-4)
    added, between = fluid.state.force - before, fluid.films.films.facing >= 0
    upper = added[fluid.films.films.sample[between]].sum(axis=0)
    lower = added[np.unique(fluid.films.films.facing[between])].sum(axis=0)
    assert between.sum() == 16
    assert upper[2] > 0.0
    np.testing.assert_allclose(lower, -upper, rtol=1e-12, atol=1e-12 * upper[2])


def squeeze(stored, cell, outside=1000.0, sweeps=400):
    """A film of a row of eleven cells between two rims; pressure and share of each."""
    count = 11
    rim = np.zeros(count, bool)
    rim[[0, -1]] = True
    pairs = [[j for j in (i - 1, i + 1) if 0 <= j < count] for i in range(count)]
    begin = np.concatenate([[0], np.cumsum([len(neighbours) for neighbours in pairs])])
    near = np.array([j for neighbours in pairs for j in neighbours])
    width, mobility = np.full(count, 1e-3), np.full(count, 1e-9 / (12.0 * lubrication.WATER))
    place = np.stack([np.arange(count) * 0.01, np.zeros(count), np.zeros(count)], axis=1)
    rims = np.full(count, outside)
    pressure, share = np.zeros(count), np.zeros(count)
    stores = np.full(count, stored)
    places = lubrication.FilmPlaces(rim, begin, near, width, place, rims, stores, mobility)
    lubrication.solve_reynolds(places, cell, (0.0, 0.0, 0.0), sweeps, pressure, share)
    return pressure, share


def test_a_full_film_at_rest_has_the_pressure_of_its_rim():
    pressure, share = squeeze(1e-3, 1.0)
    np.testing.assert_allclose(pressure, 1000.0, rtol=1e-6)
    assert (share == 1.0).all()


def test_faces_that_close_press_a_parabola():
    # d²p/dx² = (dw/dt)/K: p - p_rim = -(dw/dt) x (L - x)/(2K), with the step's 1e-8 m.
    dt, closed = 1e-3, 1e-8
    pressure, _ = squeeze(1e-3 + closed, 0.01**2 / dt)
    x = np.arange(11) * 0.01
    ease = 1e-9 / (12.0 * lubrication.WATER)
    expected = 1000.0 + closed / dt * x * (0.1 - x) / (2.0 * ease)
    np.testing.assert_allclose(pressure, expected, rtol=1e-3)


def test_an_empty_film_has_no_pressure_until_it_is_full():
    pressure, share = squeeze(0.0, 0.01**2 / 1e-5)
    assert 0.0 < share[1] < 1.0
    assert (pressure[1:-1] == 0.0).all()
    assert share[5] == 0.0


def test_a_dry_rim_lets_nothing_in():
    pressure, share = squeeze(0.0, 1.0, outside=0.0)
    assert (pressure == 0.0).all()
    assert (share == 0.0).all()


def test_a_loaded_state_goes_on_with_the_same_bits():
    fluid, loaded = standing(True), standing(True)
    for _ in range(12):
        fluid.step(fluid.stable_dt())
    loaded.load(fluid.save())
    for _ in range(12):
        fluid.step(fluid.stable_dt())
        loaded.step(loaded.stable_dt())
    for name, array in fluid.save().items():
        np.testing.assert_array_equal(array, loaded.save()[name], err_msg=name)
    assert fluid.state.film.any()
