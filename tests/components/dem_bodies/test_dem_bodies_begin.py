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


def settle(bodies, time, materials=None, **given):
    """Bodies after a time [s]."""
    solver = build(bodies, materials, **KEEPS, **given)
    return advance(solver, time)


def advance(solver, time):
    """Step through a time [s]."""
    end = solver.accumulated.time + time
    while solver.accumulated.time < end:
        solver.step(solver.stable_dt())
    return solver


def begin(state, bodies, materials=None, **given):
    """Other bodies that begin from a saved state."""
    solver = DemBodies(params(bodies, materials, **KEEPS, **given))
    solver.begin_from(state)
    return solver


def positions(solver):
    return solver.give(frozenset({"motion.position"}))["motion.position"]


def velocities(solver):
    return solver.give(frozenset({"motion.velocity"}))["motion.velocity"]


def test_nothing_changed_goes_on_with_the_same_bits_and_a_clock_at_0():
    first = settle(PILE, 0.05, ROLLING, planes=[FLOOR, WALL])
    again = begin(first.save(), PILE, ROLLING, planes=[FLOOR, WALL])
    assert again.accumulated.time == 0.0
    for _ in range(200):
        dt = first.stable_dt()
        assert again.stable_dt() == dt
        first.step(dt)
        again.step(dt)
    before, after = first.save(), again.save()
    assert before.keys() == after.keys()
    assert all(np.array_equal(before[k], after[k]) for k in before if k != "accumulated")


def test_a_packing_settled_here_is_a_start_though_soft_spheres_overlap_their_planes():
    materials = {"a": material(youngs_modulus=1e4, restitution=0.1)}
    first = settle(PILE, 0.3, materials, planes=[FLOOR, WALL])
    depth = 0.01 - positions(first)[:, 2].min()
    assert depth > 1e-5  # more than a scene may start with
    again = begin(first.save(), PILE, materials, planes=[FLOOR, WALL])
    assert np.array_equal(positions(again), positions(first))
    ends = [positions(advance(solver, 0.01)) for solver in (first, again)]
    assert np.array_equal(*ends)


def test_contacts_keep_their_history_where_planes_are_numbered_otherwise():
    """On a slope elastic friction holds a block: without its history it would slip back."""
    slope = {"point": [0.0, 0.0, 0.0], "normal": [0.3, 0.0, 1.0], "material": "a"}
    far = {"point": [0.0, 0.0, 9.0], "normal": [0.0, 0.0, -1.0], "material": "a"}
    bodies = [sphere((0.0, 0.0, 0.0105)), sphere((0.0, 0.05, 0.0105))]
    materials = {"a": material(youngs_modulus=1e6, friction=0.6, rolling_friction=0.5)}
    first = settle(bodies, 0.2, materials, planes=[slope])
    again = begin(first.save(), bodies, materials, planes=[far, slope])
    held = [
        solver.lists.balls.history[:3, solver.lists.balls.history[3] > 0.0]
        for solver in (first, again)
    ]
    assert held[0].shape == (3, 2) and np.abs(held[0]).max() > 1e-4
    assert np.allclose(held[0], held[1], rtol=1e-9)
    moments = [solver.lists.balls.rolling_moment for solver in (first, again)]
    assert np.allclose(np.abs(moments[0]).max(), np.abs(moments[1]).max(), rtol=1e-9)
    x = positions(again)
    assert np.abs(positions(advance(again, 0.02)) - x).max() < 1e-6


@pytest.mark.parametrize("shape", ["sphere", "box"])
def test_bodies_fall_freely_where_their_floor_is_gone(shape):
    body = sphere((0.0, 0.0, 0.01)) if shape == "sphere" else box((0.0, 0.0, 0.075))
    first = settle([body], 0.1, planes=[FLOOR])
    again = begin(first.save(), [body], planes=[])
    start = positions(again)[0, 2]
    advance(again, 0.1)
    fallen = 0.5 * 9.81 * again.accumulated.time**2
    assert start - positions(again)[0, 2] == pytest.approx(fallen, rel=1e-3)


def test_another_friction_lets_a_block_slide():
    slope = {"point": [0.0, 0.0, 0.0], "normal": [0.3, 0.0, 1.0], "material": "a"}
    bodies = [sphere((0.0, 0.0, 0.0105))]
    rough, smooth = ({"a": material(friction=f, rolling_friction=0.5)} for f in (0.6, 0.0))
    first = settle(bodies, 0.1, rough, planes=[slope])
    again = advance(begin(first.save(), bodies, smooth, planes=[slope]), 0.1)
    sine = 0.3 / np.hypot(0.3, 1.0)
    speed = np.linalg.norm(velocities(again)[0])
    assert speed == pytest.approx(9.81 * sine * again.accumulated.time, rel=1e-2)


def test_a_held_block_is_let_go():
    """Its locks are not those of the run before; about a free axis it turns."""
    locked = ["x", "y", "z", "rotation_x", "rotation_y", "rotation_z"]
    held = [box((0.0, 0.0, 1.0), locked=locked)]
    state = settle(held, 0.05).save()
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
    moved = advance(begin(falling.save(), piston), 0.01)
    assert velocities(moved)[0].tolist() == [0.0, 0.0, 0.2]


def test_another_gravity_holds_at_once():
    first = settle([sphere((0.0, 0.0, 1.0))], 0.01)
    again = begin(first.save(), [sphere((0.0, 0.0, 1.0))], gravity=[0.0, 0.0, 0.0])
    v = velocities(again)
    assert np.array_equal(velocities(advance(again, 0.01)), v)


@pytest.mark.parametrize(
    ("bodies", "more", "said"),
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
def test_a_state_of_other_bodies_is_refused(bodies, more, said):
    state = settle(PILE, 0.01, planes=[FLOOR, WALL]).save()
    table = {"planes": [FLOOR, WALL]} | more
    with pytest.raises(SceneError, match=said):
        solver, _ = read_begun(bodies, **table)
        DemBodies(solver).begin_from(state)


def read_begun(bodies, **given):
    """Parameters of bodies that begin elsewhere: where they would stand is not checked."""
    from quintet.components.dem_bodies.params import DemBodiesParams

    table = {"bodies": bodies, "materials": {"a": material()}, **given}
    return read(DemBodiesParams, table, "bodies", starts=False)


def test_where_bodies_would_stand_is_checked_only_of_those_that_start_there():
    low = [sphere((0.0, 0.0, 0.0))]
    assert "must start above planes[0]" in mistakes(low, planes=[FLOOR])[0]
    assert read_begun(low, planes=[FLOOR])[1] == []
