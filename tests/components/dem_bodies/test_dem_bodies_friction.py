"""Rest, sliding and rolling under friction, against exact solutions."""

import math

import numpy as np
import pytest
from dem_scenes import FLOOR, about, box, build, energy, material, run, sphere, three_cubes

from quintet.interfaces.component import outputs_of

G = 9.81


def slope(angle):
    return [G * math.sin(angle), 0.0, -G * math.cos(angle)]


def block_on_slope(angle, μ):
    materials = {"a": material(youngs_modulus=1e7, friction=μ)}
    return build(
        [box([0.0, 0.0, 0.075])], materials, gravity=slope(angle), planes=[FLOOR], impact_speed=0.5
    )


def test_block_rests_on_a_slope_without_creep():
    μ = 0.45
    cube = block_on_slope(0.9 * math.atan(μ), μ)
    run(cube, 0.5)
    start = outputs_of(cube)["motion.position"][0]
    run(cube, 2.0)
    assert np.abs(outputs_of(cube)["motion.position"][0] - start).max() < 1e-6


def test_block_slides_on_a_steep_slope():
    μ, angle = 0.3, math.radians(30.0)
    cube = block_on_slope(angle, μ)
    run(cube, 0.1)
    start = outputs_of(cube)["motion.velocity"][0, 0]
    run(cube, 0.4)
    acceleration = (outputs_of(cube)["motion.velocity"][0, 0] - start) / 0.4
    assert acceleration == pytest.approx(G * (math.sin(angle) - μ * math.cos(angle)), rel=5e-3)


def test_sliding_sphere_comes_to_roll():
    μ, v0 = 0.3, 1.0
    ball = build(
        [sphere([0.0, 0.0, 0.05], 0.1, velocity=[v0, 0.0, 0.0])],
        {"a": material(youngs_modulus=1e9, friction=μ)}, planes=[FLOOR], impact_speed=0.2,
    )  # fmt: skip
    rolling_time = 2.0 * v0 / (7.0 * μ * G)
    run(ball, 0.5 * rolling_time)
    assert outputs_of(ball)["motion.velocity"][0, 0] == pytest.approx(
        v0 - μ * G * rolling_time / 2, rel=2e-3
    )
    run(ball, 0.5 * rolling_time)
    assert outputs_of(ball)["motion.velocity"][0, 0] == pytest.approx(5.0 / 7.0 * v0, rel=2e-3)
    run(ball, 0.1)
    outputs = outputs_of(ball)
    assert outputs["motion.velocity"][0, 0] == pytest.approx(5.0 / 7.0 * v0, rel=2e-3)
    assert outputs["motion.angular_velocity"][0, 1] * 0.05 == pytest.approx(
        5.0 / 7.0 * v0, rel=2e-3
    )


def test_sphere_rolls_down_a_slope():
    angle = math.radians(20.0)
    ball = build(
        [sphere([0.0, 0.0, 0.05], 0.1)],
        {"a": material(youngs_modulus=1e7, friction=0.5)},
        gravity=slope(angle), planes=[FLOOR], impact_speed=0.2,
    )  # fmt: skip
    run(ball, 0.3)
    acceleration = outputs_of(ball)["motion.velocity"][0, 0] / 0.3
    assert acceleration == pytest.approx(5.0 / 7.0 * G * math.sin(angle), rel=5e-3)


def test_stacked_cubes_stand_still():
    cubes = three_cubes()
    run(cubes, 0.1)
    start = outputs_of(cubes)
    run(cubes, 0.9)
    end = outputs_of(cubes)
    assert np.abs(end["motion.position"] - start["motion.position"]).max() < 1e-7
    assert np.abs(end["motion.orientation"] - start["motion.orientation"]).max() < 1e-6
    assert np.abs(end["motion.velocity"]).max() < 1e-6


def test_cubes_stacked_crosswise_stand_still():
    """No corner of the upper cube lies above the lower cube: the crossing edges carry it."""
    turn = about([0.0, 0.0, 1.0], math.pi / 4)
    bodies = [box([0.0, 0.0, 0.075]), box([0.0, 0.0, 0.225], orientation=turn)]
    materials = {"a": material(youngs_modulus=1e8, friction=0.4)}
    cubes = build(bodies, materials, planes=[FLOOR], impact_speed=0.5)
    run(cubes, 0.5)
    outputs = outputs_of(cubes)
    np.testing.assert_allclose(outputs["motion.position"][:, 2], [0.075, 0.225], atol=5e-4)
    assert np.abs(outputs["motion.velocity"]).max() < 1e-5


def test_tumbling_pile_gains_no_energy():
    bodies = [box([0.0, 0.0, 0.08]), box([0.05, 0.04, 0.27], angular_velocity=[1.0, 3.0, 5.0])]
    bodies += [box([-0.03, 0.1, 0.6], (0.1, 0.2, 0.15), angular_velocity=[9.0, 1.0, 2.0])]
    bodies += [sphere([0.06, 0.0, 0.8], 0.1, velocity=[0.0, 0.0, -2.0])]
    pile = build(
        bodies, {"a": material(youngs_modulus=1e9, friction=0.4)}, planes=[FLOOR], impact_speed=3.0
    )
    start, last_energy, rises = energy(pile), energy(pile), []

    def watch(_):
        nonlocal last_energy
        rises.append(energy(pile) - last_energy)
        last_energy = energy(pile)

    run(pile, 0.8, watch)
    assert energy(pile) + pile.accumulated.dissipated == pytest.approx(start, rel=1e-5)
    assert sum(rise for rise in rises if rise > 0.0) < 1e-6 * start
    assert energy(pile) < 0.8 * start


def test_friction_follows_the_pair():
    planes = [FLOOR | {"material": "b"}]
    materials = {
        "a": material(youngs_modulus=1e7, friction=0.9),
        "b": material(youngs_modulus=1e7, friction=0.8),
    }
    laws = [{"between": ["a", "b"], "friction": 0.1}]
    cube = build(
        [box([0.0, 0.0, 0.075])],
        materials,
        planes=planes,
        pairs=laws,
        gravity=slope(0.3),
        impact_speed=0.5,
    )
    run(cube, 0.2)
    expected = 0.2 * G * (math.sin(0.3) - 0.1 * math.cos(0.3))
    assert outputs_of(cube)["motion.velocity"][0, 0] == pytest.approx(expected, rel=1e-2)
