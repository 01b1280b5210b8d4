"""The view of a component without one: bodies, meshes or points whose positions it gives."""

import numpy as np
import pytest

from quintet.components.stand_ins.params import PrescribedParams
from quintet.components.stand_ins.prescribed import Prescribed
from quintet.interfaces.component import Component, Field, Port
from quintet.interfaces.params import read
from quintet.interfaces.ports import ACTIVE, FACES, POSITION, TEMPERATURE, VELOCITY
from quintet.interfaces.serving.port_view import look_at, port_fields


class Rods(Component):
    """Gives the fields of its port at four points."""

    def __init__(self, port, static):
        self.gives, self.static = (port,), static

    def describe(self):
        return self.static

    def give(self, wanted):
        fields = {f"{self.gives[0].name}.{field.name}": field for field in self.gives[0].fields}
        return {key: np.ones((4, *fields[key].shape)) for key in wanted}

    def stable_dt(self):
        return 1.0

    def take(self, fields): ...
    def step(self, dt): ...
    def save(self): ...
    def load(self, state): ...


def _prescribed(bodies):
    params, wrong = read(PrescribedParams, {"bodies": bodies}, "bodies")
    assert not wrong
    return Prescribed(params)


def test_points_show_their_fields_with_units():
    port = Port("rod", (Field("flow", (), "W", "impulse"), POSITION, TEMPERATURE, ACTIVE))
    view, units = look_at(Rods(port, {}))
    assert view.keys() == {"points", "temperature"} and units == {"temperature": "K"}
    assert [field.name for field in port_fields((port,))] == ["temperature"]


def test_a_port_without_positions_shows_nothing():
    assert look_at(Rods(Port("rod", (TEMPERATURE, VELOCITY)), {})) == ({}, {})
    partner = Port("samples", (POSITION,), items="partner")
    assert look_at(Rods(partner, {})) == ({}, {})


def test_a_mesh_shows_its_faces():
    corner = np.array([[0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 2.0, -1.0]])
    view, _ = look_at(Rods(FACES, {"faces.corner": corner, "faces.start": np.ones((4, 3))}))
    assert view["cells"].tolist() == corner.tolist() and view["velocity"].shape == (4, 3)


def test_boxes_turn_and_spheres_have_their_radius():
    quarter = [0.0, 0.0, np.pi / 2.0]
    bodies = _prescribed(
        [
            {"shape": "box", "lowest": [0.0, -2.0, -3.0], "highest": [2.0, 2.0, 3.0],
             "angular_velocity": quarter},
            {"shape": "sphere", "centre": [9.0, 0.0, 0.0], "radius": 0.2},
        ]
    )  # fmt: skip
    bodies.step(1.0)
    view, units = look_at(bodies)
    assert units == {"velocity": "m/s", "radius": "m"}
    assert view["radius"].tolist() == [*[0.0] * 8, 0.2]
    box = view["points"][:8]
    assert np.ptp(box, axis=0) == pytest.approx([4.0, 2.0, 6.0])
    assert view["cells"].max() == 7 and view["cells"].shape == (6, 4)
    arm = box - [1.0, 0.0, 0.0]
    assert view["velocity"][:8] == pytest.approx(np.cross(quarter, arm))
    for face in box[view["cells"]]:  # seen from outside
        normal = np.cross(face[1] - face[0], face[2] - face[0])
        assert normal @ (face.mean(axis=0) - box.mean(axis=0)) > 0.0


def test_polygons_and_discs_are_one_face_and_one_circle():
    bodies = _prescribed(
        [
            {"shape": "polygon", "corners": [[0, 0], [2, 0], [2, 1], [1, 2], [0, 1]],
             "origin": [0.0, 0.0, 1.0]},
            {"shape": "disc", "centre": [5.0, 0.0, 0.0], "radius": 0.2},
            {"shape": "polygon", "corners": [[0, 0], [1, 0], [0, 1]], "origin": [7.0, 0.0, 0.0]},
        ]
    )  # fmt: skip
    view, _ = look_at(bodies)
    assert view["cells"].tolist() == [[0, 1, 2, 3, 4], [6, 7, 8, -1, -1]]
    assert view["radius"][5] == pytest.approx(0.2)
    assert view["points"][view["cells"][0], 2].max() == 3.0
    assert view["points"][6:].tolist() == [[7.0, 0.0, 0.0], [8.0, 0.0, 0.0], [7.0, 0.0, 1.0]]
