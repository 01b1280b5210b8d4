"""Penalty contact of particles with faces: directions, reactions, friction, history."""

import numpy as np
import pytest
from contact_points import FACES, MODULUS, NODES, RADIUS, THICK, contact_of, points_at, take


@pytest.mark.parametrize(
    ("place", "direction", "depth"),
    [
        ((1.0, 1.0, 0.4), (0, 0, 1), 0.1),  # above a face
        ((2.0, 1.0, 0.3), (0, 0, 1), 0.2),  # above the edge that two faces share
        ((1.0, 1.0, -0.1), (0, 0, 1), 0.6),  # its centre below the face
        ((4.3, 1.0, -1.0), (1, 0, 0), 0.2),  # beside the wall
        ((4.2, 1.0, 0.2), (1, 0, 1), 0.5 - 0.2 * 2**0.5),  # off the edge of a body
        ((-0.3, 1.0, 0.3), (-1, 0, 1), 0.5 - 0.3 * 2**0.5),  # off the edge of the surface
        ((-0.3, 1.0, -0.1), (0, 0, 1), 0.0),  # beside the surface, below its plane
        ((1.0, 1.0, -0.6), (0, 0, 1), 0.0),  # deeper than a radius
    ],
)
def test_a_particle_is_pushed_from_the_nearest_point_of_the_surface(place, direction, depth):
    contact, points = contact_of(1), points_at([place])
    take(contact)
    contact.kick(points, 1.0)
    stiffness = 1.0 / (2.0 * RADIUS / MODULUS + THICK / MODULUS)
    unit = np.array(direction) / np.linalg.norm(direction)
    np.testing.assert_allclose(points.velocity[0], stiffness * depth * unit, atol=1e-12)
    assert contact.numbers.energy == pytest.approx(0.5 * stiffness * depth**2)


def test_reactions_have_the_sum_and_the_moment_of_the_forces():
    rng = np.random.default_rng(1)
    node = NODES + 0.1 * rng.standard_normal(NODES.shape)
    place = rng.uniform([0, 0, 0.2], [4, 2, 0.6], (40, 3))
    velocity = rng.standard_normal((40, 3))
    contact, points = contact_of(40, node, friction=0.4), points_at(place, velocity.copy())
    take(contact, node)
    contact.kick(points, 1e-2)
    force = (points.velocity - velocity) / 1e-2
    assert (force != 0.0).any(axis=1).sum() > 10
    force_scale = np.abs(force).sum()
    assert np.abs(force.sum(axis=0) + contact.reaction.sum(axis=0)).max() < 1e-12 * force_scale
    # Friction acts at the surface and particles have no spin: the moment is kept without it.
    frictionless = contact_of(40, node)
    points = points_at(place)
    take(frictionless, node)
    frictionless.kick(points, 1.0)
    moment = np.cross(place, points.velocity).sum(axis=0)
    moment += np.cross(node, frictionless.reaction).sum(axis=0)
    assert np.abs(moment).max() < 1e-12 * np.abs(points.velocity).sum()


def test_a_particle_that_is_spread_over_faces_keeps_force_and_moment():
    place = [(1.7, 1.0, 0.4)]  # its right third lies on the second face
    contact, points = contact_of(1, points=3), points_at(place)
    take(contact)
    contact.kick(points, 1.0)
    assert points.velocity[0, 2] == pytest.approx(0.1)
    assert contact.reaction[[2, 5], 2].sum() == pytest.approx(-0.1 * (1.7 + 1 / 3 - 2.0) / 2.0 / 3)
    moment = np.cross(np.array(place), points.velocity) + np.cross(NODES, contact.reaction).sum(0)
    np.testing.assert_allclose(moment, 0.0, atol=1e-15)
    assert contact.reaction.sum(axis=0)[2] == pytest.approx(-points.velocity[0, 2])
    # A particle that reaches beyond the faces is not spread.
    reactions = []
    for count in (1.0, 3.0):
        contact, points = contact_of(1, points=count), points_at([(1.0, 0.2, 0.4)])
        take(contact)
        contact.kick(points, 1.0)
        reactions.append(contact.reaction)
    np.testing.assert_array_equal(*reactions)


