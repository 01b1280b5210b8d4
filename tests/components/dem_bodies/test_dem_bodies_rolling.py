"""Rolling resistance, against exact solutions, and its values for material pairs."""

import math

import numpy as np
import pytest
from dem_scenes import FLOOR, build, energy, material, run, sphere

from quintet.interfaces.component import outputs_of

G, RADIUS = 9.81, 0.05


def rolling_sphere(μ_r, angle=0.0, speed=0.0, young=2e7):
    materials = {"a": material(youngs_modulus=young, friction=0.8, rolling_friction=μ_r)}
    body = sphere([0.0, 0.0, RADIUS], 2.0 * RADIUS, velocity=[speed, 0.0, 0.0])
    body |= {"angular_velocity": [0.0, speed / RADIUS, 0.0]}
    weight = [G * math.sin(angle), 0.0, -G * math.cos(angle)]
    return build([body], materials, planes=[FLOOR], gravity=weight, impact_speed=0.1)


def test_rolling_sphere_stops_after_the_exact_distance_and_stays():
    μ_r, speed = 0.1, 0.5
    ball = rolling_sphere(μ_r, speed=speed, young=1e9)
    start = energy(ball)
    time = 1.4 * speed / (μ_r * G)  # it decelerates by 5/7 μ_r g
    run(ball, 1.1 * time)
    distance = outputs_of(ball)["motion.position"][0, 0]
    assert distance == pytest.approx(0.7 * speed**2 / (μ_r * G), rel=5e-3)
    assert energy(ball) + ball.accumulated.dissipated == pytest.approx(start, rel=1e-6)
    run(ball, 0.5)  # its spring swings to rest
    end = outputs_of(ball)["motion.position"][0, 0]
    run(ball, 0.2)
    assert outputs_of(ball)["motion.position"][0, 0] == pytest.approx(end, abs=1e-7)
    assert end == pytest.approx(distance, abs=1e-4)


def test_sphere_rests_on_a_slope_below_the_rolling_angle():
    ball = rolling_sphere(0.1, angle=math.atan(0.09))
    run(ball, 1.2)  # the sudden weight makes the spring yield once, then it swings to rest
    start = outputs_of(ball)["motion.position"][0]
    run(ball, 0.5)
    assert np.abs(outputs_of(ball)["motion.position"][0] - start).max() < 1e-6


def test_sphere_rolls_down_a_slope_above_the_rolling_angle():
    angle, μ_r = math.atan(0.2), 0.1
    ball = rolling_sphere(μ_r, angle=angle)
    run(ball, 0.2)
    before = outputs_of(ball)["motion.velocity"][0, 0]
    run(ball, 0.3)
    acceleration = (outputs_of(ball)["motion.velocity"][0, 0] - before) / 0.3
    exact = 5.0 / 7.0 * G * (math.sin(angle) - μ_r * math.cos(angle))
    assert acceleration == pytest.approx(exact, rel=5e-3)


def test_two_spheres_that_roll_on_each_other_keep_their_angular_momentum():
    materials = {"a": material(youngs_modulus=2e7, friction=0.8, rolling_friction=0.2)}
    bodies = [
        sphere([0.0, 0.0, 0.0], velocity=[0.1, 0.0, 0.1], angular_velocity=[0.0, 40.0, 3.0]),
        sphere([0.0, 0.0, 0.0201]),
    ]
    pair = build(bodies, materials, gravity=[0.0, 0.0, 0.0], impact_speed=0.1)
    start = pair.totals()
    run(pair, 0.02)
    end = pair.totals()
    assert abs(pair.state.angular_velocity[1, 1]) > 0.1  # they met
    scale = np.abs(start.angular_momentum).max()
    np.testing.assert_allclose(end.angular_momentum, start.angular_momentum, atol=1e-12 * scale)


@pytest.mark.parametrize(("between", "expected"), [(["a", "floor"], 0.05), (["a", "a"], 0.0)])
def test_rolling_is_the_lower_of_both_unless_a_pair_says_otherwise(between, expected):
    materials = {"a": material(rolling_friction=0.1), "floor": material(rolling_friction=0.0)}
    pairs = [{"between": between, "rolling_friction": 0.05}]
    ball = build([sphere([0.0, 0.0, 0.05], 0.1)], materials, pairs=pairs)
    assert ball.model.material_pairs[0, 1, 4] == ball.model.material_pairs[1, 0, 4] == expected


def test_nothing_that_rolls_is_compiled_without_it():
    ball = build([sphere([0.0, 0.0, 0.05], 0.1)], planes=[FLOOR])
    assert ball.lists.balls.rolling_moment is None
