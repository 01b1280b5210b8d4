"""Parameters of a gas that contradict each other are refused with advice."""

import pytest

from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.params import read

REST = {"density": 1.0, "pressure": 1.0}
BOX = {"lowest": [0.0, 0.0, 0.0], "highest": [1.0, 0.0, 1.0], "spacing": 0.1}
PLATE = {"length": 1.0, "ahead": 0.2, "height": 0.5, "points_along": 20, "finest": 0.01}
BODY = {
    "radius": 0.1,
    "centre": [0.5, 0.0, 0.5],
    "points_around": 16,
    "thickness": 0.1,
    "spacing": 0.05,
}
FORE = BODY | {"sector": 1.5707963267948966, "centre": [1.0, 0.0, 0.0]}
DRIVEN, THICK = {"is_driven": True}, {"first_spacing_at_sector": 0.09}
CUT = {"axisymmetric": True, "bodies": [FORE]}
TUBE = {"position": 0.5, "left": REST, "right": REST}
ROUND = {"radius": 1.0, "points_around": 8, "layers": {"count": 6}}
POINTS = {"drag": "stokes"}


def sphere(velocity, axisymmetric=True, **keys):
    """A sphere in a stream of a velocity [m/s]."""
    ends = {"wall": {"kind": "slip"}, "exit": {"kind": "outflow"}}
    far = {"kind": "inflow", "state": REST | {"velocity": velocity}}
    return {
        "dimensions": 2 if axisymmetric else 3,
        "axisymmetric": axisymmetric,
        "sphere": ROUND | keys,
        "boundaries": ends | {"far": far},
    }


@pytest.mark.parametrize(
    ("keys", "sentence"),
    [
        ({"box": BOX, "local_steps": True, "particles": POINTS}, "Leave out local_steps"),
        ({"box": BOX, "steady": {}, "particles": POINTS}, "Leave out local_steps"),
        ({"box": BOX, "moving": {"bodies": [BODY]}, "local_steps": True}, "Leave out local_steps"),
        ({"box": BOX, "moving": {"bodies": [BODY]}, "probes": [[0.1, 0.0, 0.1]]}, "still; found"),
        ({"box": BOX, "moving": {"bodies": [BODY]}, "particles": POINTS}, "Leave out particles"),
        ({"plate": PLATE | {"layers": {"count": 10, "jitter": 0.3}}}, "jitter is for an"),
        ({"box": BOX, "moving": CUT | {"axisymmetric": False}}, "on an axis of symmetry"),
        (
            {"box": BOX, "moving": CUT | {"bodies": [FORE | {"is_driven": True}]}},
            "must stand still",
        ),
        ({"box": BOX, "moving": CUT | {"bodies": [FORE | {"sector": 1.0}]}}, "or is whole"),
        (
            {"box": BOX, "moving": CUT | {"bodies": [FORE | {"first_spacing_at_sector": 0.09}]}},
            "no thicker",
        ),
        (
            {"box": BOX, "moving": {"bodies": [BODY]}, "initial": None, "riemann": TUBE},
            "for a tube alone",
        ),
        (sphere([3.0, 0.0, 0.0], centre=[5.0, 0.0, 0.1]), "axis of symmetry, y = z = 0; found"),
        (sphere([-3.0, 0.0, 1.0]), "must flow along x"),
        (sphere([-3.0, 0.0, 0.0], axisymmetric=False), "must flow along x"),
        (sphere([3.0, 0.1, 0.0], axisymmetric=False), "must flow along x"),
        ({}, "found none"),
    ],
)
def test_what_does_not_go_together_is_refused(keys, sentence):
    table = {"gas": {"gas_constant": 1.0}, "initial": REST, **keys}
    _, mistakes = read(MeshlessGasParams, table, "gas")
    assert any(sentence in mistake for mistake in mistakes), mistakes


def test_a_sphere_in_space_may_lie_off_the_axis_x():
    table = sphere([3.0, 0.0, 0.0], axisymmetric=False, centre=[5.0, 1.0, 0.1])
    _, mistakes = read(MeshlessGasParams, {"initial": REST} | table, "gas")
    assert not mistakes, mistakes
