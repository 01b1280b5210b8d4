"""Parameters of a gas that contradict each other are refused with advice."""

import pytest

from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.meshless_gas.wall_loads import free_stream
from quintet.interfaces.errors import SceneError
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
SIDEWAYS = REST | {"velocity": [0.0, 1.0, 0.0]}
ZONE = {"lowest": [0.0, 0.0, 0.0], "highest": [0.5, 0.0, 1.0], "state": REST}
OPEN = {"x+": {"kind": "outflow"}}
CLOSED = {"z-": {"kind": "slip"}, "z+": {"kind": "slip"}}
TOTAL = {"pressure": 2.0, "temperature": 1.0}
CUBE = BOX | {"highest": [1.0, 1.0, 1.0]}
VORTEX = {"centre": [0.5, 0.0, 0.5], "strength": 0.1, "radius": 0.1}
LINE = {"begin": [0.1, 0.0, 0.5], "end": [0.9, 0.0, 0.5], "level": 1.0}


def held(velocity):
    """A floor that holds the gas and moves [m/s], below a slip wall."""
    floor = {"kind": "adiabatic", "velocity": velocity}
    return {"viscous": True, "boundaries": CLOSED | {"z-": floor}}


def sphere(velocity, axisymmetric=True, wall=None, **keys):
    """A sphere in a stream of a velocity [m/s]."""
    ends = {"wall": wall or {"kind": "slip"}, "exit": {"kind": "outflow"}}
    far = {"kind": "inflow", "state": REST | {"velocity": velocity}}
    return {
        "dimensions": 2 if axisymmetric else 3,
        "axisymmetric": axisymmetric,
        "sphere": ROUND | keys,
        "boundaries": ends | {"far": far},
        "viscous": wall is not None,
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
        ({"box": BOX, "initial": SIDEWAYS}, "initial.velocity: in two dimensions gas and walls"),
        (
            {"box": BOX, "zones": [ZONE | {"state": SIDEWAYS}]},
            "zones.0.state.velocity: in two dimensions",
        ),
        (
            {"box": BOX, "boundaries": OPEN | {"x-": {"kind": "inflow", "state": SIDEWAYS}}},
            "boundaries.x-.state.velocity: in two dimensions",
        ),
        (
            {
                "box": BOX,
                "boundaries": OPEN
                | {"x-": {"kind": "inflow", "total": TOTAL | {"direction": [1.0, 1.0, 0.0]}}},
            },
            "boundaries.x-.total.direction: in two dimensions",
        ),
        ({"box": BOX, **held([0.0, 0.5, 0.0])}, "boundaries.z-.velocity: in two dimensions"),
        ({"box": BOX, **held([0.1, 0.0, 0.5])}, "along it; found [0.1, 0.0, 0.5] m/s. Set z to 0."),
        (
            {"dimensions": 3, "box": CUBE, **held([0.0, 0.5, 0.5])},
            "boundaries.z-: the velocity of a wall must be along it",
        ),
        (
            sphere([3.0, 0.0, 0.0], wall={"kind": "adiabatic", "velocity": [1.0, 0.0, 0.0]}),
            "Set x and y and z to 0.",
        ),
        (
            {"box": BOX, "vortex": VORTEX, "zones": [ZONE]},
            "in the initial state alone; found zones. Remove",
        ),
        (
            {"box": BOX, "vortex": VORTEX, "boundaries": CLOSED},
            "found boundaries.z- of kind slip and boundaries.z+ of kind slip. Remove",
        ),
        ({"box": BOX, "initial": None, "riemann": TUBE | {"position": 1.5}}, "between 0 and 1 m"),
        (
            {
                "box": BOX,
                "initial": None,
                "riemann": TUBE | {"left": REST | {"velocity": [1, 0, 2]}},
            },
            "riemann.left: its velocity must be along x; found [1.0, 0.0, 2.0] m/s",
        ),
        (
            sphere([3.0, 0.0, 0.0]) | {"initial": None, "riemann": TUBE},
            "riemann is for a tube alone: it needs a box",
        ),
        (sphere([3.0, 0.0, 0.0]) | {"neighbours": 12}, "neighbours is of the nodes of a box"),
        (sphere([3.0, 0.0, 0.0], outer_radius=1.0), "must be above radius, 1 m; found 1 m"),
        (
            {"box": BOX, "fronts": [LINE | {"begin": [0.1, 0.5, 0.5]}]},
            "fronts, item 0: begin: in two dimensions a line lies in the plane y = 0",
        ),
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


def test_a_zone_without_a_node_is_refused():
    zone = ZONE | {"lowest": [0.5, 0.0, 0.5], "highest": [0.2, 0.0, 0.9]}
    table = {"box": BOX, "initial": REST, "zones": [ZONE, zone]}
    params, mistakes = read(MeshlessGasParams, table, "gas")
    assert not mistakes
    with pytest.raises(SceneError, match=r"zones.1: its box must hold a node; it holds none"):
        MeshlessGas(params)


def test_the_drag_of_a_plate_is_over_that_of_the_gas_that_flows_in():
    wind = REST | {"velocity": [0.3, 0.0, 0.0]}
    sides = {"ahead": {"kind": "slip"}, "far": {"kind": "outflow"}, "exit": {"kind": "outflow"}}
    sides |= {"wall": {"kind": "adiabatic"}, "inlet": {"kind": "inflow", "state": wind}}
    table = {
        "plate": PLATE | {"layers": {"count": 10}}, "viscous": True, "boundaries": sides,
        "initial": REST,
    }  # fmt: skip
    params, mistakes = read(MeshlessGasParams, table, "gas")
    assert not mistakes
    stream = free_stream(params)
    assert stream is not None and stream.mach == pytest.approx(0.3 / 1.4**0.5)
