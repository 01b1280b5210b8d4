"""Bodies that begin from the state of another run, with other planes, materials and locks."""

import numpy as np
import pytest
from dem_scenes import FLOOR, box, build, material, mistakes, params, sphere

from quintet.components.dem_bodies.component import DemBodies
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import read

WALL = {"point": [-0.02, 0.0, 0.0], "normal": [1.0, 0.0, 0.0], "material": "a"}
ROLLING = {"a": material(youngs_modulus=1e7, rolling_friction=0.05)}
PILE = [sphere((-0.0099, 0.0, 0.0101)), sphere((0.0111, 0.001, 0.0102)), sphere((0.0, 0.0, 0.028))]
KEEPS = {"longest_step": 1e-4}


def settle(bodies, time, materials=None, **settings):
    """Bodies after a time [s]."""
    solver = build(bodies, materials, **KEEPS, **settings)
    return advance(solver, time)


def advance(solver, time):
    """Step through a time [s]."""
    end = solver.accumulated.time + time
    while solver.accumulated.time < end:
        solver.step(solver.stable_dt())
    return solver


def begin(state, bodies, materials=None, **settings):
    """Other bodies that begin from a saved state."""
    solver = DemBodies(params(bodies, materials, **KEEPS, **settings))
    solver.begin_from(state)
    return solver


def positions(solver):
    return solver.give(frozenset({"motion.position"}))["motion.position"]


def velocities(solver):
    return solver.give(frozenset({"motion.velocity"}))["motion.velocity"]


def test_nothing_changed_goes_on_with_the_same_bits_and_a_clock_at_0():
    original = settle(PILE, 0.05, ROLLING, planes=[FLOOR, WALL])
    restarted = begin(original.save(), PILE, ROLLING, planes=[FLOOR, WALL])
    assert restarted.accumulated.time == 0.0
    for _ in range(200):
        dt = original.stable_dt()
        assert restarted.stable_dt() == dt
        original.step(dt)
        restarted.step(dt)
    before, after = original.save(), restarted.save()
    assert before.keys() == after.keys()
    assert all(np.array_equal(before[k], after[k]) for k in before if k != "accumulated")


def test_a_packing_settled_here_is_a_start_though_soft_spheres_overlap_their_planes():
    materials = {"a": material(youngs_modulus=1e4, restitution=0.1)}
    original = settle(PILE, 0.3, materials, planes=[FLOOR, WALL])
    depth = 0.01 - positions(original)[:, 2].min()
    assert depth > 1e-5  # more than a scene may start with
    restarted = begin(original.save(), PILE, materials, planes=[FLOOR, WALL])
    assert np.array_equal(positions(restarted), positions(original))
    ends = [positions(advance(solver, 0.01)) for solver in (original, restarted)]
    assert np.array_equal(*ends)


def test_contacts_keep_their_history_where_planes_are_numbered_otherwise():
    """Elastic friction holds a sphere on a slope; without its history the sphere would slip."""
    slope = {"point": [0.0, 0.0, 0.0], "normal": [0.3, 0.0, 1.0], "material": "a"}
    ceiling = {"point": [0.0, 0.0, 9.0], "normal": [0.0, 0.0, -1.0], "material": "a"}
    bodies = [sphere((0.0, 0.0, 0.0105)), sphere((0.0, 0.05, 0.0105))]
    materials = {"a": material(youngs_modulus=1e6, friction=0.6, rolling_friction=0.5)}
    original = settle(bodies, 0.2, materials, planes=[slope])
    restarted = begin(original.save(), bodies, materials, planes=[ceiling, slope])
    springs = [
        solver.lists.balls.history[:3, solver.lists.balls.history[3] > 0.0]
        for solver in (original, restarted)
    ]
    assert springs[0].shape == (3, 2) and np.abs(springs[0]).max() > 1e-4
    assert np.allclose(springs[0], springs[1], rtol=1e-9)
    moments = [solver.lists.balls.rolling_moment for solver in (original, restarted)]
    assert np.allclose(np.abs(moments[0]).max(), np.abs(moments[1]).max(), rtol=1e-9)
    x = positions(restarted)
    assert np.abs(positions(advance(restarted, 0.02)) - x).max() < 1e-6


