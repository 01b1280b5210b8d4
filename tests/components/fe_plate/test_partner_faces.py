"""Points of a surface, by which it touches the faces of another mesh."""

import json
from types import SimpleNamespace

import numpy as np
import pytest
from pydantic import TypeAdapter

from quintet.components.fe_plate.component import FePlate
from quintet.components.fe_plate.features import partner_faces
from quintet.components.fe_plate.params import FePlateParams
from quintet.components.fe_plate.partner_faces import PartnerFaces, points_along, surface_points
from quintet.components.shared.geometry.face_projection import corners
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import SceneError, StepError

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
    owner, weight, areas = surface_points(SQUARE, corner, points_along(SQUARE, corner, 1.0))
    assert (owner == 0).all() and len(owner) == count
    assert areas.sum() == pytest.approx(area, rel=1e-12)
    np.testing.assert_allclose(weight.sum(axis=1), 1.0)
    # An even pressure loads every corner of a square, and both of an edge, alike.
    if name != "triangle":
        loads = np.bincount(corner[owner].ravel(), (areas[:, None] * weight).ravel())
        np.testing.assert_allclose(loads, area / len(loads))


def _above(mass, gap=-0.1, width=1.0, thickness=1.0):
    """Two squares of 1 m², the upper one of masses (4,) kg, that overlap; Pa, m.

    The lower one lies before a layer of a thickness.
    """
    node = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], float)
    layer = {key: np.array([number]) for key, number in
             {"bulk": 2.0 / 3.0, "shear": 1.0, "thickness": 1.0}.items()}  # fmt: skip
    static = {
        "corner": np.array([[0.0, 1.0, 2.0, 3.0]]), "mass": np.full(4, 1e9),
        "width": np.atleast_1d(width),
        "friction": np.zeros(1), "stiffness": np.ones(1), "safety": np.ones(1),
        "points": np.zeros(1), "step": np.array([1e9]), **layer, "thickness": np.array([thickness]),
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


def test_a_face_that_erodes_before_a_state_is_saved_dissipates_after_it_is_loaded():
    faces, place = _above(np.ones(4))
    faces.push(place, np.zeros((4, 3)), np.ones(1), 0.01)
    saved = {key: array.copy() for key, array in faces.save().items()}
    restored = _above(np.ones(4))[0]
    restored.load(saved)
    begun = _above(np.ones(4))[0]
    begun.load(begun.beginning(saved))
    for touching in (faces, restored, begun):
        touching.push(place, np.zeros((4, 3)), np.zeros(1), 0.01)
        assert touching.penalty.numbers.dissipated == faces.penalty.numbers.dissipated > 0.0
    # A state of another mesh says nothing about these faces.
    assert (begun.beginning({**saved, "contact/open": np.zeros(2)})["contact/open"] == [0.0]).all()


def test_points_that_would_be_too_many_are_fewer_and_warned_of():
    assert not _above(np.ones(4))[0].warnings()
    faces, _ = _above(np.ones(4), width=0.1)
    assert "so fine that 40 points per side would be needed; 16 are used" in faces.note
    assert faces.warnings() == {"contact_points": faces.note}
    assert len(faces.mass) == 16 * 16


def test_points_are_placed_for_the_narrow_faces_of_a_graded_partner():
    graded = np.repeat([0.5, 2.0], [2, 8])
    assert len(_above(np.ones(4), width=graded)[0].mass) == 8 * 8


def test_a_face_that_nearly_passes_through_another_is_warned_of():
    faces, place = _above(np.ones(4), gap=-0.6)
    faces.push(place, np.zeros((4, 3)), None, 0.01)
    warning = faces.penalty.warnings()["contact"]
    assert "a contact point penetrated 0.6 of the thinner element's thickness" in warning


def test_a_face_that_may_pass_through_a_thin_layer_is_warned_of():
    for thickness, is_deep in ((0.25, False), (0.15, True)):
        faces, place = _above(np.ones(4), gap=-0.1, thickness=thickness)
        faces.push(place, np.zeros((4, 3)), None, 0.01)
        assert ("contact" in faces.penalty.warnings()) == is_deep
    assert "penetrated 0.667 of the thinner" in faces.penalty.warnings()["contact"]


def test_a_structure_on_several_ranks_touches_no_faces():
    several = Resources(communicator=SimpleNamespace(size=2))
    rule = "contact_with_faces must be false of a structure on 2 ranks; it is true. Take one rank"
    with pytest.raises(SceneError, match=rule):
        partner_faces({}, frozenset({"contact_faces"}), {}, np.zeros((0, 3)), several)


def _held(share):
    """Largest velocity after and before 300 steps of a bar pressed on stiff springs of contact.

    The bar is held at its top, and its steps are a share of the predicted one.
    """
    soft = {"density": 1000.0, "youngs_modulus": 1e5, "poissons_ratio": 0.0}
    part = {"lowest": [0.0] * 3, "highest": [0.2, 1.0, 0.2], "elements": [2, 1, 2],
            "material": soft}  # fmt: skip
    low, high = [0.0, 0.0, 0.2], [0.2, 1.0, 0.2]
    document = {
        "parts": [part], "dimensions": 2, "contact_with_faces": True, "integration": "reduced",
        "viscosity_linear": 0.0, "viscosity_quadratic": 0.0,
        "fixed": [{"lowest": low, "highest": high},
                  {"lowest": [0.0] * 3, "highest": high, "directions": ["x"]}],
        "coupled_faces": [{"lowest": [0.0] * 3, "highest": [0.2, 1.0, 0.0]}],
    }  # fmt: skip
    bar = FePlate(TypeAdapter(FePlateParams).validate_json(json.dumps(document)))
    layer = {"bulk": [1e5 / 3.0], "shear": [5e4], "thickness": [0.1], "width": [0.1]}
    numbers = {"friction": [0.0], "stiffness": [30.0], "safety": [1.0], "points": [0.0]}
    static = {"corner": [[1.0, 0.0, 0.0, 1.0]], "mass": [1e9, 1e9], "step": [1e9]} | layer | numbers
    fields = {f"contact_faces.{key}": np.array(array) for key, array in static.items()}
    bar.bind(fields, frozenset({"contact_faces", "contact_activity", "contact_load"}))
    ends = np.array([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]])

    def step(rise, dt):
        place = ends + np.array([0.0, 0.0, rise])
        bar.take({"contact_faces.position": place, "contact_activity.active": np.ones(1)})
        bar.step(dt)

    for k in range(600):  # slowly, over 1.2 s: waves cross the bar in 0.02 s
        step(2e-3 * np.sin(0.5 * np.pi * k / 600) ** 2, 2e-3)
    assert bar.touching.penalty.numbers.points > 0.0
    before = np.abs(bar.state.velocity).max()
    bar.state.velocity[:, 2] += 1e-4 * before * bar.model.free[:, 2]
    dt = share * bar.touching.penalty.stable_step(bar.bound)
    try:
        for _ in range(300):
            step(2e-3, dt)
    except StepError:  # an element is inside out
        return np.inf
    return np.abs(bar.state.velocity).max() / before


def test_a_bar_on_stiff_contact_is_stable_up_to_the_predicted_step():
    assert _held(0.97) < 10.0
    assert _held(1.05) > 100.0