def test_the_nearest_face_is_the_same_whether_or_not_the_others_are_looked_at():
    rng = np.random.default_rng(5)
    place = rng.uniform([0.0, 0.0, 0.2], [4.0, 2.0, 0.6], (60, 3))
    velocity = 0.05 * rng.standard_normal((60, 3))
    thorough, quick = contact_of(60), contact_of(60)
    skipped = 0
    for step in range(40):
        node = NODES + 0.01 * np.sin(0.2 * step + np.arange(24.0)).reshape(8, 3)
        reactions = []
        for contact in (thorough, quick):
            points = points_at(place, velocity.copy())
            take(contact, node)
            if contact is thorough and contact.near is not None:
                contact.near.recheck_slack[:] = np.inf
            contact.kick(points, 0.05)
            reactions.append(contact.reaction)
        np.testing.assert_array_equal(*reactions)
        skipped += int((quick.near.recheck_slack < quick.slack).sum())
        place = place + 0.05 * velocity
    assert skipped > 500


def test_triangles_and_edges_in_a_plane_are_touched_like_squares():
    node = np.array([[0, 0, 0], [2, 0, 0], [2, 2, 0]], float)
    triangle = contact_of(1, node, np.array([[0, 1, 2, 2]]))
    points = points_at([(1.5, 0.5, 0.4)])
    take(triangle, node)
    triangle.kick(points, 1.0)
    np.testing.assert_allclose(points.velocity, [[0.0, 0.0, 0.1]], atol=1e-12)
    np.testing.assert_allclose(triangle.reaction[:, 2], -0.1 * np.array([0.25, 0.5, 0.25]))
    # An edge from +x to -x has its body below: (dz, -dx) points upwards.
    node = np.array([[2, 0, 0], [0, 0, 0]], float)
    edge = contact_of(2, node, np.array([[0, 1, 1, 0]]))
    points = points_at([(0.5, 0.7, 0.4), (0.5, 0.7, -0.3)])
    points.place[:, 1] = 0.0
    take(edge, node)
    edge.kick(points, 1.0)
    np.testing.assert_allclose(points.velocity, [[0, 0, 0.1], [0, 0, 0.8]], atol=1e-12)
    np.testing.assert_allclose(edge.reaction[:, 2], [-0.225, -0.675])


# Two faces that rise from the edge x = z = 0 to both sides, or fall from it, at 45 degrees.
@pytest.mark.parametrize(
    ("rise", "place", "push"),
    [
        (1.0, (0.05, 1.0, -0.2), (-0.05, 0.0, 0.2)),  # behind the edge of the valley
        (1.0, (0.0, 1.0, -0.3), (0.0, 0.0, 0.3)),
        (1.0, (1.0, 1.0, 0.8), (-0.1, 0.0, 0.1)),  # below the face that rises to the right
        (1.0, (2.2, 1.0, 1.9), (0.0, 0.0, 0.0)),  # below its plane, beside its border
        (-1.0, (0.0, 1.0, -0.2), (-0.1, 0.0, 0.1)),  # below both faces of a ridge: the first
        (-1.0, (0.05, 1.0, 0.2), (0.0, 0.0, 0.0)),  # above the ridge
    ],
)
def test_a_point_of_a_surface_is_pushed_out_of_a_valley_from_behind_its_edge(rise, place, push):
    node = np.array([[x, y, rise * abs(x)] for y in (0.0, 2.0) for x in (-2.0, 0.0, 2.0)])
    face = np.array([[0, 1, 4, 3], [1, 2, 5, 4]])
    contact, points = contact_of(1, node, face, on_surface=True), points_at([place])
    take(contact, node)
    contact.kick(points, 1.0)  # 1 N/m on 1 kg
    np.testing.assert_allclose(points.velocity[0], push, atol=1e-12)
    np.testing.assert_allclose(contact.reaction.sum(axis=0), -np.array(push), atol=1e-12)


