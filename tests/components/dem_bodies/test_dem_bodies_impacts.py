"""Impacts of one contact, against exact solutions (Chung & Ooi, Granular Matter 13 (2011) 643)."""

import math

import numpy as np
import pytest
from dem_scenes import (
    FLOOR,
    GLASS,
    NOTHING,
    STEEL,
    about,
    box,
    build,
    energy,
    material,
    run,
    sphere,
)
from scipy.integrate import solve_ivp

from quintet.components.dem_bodies.contact.materials import damping_ratio, restitution
from quintet.components.dem_bodies.state import DEEPEST_PAIR, ELASTIC_ENERGY
from quintet.interfaces.component import outputs_of

LIMESTONE = {"youngs_modulus": 2.0e10, "poissons_ratio": 0.25, "restitution": 1.0, "friction": 0.0}


def pair(sphere_material, density, speed=10.0, steps=400):
    bodies = [
        sphere([side * 0.01, 0.0, 0.0], density=density, velocity=[-side * speed, 0.0, 0.0])
        for side in (-1.0, 1.0)
    ]
    scene = {"gravity": NOTHING, "impact_speed": 2 * speed, "steps_per_contact": steps}
    return build(bodies, {"a": sphere_material}, **scene)


@pytest.mark.parametrize(
    ("sphere_material", "density", "force", "depth", "duration"),
    [
        (GLASS, 2800.0, 10697.0, 274.11e-6, 40.34e-6),
        (LIMESTONE, 2500.0, 7108.0, 368.30e-6, 54.20e-6),
    ],
    ids=["glass", "limestone"],
)
def test_elastic_impact_of_two_spheres_is_hertz(sphere_material, density, force, depth, duration):
    forces, depths = [0.0], [0.0]
    spheres = pair(sphere_material, density)

    def watch(_):
        x = outputs_of(spheres)["motion.position"][:, 0]
        forces.append(abs(spheres.state.contact_load[0, 0]))
        depths.append(0.02 - (x[1] - x[0]))

    run(spheres, 1.2 * duration, watch, duration / 400)
    assert max(forces) == pytest.approx(force, rel=2e-3)
    assert max(depths) == pytest.approx(depth, rel=2e-3)
    speed = outputs_of(spheres)["motion.velocity"][1, 0]
    assert speed == pytest.approx(10.0, rel=1e-4)


def crossing_time(spheres, dt, end):
    """Time at which the gap opens again, interpolated linearly between steps."""
    gaps = [0.0]
    run(spheres, end, lambda _: gaps.append(np.ptp(spheres.state.position[:2, 0]) - 0.02), dt)
    k = next(k for k in range(2, len(gaps)) if gaps[k] > 0.0)
    return dt * (k - gaps[k] / (gaps[k] - gaps[k - 1]))


@pytest.mark.parametrize(
    ("sphere_material", "density", "duration"),
    [(GLASS, 2800.0, 40.34e-6), (LIMESTONE, 2500.0, 54.20e-6)],
)
def test_duration_of_an_elastic_impact(sphere_material, density, duration):
    measured = crossing_time(pair(sphere_material, density), duration / 400, 1.2 * duration)
    assert measured == pytest.approx(duration, rel=2e-3)


@pytest.mark.parametrize("e", [0.01, 0.1353352, 0.2, 0.4, 0.6, 0.8, 0.98, 1.0])
def test_damping_ratio_realises_restitution_in_the_equation_of_motion(e):
    ζ = damping_ratio(e)
    assert restitution(ζ) == pytest.approx(e, rel=1e-12)
    c = ζ * math.sqrt(5.0)  # x'' = -(x^3/2 + c x^1/4 x')

    def force(x, v):
        return max(x, 0.0) ** 1.5 + c * max(x, 0.0) ** 0.25 * v

    def pulls(_, y):
        return force(*y) + (1.0 if y[1] > 0.0 else 0.0)

    pulls.terminal = True
    solution = solve_ivp(
        lambda _, y: [y[1], -force(*y)], (0.0, 200.0), [1e-14, 1.0],
        events=pulls, rtol=1e-9, atol=1e-12, method="LSODA",
    )  # fmt: skip
    assert -solution.y[1, -1] == pytest.approx(e, rel=1e-4)


@pytest.mark.parametrize("e", [0.2, 0.4, 0.6, 0.8, 1.0])
@pytest.mark.parametrize("target", ["plane", "sphere"])
def test_restitution_is_realised(e, target):
    sphere_material = {
        "youngs_modulus": 3.8e11,
        "poissons_ratio": 0.23,
        "restitution": e,
        "friction": 0.0,
    }
    bodies = [sphere([0.0, 0.0, 2.5e-3 + 1e-6], 5e-3, density=4000.0, velocity=[0.0, 0.0, -3.9])]
    if target == "sphere":
        below = [0.0, 0.0, -2.5e-3]
        bodies.append(sphere(below, 5e-3, density=4000.0, velocity=[0.0, 0.0, 3.9]))
    planes = [FLOOR] if target == "plane" else []
    speed = 3.9 if target == "plane" else 7.8
    spheres = build(
        bodies, {"a": sphere_material}, gravity=NOTHING, impact_speed=speed, planes=planes
    )
    run(spheres, 5e-5)
    assert spheres.state.report[DEEPEST_PAIR] == -1  # apart again
    assert outputs_of(spheres)["motion.velocity"][0, 2] / 3.9 == pytest.approx(e, rel=5e-3)