@pytest.mark.parametrize("shape", ["sphere", "box"])
def test_bodies_fall_freely_where_their_floor_is_gone(shape):
    body = sphere((0.0, 0.0, 0.01)) if shape == "sphere" else box((0.0, 0.0, 0.075))
    original = settle([body], 0.1, planes=[FLOOR])
    restarted = begin(original.save(), [body], planes=[])
    start = positions(restarted)[0, 2]
    advance(restarted, 0.1)
    fall = 0.5 * 9.81 * restarted.accumulated.time**2
    assert start - positions(restarted)[0, 2] == pytest.approx(fall, rel=1e-3)


def test_another_friction_lets_a_block_slide():
    slope = {"point": [0.0, 0.0, 0.0], "normal": [0.3, 0.0, 1.0], "material": "a"}
    bodies = [sphere((0.0, 0.0, 0.0105))]
    rough, smooth = ({"a": material(friction=f, rolling_friction=0.5)} for f in (0.6, 0.0))
    original = settle(bodies, 0.1, rough, planes=[slope])
    restarted = advance(begin(original.save(), bodies, smooth, planes=[slope]), 0.1)
    sine = 0.3 / np.hypot(0.3, 1.0)
    speed = np.linalg.norm(velocities(restarted)[0])
    assert speed == pytest.approx(9.81 * sine * restarted.accumulated.time, rel=1e-2)


def test_a_held_block_is_let_go():
    """The new scene has no locks: the block falls and turns freely."""
    locked = ["x", "y", "z", "rotation_x", "rotation_y", "rotation_z"]
    locked_bodies = [box((0.0, 0.0, 1.0), locked=locked)]
    state = settle(locked_bodies, 0.05).save()
    free = advance(begin(state, [box((0.0, 0.0, 1.0))]), 0.1)
    assert velocities(free)[0, 2] == pytest.approx(-9.81 * free.accumulated.time, rel=1e-9)
    free.take({"load.torque": np.array([[0.0, 0.1, 0.0]])})
    free.step(1e-3)
    inertia = float(free.solids[0].inertia[1, 1])
    spin = free.give(frozenset({"motion.angular_velocity"}))["motion.angular_velocity"]
    assert spin[0, 1] == pytest.approx(0.1 * 1e-3 / inertia, rel=1e-9)


def test_locked_directions_move_as_the_new_scene_says():
    falling = settle([box((0.0, 0.0, 1.0))], 0.05)
    locked = ["x", "y", "z", "rotation_x", "rotation_y", "rotation_z"]
    piston = [box((0.0, 0.0, 1.0), locked=locked, velocity=[0.0, 0.0, 0.2])]
    restarted = advance(begin(falling.save(), piston), 0.01)
    assert velocities(restarted)[0].tolist() == [0.0, 0.0, 0.2]


def test_another_gravity_holds_at_once():
    original = settle([sphere((0.0, 0.0, 1.0))], 0.01)
    restarted = begin(original.save(), [sphere((0.0, 0.0, 1.0))], gravity=[0.0, 0.0, 0.0])
    v = velocities(restarted)
    assert np.array_equal(velocities(advance(restarted, 0.01)), v)


@pytest.mark.parametrize(
    ("bodies", "settings", "message"),
    [
        (PILE[:2], {}, r"bodies must be as many as in the state .*, 3; found 2"),
        (
            [*PILE[:2], sphere((0.0, 0.0, 0.028), 0.03)],
            {},
            r"bodies\[2\] must be as large .* 0\.01 m",
        ),
        ([*PILE[:2], sphere((0.0, 0.0, 0.028), locked=["x"])], {}, r"locked there must be locked"),
        (
            PILE,
            {"planes": [FLOOR, WALL, {**FLOOR, "point": [0.0, 0.0, 0.005]}]},
            r"planes\[2\] was not",
        ),
    ],
)
def test_a_state_of_other_bodies_is_refused(bodies, settings, message):
    state = settle(PILE, 0.01, planes=[FLOOR, WALL]).save()
    table = {"planes": [FLOOR, WALL]} | settings
    with pytest.raises(SceneError, match=message):
        parsed, _ = read_restart(bodies, **table)
        DemBodies(parsed).begin_from(state)


def read_restart(bodies, **settings):
    """Parameters of bodies that begin from a state; start positions are not checked."""
    from quintet.components.dem_bodies.params import DemBodiesParams

    table = {"bodies": bodies, "materials": {"a": material()}, **settings}
    return read(DemBodiesParams, table, "bodies", starts=False)


def test_where_bodies_would_stand_is_checked_only_of_those_that_start_there():
    low = [sphere((0.0, 0.0, 0.0))]
    assert "must start above planes[0]" in mistakes(low, planes=[FLOOR])[0]
    assert read_restart(low, planes=[FLOOR])[1] == []
