"""Spheres that are launched later: the step before a launch, and the energy that it brings."""

import pytest

from quintet.components.particle_dynamics.integrators import LIMIT
from quintet.components.particle_dynamics.spheres.component import ParticleSpheres
from quintet.components.particle_dynamics.spheres.params import ParticleSpheresParams, Sphere
from quintet.components.particle_dynamics.spheres.plan import plan

RADIUS, LAUNCH = 0.1, 0.05  # m, s
FIRST = {"centre": (0.0, 0.0, 0.0), "velocity": (100.0, 0.0, 0.0), "launch": LAUNCH}


def sphere(**keys):
    return Sphere(**({"radius": RADIUS, "density": 1000.0} | keys))


def solver_of(*spheres, **keys):
    return ParticleSpheres(ParticleSpheresParams(spheres=spheres, **keys))


def test_a_sphere_that_is_launched_within_a_step_passes_through_no_other():
    solver = solver_of(sphere(**FIRST), sphere(centre=(1.0, 0.0, 0.0)))
    time = 0.0
    while time < 0.1:
        step = min(solver.stable_dt(), 0.1 - time)
        solver.step(step)
        time += step
    velocity = solver.give({"motion.velocity"})["motion.velocity"][:, 0]
    assert velocity == pytest.approx([0.0, 100.0], abs=1e-9)


def test_a_step_before_a_launch_is_as_long_as_without_it():
    other = sphere(centre=(1.0, 0.0, 0.0), velocity=(0.0, 1.0, 0.0))
    alone = solver_of(sphere(centre=(0.0, 0.0, 0.0)), other).stable_dt()
    waiting = solver_of(sphere(**{**FIRST, "launch": 1.1 * alone}), other)
    assert waiting.stable_dt() == alone
    waiting.step(alone)
    assert waiting.stable_dt() == pytest.approx(0.1 * alone)
    waiting.step(waiting.stable_dt())
    assert waiting.stable_dt() < 0.01 * alone


def test_a_launch_is_work_from_outside():
    spinning = sphere(**FIRST, angular_velocity=(0.0, 0.0, 7.0))
    solver = solver_of(spinning, gravity=(0.0, 0.0, -9.81))
    before = solver.totals()
    assert before.work == 0.0
    solver.step(2.0 * LAUNCH)
    after = solver.totals()
    energies = [t.kinetic + t.potential + t.internal for t in (before, after)]
    assert energies[1] - energies[0] == pytest.approx(after.work, rel=1e-12)
    mass = after.mass
    launched = 0.5 * mass * 100.0**2 + 0.5 * 0.4 * mass * RADIUS**2 * 7.0**2
    assert after.work == pytest.approx(launched, rel=1e-12)


def test_launches_count_from_the_begin_of_a_run_from_another_state():
    first = solver_of(sphere(**{**FIRST, "launch": 0.3}))
    first.step(0.25)
    solver = solver_of(sphere(**FIRST))
    solver.begin_from(first.save())
    solver.step(0.5 * LAUNCH)
    assert not solver.state.launched.any()
    solver.step(LAUNCH)
    place = solver.give({"motion.position"})["motion.position"][0, 0]
    assert place == pytest.approx(100.0 * 0.5 * LAUNCH, rel=1e-12)


def test_a_plan_has_the_step_that_tethers_allow():
    tethered = sphere(centre=(0.0, 0.0, 0.0), tether=50.0, parcel=3.0)
    params = ParticleSpheresParams(spheres=(tethered,), collisions=False)
    solver = ParticleSpheres(params)
    assert plan(params).dt == pytest.approx(solver.stable_dt(), rel=1e-12)
    assert solver.frequency * plan(params).dt == pytest.approx(0.03 * LIMIT["velocity_verlet"])