@pytest.mark.parametrize("tenths", range(10))
def test_restitution_does_not_depend_on_when_a_step_meets_the_contact(tenths):
    sphere_material = {
        "youngs_modulus": 3.8e11,
        "poissons_ratio": 0.23,
        "restitution": 0.2,
        "friction": 0.0,
    }
    body = sphere([0.0, 0.0, 2.5e-3], 5e-3, density=4000.0, velocity=[0.0, 0.0, -3.9])
    ball = build([body], {"a": sphere_material}, gravity=NOTHING, impact_speed=3.9, planes=[FLOOR])
    dt = ball.stable_dt()
    ball.state.position[0, 2] += 0.1 * tenths * dt * 3.9
    run(ball, 5e-5, dt=dt)
    assert outputs_of(ball)["motion.velocity"][0, 2] == pytest.approx(0.2 * 3.9, rel=3e-3)


def test_restitution_holds_for_a_corner_that_strikes_off_centre():
    turn = about([1.0, 2.0, 0.5], 0.6)
    body = box([0.0, 0.0, 0.2], orientation=turn, velocity=[0.0, 0.0, -1.0])
    settings = {"gravity": NOTHING, "planes": [FLOOR], "impact_speed": 1.0}
    cube = build([body], {"a": STEEL | {"friction": 0.0, "restitution": 0.6}}, **settings)
    lowest = int(np.argmin(cube.state.centre[:, 2]))
    while cube.state.report[DEEPEST_PAIR] < 0.0:
        cube.step(cube.stable_dt())
    while cube.state.report[DEEPEST_PAIR] >= 0.0:
        cube.step(cube.stable_dt())
    arm = cube.state.centre[lowest] - cube.state.position[0]
    arm[2] -= cube.model.sphere_radius[lowest]
    motion = outputs_of(cube)
    spin_velocity = np.cross(motion["motion.angular_velocity"][0], arm)
    assert motion["motion.velocity"][0, 2] < 0.3  # the corner is thrown back, the cube turns
    assert motion["motion.velocity"][0, 2] + spin_velocity[2] == pytest.approx(0.6, rel=2e-2)


def test_box_that_falls_flat_bounces_about_as_asked():
    """Rounding insets the four corners, so each carries slightly less than m/4."""
    settings = {"gravity": NOTHING, "planes": [FLOOR], "impact_speed": 1.0}
    materials = {"a": STEEL | {"friction": 0.0, "restitution": 0.6}}
    flat = build([box([0.0, 0.0, 0.075 + 1e-6], velocity=[0.0, 0.0, -1.0])], materials, **settings)
    run(flat, 2e-3)
    assert outputs_of(flat)["motion.velocity"][0, 2] == pytest.approx(0.6, rel=0.05)
    assert np.abs(outputs_of(flat)["motion.angular_velocity"]).max() < 1e-9


@pytest.mark.parametrize("angle", [5.0, 15.0, 25.0])
def test_gross_sliding_in_an_oblique_impact(angle):
    """`angle` is measured from the plane; each impact slips throughout: tan θ > 7/2 μ (1 + e)."""
    θ, μ, e, radius = math.radians(90.0 - angle), 0.092, 0.98, 2.5e-3
    vn, vt = 3.9 * math.cos(θ), 3.9 * math.sin(θ)
    assert math.tan(θ) > 3.5 * μ * (1.0 + e)
    sphere_material = {
        "youngs_modulus": 3.8e11,
        "poissons_ratio": 0.23,
        "restitution": e,
        "friction": μ,
    }
    body = sphere([0.0, 0.0, radius + 1e-8], 5e-3, density=4000.0, velocity=[vt, 0.0, -vn])
    ball = build([body], {"a": sphere_material}, gravity=NOTHING, impact_speed=3.9, planes=[FLOOR])
    run(ball, 1.2e-4, dt=2e-7)
    outputs = outputs_of(ball)
    assert outputs["motion.velocity"][0, 2] == pytest.approx(e * vn, rel=5e-3)
    assert outputs["motion.velocity"][0, 0] == pytest.approx(vt - μ * (1 + e) * vn, rel=5e-3)
    ω = 5.0 * μ * (1.0 + e) * vn / (2.0 * radius)
    assert outputs["motion.angular_velocity"][0, 1] == pytest.approx(ω, rel=5e-3)


def test_collision_conserves_momentum_and_angular_momentum():
    bodies = [
        box([0.0, 0.0, 0.0], velocity=[1.0, 0.2, 0.0], angular_velocity=[3.0, 2.0, 1.0]),
        box([0.2, 0.05, 0.03], (0.1, 0.15, 0.12), angular_velocity=[-2.0, 1.0, 5.0]),
        sphere([-0.2, 0.0, 0.01], 0.1, velocity=[3.0, 0.0, 0.0]),
    ]
    scene = build(bodies, {"a": material(youngs_modulus=1e9)}, gravity=NOTHING, impact_speed=2.0)
    start, start_energy, largest_elastic = scene.totals(), energy(scene), 0.0

    def watch(_):
        nonlocal largest_elastic
        largest_elastic = max(largest_elastic, scene.state.report[ELASTIC_ENERGY])

    run(scene, 0.2, watch)
    end = scene.totals()
    scale = np.abs(start.momentum).max()
    np.testing.assert_allclose(end.momentum, start.momentum, atol=1e-13 * scale, rtol=0)
    np.testing.assert_allclose(
        end.angular_momentum, start.angular_momentum, atol=1e-13 * scale, rtol=0
    )
    assert largest_elastic > 0.1  # J: they did meet
    assert energy(scene) + scene.accumulated.dissipated == pytest.approx(start_energy, rel=2e-3)
    assert scene.accumulated.dissipated > 0.05 * start_energy