def test_of_two_faces_at_the_same_distance_the_first_is_touched():
    place, results = [(2.0, 1.0, 0.3)], []
    for last_face in (-1, 0, 1):
        contact = contact_of(1, friction=0.3)
        take(contact)
        contact.kick(points_at([(1.9, 1.0, 0.3)]), 1e-3)
        contact.near.last[:], contact.near.recheck_slack[:] = last_face, np.inf
        contact.kick(points_at(place, np.ones((1, 3))), 1e-3)
        results.append([contact.near.last.copy(), contact.reaction.copy(), contact.slip.copy()])
    assert results[0][0] == 0
    for result in results[1:]:
        for array, expected in zip(result, results[0], strict=True):
            np.testing.assert_array_equal(array, expected)


# The upper face of a cube's left half, and the side between both halves, which the right one opens.
LAYERS = np.array([[0, 1, 4, 3], [1, 2, 5, 4], [1, 6, 7, 4]])
STEPS_DOWN = np.array([*NODES[:6], [2, 0, -0.3], [2, 2, -0.3]], float)


def test_an_eroded_face_is_not_touched_and_one_that_erosion_opens_is():
    place = [(1.0, 1.0, 0.4), (2.3, 1.0, -0.1)]  # above the left half, in the right one
    contact = contact_of(2, STEPS_DOWN, LAYERS)
    for active, pushes in (
        ((1.0, 1.0, 0.0), [(0.0, 0.0, 0.1), (0.0, 0.0, 0.6)]),
        ((0.0, 0.0, 1.0), [(0.0, 0.0, 0.0), (0.2, 0.0, 0.0)]),
    ):
        points = points_at(place)
        take(contact, STEPS_DOWN, np.array(active))
        contact.kick(points, 1.0)
        np.testing.assert_allclose(points.velocity, pushes, atol=1e-12)
        assert not contact.warnings() or contact.numbers.deepest > 1.0


def test_springs_that_erosion_shortens_lose_energy_which_counts_as_dissipated():
    contact = contact_of(1, STEPS_DOWN, LAYERS)
    stiffness = 1.0 / (2.0 * RADIUS / MODULUS + THICK / MODULUS)
    place = [(2.3, 1.0, -0.1)]  # 0.6 deep below the upper face, 0.2 into the side
    take(contact, STEPS_DOWN, np.array([1.0, 1.0, 0.0]))
    contact.kick(points_at(place), 1e-2)
    assert contact.numbers.energy == pytest.approx(0.5 * stiffness * 0.6**2)
    take(contact, STEPS_DOWN, np.array([1.0, 0.0, 1.0]))
    contact.kick(points_at(place), 1e-2)
    assert contact.numbers.energy == pytest.approx(0.5 * stiffness * 0.2**2)
    lost = 0.5 * stiffness * (0.6**2 - 0.2**2)
    assert contact.numbers.dissipated == pytest.approx(lost, rel=1e-3)  # but for half a step's kick


def test_a_state_saved_before_faces_open_goes_on_with_the_same_bits():
    place, opened = [(2.3, 1.0, -0.1)], np.array([1.0, 0.0, 1.0])
    contact, results = contact_of(1, STEPS_DOWN, LAYERS, friction=0.3), []
    take(contact, STEPS_DOWN, np.array([1.0, 1.0, 0.0]))
    for _ in range(2):
        contact.kick(points_at(place, np.ones((1, 3))), 1e-2)
    saved = {key: array.copy() for key, array in contact.save().items()}
    for again in (contact, contact_of(1, STEPS_DOWN, LAYERS, friction=0.3)):
        if again is not contact:
            again.load(saved)
        take(again, STEPS_DOWN, opened)
        again.kick(points_at(place, np.ones((1, 3))), 1e-2)
        results.append(again.save())
    assert results[0]["contact/numbers"][1] != saved["contact/numbers"][1]
    for key, array in results[0].items():
        np.testing.assert_array_equal(array, results[1][key])


