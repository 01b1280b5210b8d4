"""Planes that vanish and bodies that are released at a time of the run."""

import numpy as np
import pytest
from dem_scenes import FLOOR, box, build, mistakes, run, sphere

LOCKED = ["x", "y", "z", "rotation_x", "rotation_y", "rotation_z"]
GATE = {**FLOOR, "until": 0.05}


def advance(solver, time, dt=1e-4):
    """Step to a time [s]."""
    while solver.accumulated.time < time - 1e-9:
        solver.step(min(dt, solver.stable_dt(), time - solver.accumulated.time))
    return solver


def height(solver):
    return float(solver.give(frozenset({"motion.position"}))["motion.position"][0, 2])


def velocity(solver):
    return float(solver.give(frozenset({"motion.velocity"}))["motion.velocity"][0, 2])


@pytest.mark.parametrize("body", [sphere((0.0, 0.0, 0.01)), box((0.0, 0.0, 0.075))])
def test_a_body_falls_from_the_time_at_which_its_plane_vanishes(body):
    solver = advance(build([body], planes=[GATE]), 0.05)
    assert abs(velocity(solver)) < 1e-3
    advance(solver, 0.15)
    assert velocity(solver) == pytest.approx(-9.81 * 0.1, rel=2e-3)


def test_a_plane_that_stays_holds_beside_one_that_vanishes():
    solver = build([sphere((0.0, 0.0, 0.01))], planes=[GATE, {**FLOOR, "point": [0.0, 0.0, -0.1]}])
    assert height(advance(solver, 0.6)) > -0.1


@pytest.mark.parametrize("shape", ["sphere", "box"])
def test_a_held_body_is_released_at_its_time(shape):
    locks = {"locked": LOCKED, "released_at": 0.05}
    body = sphere((0.0, 0.0, 1.0), **locks) if shape == "sphere" else box((0.0, 0.0, 1.0), **locks)
    solver = build([body])
    assert height(advance(solver, 0.05)) == 1.0
    advance(solver, 0.1)
    assert velocity(solver) == pytest.approx(-9.81 * 0.05, rel=1e-9)


def test_a_step_ends_at_the_time_of_a_release():
    solver = build([box((0.0, 0.0, 1.0), locked=LOCKED, released_at=0.0123456)])
    run(solver, 0.05)
    assert velocity(solver) == pytest.approx(-9.81 * (0.05 - 0.0123456), rel=5e-5)


def test_a_body_that_turned_evenly_keeps_its_angular_momentum_when_released():
    spin = [0.0, 5.0, 0.0]
    body = box((0, 0, 1.0), (0.1, 0.2, 0.3), locked=LOCKED, released_at=0.02, angular_velocity=spin)
    solver = build([body], gravity=[0.0, 0.0, 0.0])
    before = advance(solver, 0.01).totals().angular_momentum
    after = advance(solver, 0.05).totals().angular_momentum
    assert after[1] == pytest.approx(before[1], rel=1e-9)
    solver.take({"load.torque": np.array([[0.0, 1e-2, 0.0]])})
    solver.step(1e-3)
    assert solver.totals().angular_momentum[1] - after[1] == pytest.approx(1e-5, rel=1e-6)


@pytest.mark.parametrize("time", [0.03, 0.07])
def test_a_saved_state_goes_on_with_the_same_bits(time):
    bodies = [sphere((0.0, 0.0, 0.01)), box((0.3, 0.0, 1.0), locked=LOCKED, released_at=0.06)]
    solver = advance(build(bodies, planes=[GATE]), time)
    state, loaded = solver.save(), build(bodies, planes=[GATE])
    advance(loaded, 0.08)  # all has vanished: it comes back
    loaded.load(state)
    ends = [advance(component, 0.1).save() for component in (solver, loaded)]
    assert ends[0].keys() == ends[1].keys()
    assert all(np.array_equal(ends[0][key], ends[1][key]) for key in ends[0])


def test_planes_that_have_vanished_are_not_drawn():
    solver = build([sphere((0.0, 0.0, 0.01))], planes=[GATE])
    assert len(solver.walls()["points"]) > 0
    assert len(advance(solver, 0.06).walls().get("points", ())) == 0


def test_without_times_nothing_is_kept_of_them():
    assert build([sphere((0.0, 0.0, 0.01))], planes=[FLOOR]).timetable is None


def test_a_release_without_a_lock_is_refused():
    mistake = mistakes([sphere((0.0, 0.0, 1.0), released_at=0.1)])[0]
    assert "bodies[0].released_at must be of a body that is locked until then; found no" in mistake
