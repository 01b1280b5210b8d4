"""Keys of structures that would do nothing right are refused; runs from others judge themselves."""

import pytest

from quintet.components.fe_plate.component import FePlate
from quintet.components.fe_plate.params import FePlateParams
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import read

ELASTIC = {"density": 2700.0, "youngs_modulus": 7e10, "poissons_ratio": 0.3}
BOX = {
    "lowest": [0.0, 0.0, 0.0],
    "highest": [1.0, 1.0, 1.0],
    "elements": [1, 1, 1],
    "material": ELASTIC,
}


def params(part=None, **keys):
    return read(FePlateParams, {"parts": [{**BOX, **(part or {})}], **keys}, "block")


@pytest.mark.parametrize(
    ("part", "reason"),
    [
        ({"quarter": True}, "quarter is for a cylinder; found a box"),
        ({"coincident_nodes": "keep"}, "coincident_nodes is for a mesh; found a box"),
        ({"time_scale": 1e-3}, "time_scale is for a mesh; found a box"),
    ],
)
def test_keys_of_other_shapes_are_refused(part, reason):
    _, mistakes = params(part)
    assert any(reason in mistake for mistake in mistakes), mistakes


@pytest.mark.parametrize(
    ("part", "keys", "reason"),
    [
        ({"velocity": [1.0, 2.0, 0.0]}, {}, "a velocity must be along x and z; found 2 m/s"),
        ({}, {"gravity": [0.0, -9.81, 0.0]}, "gravity must be along x and z in two dimensions"),
        (
            {},
            {"rigid_walls": [{"point": [0.0, 0.0, 0.0], "normal": [0.0, 1.0, 0.0]}]},
            "rigid_walls.0.normal must be along x and z in two dimensions",
        ),
    ],
)
def test_what_would_leave_the_plane_is_refused_in_two_dimensions(part, keys, reason):
    _, mistakes = params(part, dimensions=2, **keys)
    assert any(reason in mistake for mistake in mistakes), mistakes
    assert not params(part, dimensions=3, **keys)[1]


def test_a_stabilisation_that_vibrates_faster_than_the_step_allows_is_refused():
    _, mistakes = params(hourglass=2.1)
    assert any("hourglass must be at most 2, for stiffer" in mistake for mistake in mistakes)


def test_nodes_that_begin_behind_a_rigid_wall_are_refused():
    walls = [
        {"point": [0.0, 0.0, 0.0], "normal": [0.0, 0.0, 2.0]},  # touched
        {"point": [1e-3, 0.0, 0.0], "normal": [1.0, 0.0, 0.0]},
    ]
    touching, behind = (FePlate(params(rigid_walls=walls[:n])[0]) for n in (1, 2))
    touching.prime({})
    with pytest.raises(SceneError, match=r"rigid_walls\.1: .* found one 0\.001 m behind"):
        behind.prime({})


def test_a_run_from_the_state_of_another_is_judged_for_itself():
    first = FePlate(params()[0])
    first.state.velocity[0, 0] = 1.0
    first.step(first.stable_dt())
    first.judge.ranges[2] = 0.0, 1.0  # J: as if all internal energy were hourglassing
    first.judge.most[:] = 1.0, 1.0, 0.0
    assert first.warnings()
    second = FePlate(params()[0])
    second.begin_from(first.save())
    second.step(second.stable_dt())
    assert not second.warnings()