def test_a_spring_whose_face_erodes_is_let_go_and_its_energy_is_lost():
    contact, points = contact_of(1, friction=9.0), points_at([(1.0, 1.0, 0.3)], np.ones((1, 3)))
    for _ in range(2):
        take(contact)
        contact.kick(points, 1e-2)
    stiffness = 1.0 / (2.0 * RADIUS / MODULUS + THICK / MODULUS)
    spring_energy, dissipated_before = (
        0.5 * stiffness * ((contact.slip[0] ** 2).sum() + 0.2**2),
        contact.numbers.dissipated,
    )
    assert contact.slip.any()
    take(contact, active=np.zeros(3))
    contact.kick(points, 1e-2)
    assert not contact.slip.any() and not contact.held.any()
    half_kick = 0.5 * 1e-2 * stiffness * 0.2 * points.velocity[0, 2]  # J, of both sides
    lost = contact.numbers.dissipated - dissipated_before
    assert lost == pytest.approx(spring_energy + half_kick, rel=1e-3)


def test_friction_holds_below_its_limit_and_slides_at_it():
    contact, points = contact_of(1, friction=0.5), points_at([(1.0, 1.0, 0.3)])
    stiffness = 1.0 / (2.0 * RADIUS / MODULUS + THICK / MODULUS)
    push, dt, work = stiffness * 0.2, 1e-3, 0.0
    for step in range(2000):
        take(contact)
        points.velocity[:] = (1.0, 0.0, 0.0)  # drawn along
        points.place[:] = (1.0 + step * dt * 1e-3, 1.0, 0.3)
        contact.kick(points, dt)
        force = (points.velocity[0, 0] - 1.0) / dt
        expected = -min(stiffness * step * dt, 0.5 * push)
        assert force == pytest.approx(expected, rel=1e-9)
        work -= force * dt
    spring_energy = 0.5 * (0.5 * push) ** 2 / stiffness
    # The force is that at the start of a step: subtract half a step of the last force.
    friction_work = work - 0.5 * 0.5 * push * dt
    assert contact.numbers.dissipated == pytest.approx(friction_work - spring_energy, rel=1e-3)
    assert contact.slip[0, 0] == pytest.approx(0.5 * push / stiffness)


def test_a_spring_of_friction_gains_nothing_on_a_stiffer_face():
    contact, points = contact_of(1, friction=9.0), points_at([(1.0, 1.0, 0.3)])
    contact.faces[0][1] = 100.0 * MODULUS
    points.velocity[:] = (1.0, 0.0, 0.0)
    for _ in range(2):
        take(contact)
        contact.kick(points, 1e-2)
    held, stretch = contact.held[0], contact.slip[0, 0]
    points.place[:], points.velocity[:] = (3.0, 1.0, 0.3), 0.0
    take(contact)
    contact.forget_rows()
    contact.kick(points, 1e-2)
    # It keeps its force: 2 R/M + h/M falls to half.
    assert contact.slip[0, 0] == pytest.approx(stretch * 1.01 / 2.0)
    assert contact.held[0] == pytest.approx(held * 1.01 / 2.0)
    assert contact.held[0] + contact.numbers.dissipated == pytest.approx(held)


def test_what_a_spring_of_friction_holds_along_a_normal_that_turns_is_dissipated():
    contact, points = contact_of(1, friction=9.0), points_at([(3.0, 1.0, 0.3)])
    points.velocity[:] = (1.0, 0.0, 0.0)
    for _ in range(2):
        take(contact)
        contact.kick(points, 1e-2)
    held = contact.held[0]
    points.place[:], points.velocity[:] = (4.3, 1.0, -1.0), 0.0  # beside the wall
    take(contact)
    contact.forget_rows()
    contact.kick(points, 1e-2)
    assert held > 0.0 and contact.held[0] == pytest.approx(0.0, abs=1e-12 * held)
    assert contact.numbers.dissipated == pytest.approx(held)


def test_deep_penetration_is_warned_of():
    contact = contact_of(1)
    take(contact)
    contact.kick(points_at([(1.0, 1.0, 0.1)]), 1e-3)
    assert not contact.warnings()
    contact.kick(points_at([(1.0, 1.0, -0.2)]), 1e-3)
    assert "one went 1.4 of its radii deep, and beyond 2" in contact.warnings()["contact"]


