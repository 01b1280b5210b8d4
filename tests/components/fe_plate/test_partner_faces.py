"""Points of a surface, by which it touches the faces of another mesh."""

import numpy as np
import pytest

from quintet.components.fe_plate.partner_faces import PartnerFaces, surface_points
from quintet.components.shared.geometry.face_projection import corners

SQUARE = np.array([[0, 0, 0], [2, 0, 0], [2, 3, 0], [0, 3, 0]], float)
FACES = {
    "square": ([[0, 1, 2, 3]], 6.0, 2 * 3),
    "triangle": ([[0, 1, 2, -1]], 3.0, 2 * 4),
    "edge": ([[0, 1, -1, -1]], 2.0, 2),
}


@pytest.mark.parametrize("name", FACES)
def test_points_of_a_face_have_its_area_and_lie_within_a_distance(name):
    face, area, count = FACES[name]
    corner = corners(np.array(face, float))
    owner, weight, areas = surface_points(SQUARE, corner, 1.0)
    assert (owner == 0).all() and len(owner) == count
    assert areas.sum() == pytest.approx(area, rel=1e-12)
    np.testing.assert_allclose(weight.sum(axis=1), 1.0)
    # An even pressure loads every corner of a square, and both of an edge, alike.
    if name != "triangle":
        loads = np.bincount(corner[owner].ravel(), (areas[:, None] * weight).ravel())
        np.testing.assert_allclose(loads, area / len(loads))


def _above(mass, gap=-0.1):
    """Two squares of 1 m², the upper one of masses (4,) kg, that overlap; Pa, m."""
    node = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    layer = {key: np.array([number]) for key, number in
             {"bulk": 2.0 / 3.0, "shear": 1.0, "thickness": 1.0}.items()}  # fmt: skip
    static = {
        "corner": np.array([[0.0, 1.0, 2.0, 3.0]]), "mass": np.full(4, 1e9), "width": np.ones(1),
        "friction": np.zeros(1), "stiffness": np.ones(1), "safety": np.ones(1),
        "points": np.zeros(1), "step": np.array([1e9]), **layer,
    }  # fmt: skip
    upper = {"start": node + np.array([0.0, 0.0, gap]), "corner": np.array([[0.0, 3.0, 2.0, 1.0]])}
    upper |= {"mass": mass, **layer}
    faces = PartnerFaces(
        {f"contact_faces.{key}": array for key, array in static.items()}, upper, np.zeros((4, 3))
    )
    faces.penalty.take({
        "contact_faces.position": node, "contact_faces.velocity": np.zeros((4, 3)),
        "contact_activity.active": np.ones(1),
    })  # fmt: skip
    return faces, upper["start"]


def test_an_overlap_of_two_layers_presses_as_both_one_behind_the_other():
    faces, place = _above(np.ones(4))
    force = faces.push(place, np.zeros((4, 3)), None, 0.01)
    pressure = 0.1 / (1.0 / 2.0 + 1.0 / 2.0)  # Pa: M = K + 4G/3 = 2 Pa
    np.testing.assert_allclose(force, np.array([[0.0, 0.0, 0.25 * pressure]] * 4), atol=1e-15)
    np.testing.assert_allclose(faces.penalty.reaction, -force, atol=1e-15)
    assert faces.penalty.numbers.energy == pytest.approx(0.5 * pressure * 0.1)


def test_the_predicted_step_is_where_a_face_on_springs_becomes_unstable():
    largest = []
    for share in (0.99, 1.01):
        faces, place = _above(np.full(4, 0.25), -0.1)
        place, velocity = place.copy(), np.zeros((4, 3))
        faces.push(place, velocity, None, 1.0)
        dt = share * faces.penalty.stable_step(1e9)
        assert dt == pytest.approx(share * 2.0, rel=1e-6)  # 1 N/m under 1 kg
        place[:, 2] += 1e-3
        for _ in range(400):
            force = faces.push(place, velocity, None, dt)
            velocity = velocity + dt / 0.25 * (force - [0.0, 0.0, 0.025])
            place = place + dt * velocity
            if abs(place[0, 2] + 0.1) > 0.09:
                break
        largest.append(abs(place[0, 2] + 0.1))
    assert largest[0] < 0.02 < 0.09 < largest[1]


def test_points_of_faces_that_are_not_open_do_not_touch():
    faces, place = _above(np.ones(4))
    force = faces.push(place, np.zeros((4, 3)), np.ones(1), 0.01)
    assert force.any() and faces.penalty.numbers.energy > 0.0
    held = faces.penalty.numbers.energy
    closed = faces.push(place, np.zeros((4, 3)), np.zeros(1), 0.01)
    assert not closed.any() and faces.penalty.numbers.energy == 0.0
    # What the springs held is dissipated, with the half of the last kick that was to come.
    assert faces.penalty.numbers.dissipated == pytest.approx(held, rel=0.01)
