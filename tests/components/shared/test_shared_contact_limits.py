"""Contact with faces: limits of the step and warnings, for particles of several radii."""

import numpy as np
import pytest
from contact_points import FACES, NODES, RADIUS, contact_of, points_at, spheres_at, take

from quintet.interfaces.errors import SceneError

SMALL, LARGE = 0.02, 0.5  # m


def _mixture(height):
    """Contact of a small sphere above a face with a large one far away; both fall at 1 m/s."""
    radius = np.array([SMALL, LARGE])
    contact = contact_of(2, mass=1e9, spheres=True, radius=radius)
    fall = np.array([[0.0, 0.0, -1.0], [0.0, 0.0, -1.0]])
    points = spheres_at([(1.0, 1.0, height), (1.0, 1.0, 9.0)], fall, 1e-9)
    return contact, points._replace(radius=radius)


def test_the_step_is_limited_by_the_smallest_sphere_of_a_mixture():
    contact, points = _mixture(0.09)
    contact.start(points.velocity)
    assert contact.numbers.limit == 0.5 * SMALL
    take(contact)
    contact.kick(points, 1e-3)
    assert contact.stable_step(1e9) == SMALL  # half of the way from a radius above to one below


def test_a_small_sphere_of_a_mixture_that_passes_through_a_face_is_warned_of():
    contact, points = _mixture(0.09)
    take(contact)
    contact.kick(points, 0.25)
    points.place[:, 2] -= 0.25
    take(contact)
    contact.kick(points, 0.25)
    assert "one went 9 of its radii deep, and beyond 2" in contact.warnings()["contact"]


@pytest.mark.parametrize("triangles", [False, True])
def test_a_contact_is_compared_with_the_shortest_edge_of_an_element(triangles):
    node = NODES * (1.0, 0.25, 1.0)  # 0.5 m wide and 1 m thick
    face = np.array([[0, 1, 3, 3], [1, 4, 3, 3]]) if triangles else FACES
    contact = contact_of(1, node, face, spheres=True)
    take(contact, node)
    contact.kick(spheres_at([(1.0, 0.25, RADIUS - 0.03)]), 1e-3)  # √(R δ) is 0.122 m
    assert contact.numbers.spread == pytest.approx(0.015**0.5 / 0.5)
    text = contact.warnings()["indentation"]
    assert "0.2 of the thickness and the sides of an element" in text and "found 0.24" in text


def test_particles_with_many_points_across_go_on_with_the_same_bits_after_a_restart():
    x, y = np.meshgrid([0.0, 2.0, 4.0], [0.0, 2.0, 4.0])
    node = np.stack([x.ravel(), y.ravel(), 0.0 * x.ravel()], axis=1)
    face = np.array([[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]])
    # At first the face across the corner is more than three radii away. The particle moves by less
    # than a radius; then one of its points lies on that face.
    last = np.array([1.7, 1.7, 0.95])
    move = 0.499 * np.array([0.3, 0.3, -0.95]) / np.sqrt(0.3**2 + 0.3**2 + 0.95**2)
    states = []
    for restarts in (False, True):
        contact = contact_of(1, node, face, points=4)
        take(contact, node)
        contact.kick(points_at([last - move], move[None]), 1.0)
        if restarts:
            state, contact = contact.save(), contact_of(1, node, face, points=4)
            contact.load(state)
            take(contact, node)
        contact.kick(points_at([last], move[None]), 1.0)
        assert contact.near.weight[0, contact.near.nodes[0] == 8].sum() > 0.0
        states.append(contact.save())
    for key, array in states[0].items():
        np.testing.assert_array_equal(array, states[1][key])


def test_spheres_with_several_points_across_are_refused():
    rule = "points_across of a link contact must be 1 where spheres touch faces.* it is 3. Leave"
    with pytest.raises(SceneError, match=rule):
        contact_of(1, spheres=True, points=3.0)


@pytest.mark.parametrize("angle", [0.0, 2e-3, 0.1, 0.3])
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_a_particle_is_spread_over_faces_of_a_surface_that_bends(angle, sign):
    node = NODES.copy()
    node[[2, 5]] = [[2.0 + 2.0 * np.cos(angle), y, sign * 2.0 * np.sin(angle)] for y in (0, 2)]
    contact, points = contact_of(1, node, FACES[:2], points=3), points_at([(1.7, 1.0, 0.4)])
    take(contact, node)
    contact.kick(points, 1.0)
    share = (1.7 + 1 / 3 - 2.0) / 2.0 / 3.0  # of the right third, on the second face
    second_weight = contact.near.weight[0, np.isin(contact.near.nodes[0], (2, 5))].sum()
    assert second_weight == pytest.approx(share * np.cos(angle))
    gap = contact.near.gap[0]  # m, to the mean surface, which the outer third tilts
    tilt = sign * 2.0 * np.sin(angle) * second_weight
    assert gap == pytest.approx(-0.1 - tilt, abs=1e-12)