def _fall(side, step):
    """Strike a face from above or below at 100 m/s, in steps of `step` [s] or predicted steps."""
    node, face = NODES[[0, 1, 4, 3]], np.array([[0, 1, 2, 3]])
    contact = contact_of(1, node, face if side > 0.0 else face[:, ::-1], mass=1e9)
    points = points_at([(1.0, 1.0, side * 4.0)], np.array([[0.0, 0.0, -side * 100.0]]), mass=0.1)
    contact.start(points.velocity)
    points.modulus[:] = 1e6  # Pa
    contact.faces[0][:] = 1e6  # longitudinal
    for _ in range(200):
        take(contact, node)
        dt = step or min(0.1, contact.stable_step(1.0))
        contact.kick(points, dt)
        points.place[:] += dt * points.velocity
        if abs(points.place[0, 2]) > 4.5:
            break
    return side * points.velocity[0, 2], contact.warnings()


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_no_particle_passes_through_a_face_in_predicted_steps(side):
    speed, warnings = _fall(side, None)
    assert speed > 90.0 and not warnings
    assert _fall(side, 0.03)[0] == -100.0  # a step jumps over the face


def test_a_particle_that_has_passed_through_a_face_is_warned_of():
    contact = contact_of(1)
    take(contact)
    contact.kick(points_at([(1.0, 1.0, 0.7)]), 1e-3)
    assert not contact.warnings()
    contact.kick(points_at([(1.0, 1.0, -0.7)]), 1e-3)
    assert "one went 2.4 of its radii deep, and beyond 2" in contact.warnings()["contact"]


def test_a_run_that_begins_from_another_keeps_history_and_counts_from_0():
    contact, points = contact_of(1, friction=0.1), points_at([(1.0, 1.0, -0.3)], np.ones((1, 3)))
    for _ in range(2):
        take(contact)
        contact.kick(points, 1e-1)
    saved, restarted = contact.save(), contact_of(1)
    assert contact.warnings() and contact.numbers.dissipated > 0.0
    restarted.load(restarted.beginning(saved))
    numbers = restarted.numbers
    assert not restarted.warnings() and numbers.dissipated == numbers.work == numbers.deepest == 0.0
    np.testing.assert_array_equal(restarted.slip, contact.slip)
    assert numbers.energy > 0.0 and restarted.stable_step(1.0) == contact.stable_step(1.0)


def test_a_state_without_this_contact_begins_without_history():
    contact, points = contact_of(1, friction=0.5), points_at([(1.0, 1.0, 0.3)], np.ones((1, 3)))
    take(contact)
    contact.kick(points, 1e-2)
    coarse = contact_of(1, NODES[:4], FACES[:1])
    for restarted, state in (
        (contact_of(1), {}),
        (coarse, contact.save()),
        (contact_of(2), contact.save()),
    ):
        start = restarted.save()
        restarted.load(restarted.beginning(state))
        for key, array in restarted.save().items():
            np.testing.assert_array_equal(array, start[key])


def test_a_particle_at_rest_under_contact_has_no_kinetic_energy():
    contact, points = contact_of(1, friction=0.5), points_at([(1.0, 1.0, 0.3)])
    for fixed, moves in ((7, [0, 0, 0]), (4, [1, 0, 0])):
        points.velocity[:] = 0.0 if fixed == 7 else (1.0, 0.0, 0.0)
        take(contact)
        contact.kick(points._replace(fixed=np.array([fixed])), 1e-2)
        assert contact.reaction[:, 2].sum() < 0.0
        assert (contact.kicked[0] == 0.0).tolist() == (np.array(moves) == 0).tolist()
        assert points.velocity[0, 2] == 0.0
        assert (contact.numbers.half_kick == 0.0) == (fixed == 7)


def test_what_is_saved_comes_back():
    contact, points = contact_of(1, friction=0.5), points_at([(1.0, 1.0, 0.3)], np.ones((1, 3)))
    take(contact)
    contact.kick(points, 1e-2)
    saved = {key: array.copy() for key, array in contact.save().items()}
    loaded = contact_of(1, friction=0.5)
    loaded.load(saved)
    for key, array in loaded.save().items():
        np.testing.assert_array_equal(array, saved[key])
    assert loaded.stable_step(1.0) == contact.stable_step(1.0)
