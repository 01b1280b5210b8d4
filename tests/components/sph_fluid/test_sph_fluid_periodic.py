"""A tank that repeats: pairs meet across its faces as inside it, and nothing is lost there."""

import re
from typing import Any

import numpy as np
import pytest
from fluid_params import nested

from quintet.components.sph_fluid import SphFluidParams
from quintet.components.sph_fluid.component import SphFluid
from quintet.interfaces.component import Resources, outputs_of
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import read

SPACING = 0.0625  # m; all places are binary fractions, so that a period changes no bit
ALL: dict[str, Any] = {
    "spacing": SPACING,
    "sound_speed": 20.0,
    "gravity": [0.0, 0.0, 0.0],
    "fluid": [[[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]]],
    "boundary.walls": [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]],
    "boundary.open_faces": [],
    "boundary.periodic": ["x", "y", "z"],
    "negative_pressure": True,
    "density_diffusion": 0.1,
}
PLANE = ALL | {"dimensions": 2, "boundary.periodic": ["x", "z"]}
# Taylor and Green's vortices, of a wave length of 1 m.
VORTICES = {
    "initial.velocity": [
        "0.5 * sin(2 * pi * x) * cos(2 * pi * z)",
        "0",
        "-0.5 * cos(2 * pi * x) * sin(2 * pi * z)",
    ]
}


def params_of(table: dict[str, Any], **changes: Any) -> SphFluidParams:
    params, mistakes = read(SphFluidParams, nested(table | changes), "water")
    assert not mistakes, mistakes
    return params


def run(fluid: SphFluid, end: float) -> None:
    time = 0.0
    while time < end - 1e-12:
        dt = min(fluid.stable_dt(), end - time)
        fluid.step(dt)
        time += dt


def shifted_fluid(fluid: SphFluid, displacement: list[float]) -> SphFluid:
    """The same fluid with all its particles displaced [m], and new neighbour lists."""
    shifted = SphFluid(fluid.params)
    state = {name: np.array(array) for name, array in fluid.save().items()}
    state["position_density"][: fluid.state.fluid, :3] += displacement
    state["reference"] = np.zeros((0, 3))
    shifted.load(state)
    return shifted


@pytest.mark.parametrize("table", [PLANE, ALL], ids=["plane", "space"])
def test_a_fluid_that_repeats_along_all_axes_is_the_same_wherever_it_is(
    table: dict[str, Any],
) -> None:
    """A wave at the faces moves as the same wave in the middle of the tank."""
    fluid = SphFluid(params_of(table))
    state = {name: np.array(array) for name, array in fluid.save().items()}
    x = state["position_density"][:, 0]
    state["position_density"][:, 3] *= 1.0 + 0.001 * np.sin(2.0 * np.pi * x)
    fluid.load(state)
    shifted = shifted_fluid(fluid, [0.5, 0.0, 0.0])
    for solver in (fluid, shifted):
        run(solver, 0.02)
    view, shifted_view = fluid.view(), shifted.view()
    assert np.abs(view["velocity"][:, 0]).max() > 1e-4
    assert shifted_view["velocity"] == pytest.approx(view["velocity"], abs=1e-9)
    assert shifted_view["density"] == pytest.approx(view["density"], rel=1e-9)


def test_pairs_across_a_face_have_the_bits_of_pairs_inside() -> None:
    rates = []
    for shift in (0.0, 0.5):
        pair = [[[0.5 - SPACING, 0.0, 0.5], [0.5 + SPACING, 1.0, 0.5 + SPACING]]]
        fluid = SphFluid(params_of(PLANE, fluid=pair, **{"viscosity.kinematic": 0.1}))
        state = {name: np.array(array) for name, array in fluid.save().items()}
        state["position_density"][:, 3] += [1.0, 2.0]
        state["velocity_pressure"][:, :3] = [[0.25, 0.0, 0.125], [-0.25, 0.0, 0.0]]
        state["position_density"][:, 0] += shift
        fluid.load(state)
        for _ in range(2):
            fluid.step(1e-5)
        rows = np.argsort(fluid.state.identity)
        rates.append(fluid.state.velocity_pressure[rows])
    assert np.array_equal(*rates)
    assert np.abs(rates[0][:, 0]).min() != 0.25, "they felt each other"


def test_momentum_is_kept_to_rounding_and_all_fluid_stays() -> None:
    fluid = SphFluid(params_of(PLANE | VORTICES, **{"viscosity.kinematic": 0.01}))
    state = {name: np.array(array) for name, array in fluid.save().items()}
    state["velocity_pressure"][: fluid.state.fluid, 0] += 1.0
    fluid.load(state)
    before = fluid.totals()
    run(fluid, 0.6)
    totals = fluid.totals()
    scale = totals.mass * 1.0
    assert totals.momentum == pytest.approx(before.momentum, abs=1e-12 * scale)
    assert totals.mass == before.mass
    assert fluid.state.crossings[0] > 50, "it has gone round"
    places = fluid.view()["points"]
    assert (places[:, [0, 2]] > -SPACING).all()
    assert (places[:, [0, 2]] < 1.0 + SPACING).all()


def test_vortices_fade_as_taylor_and_green_say() -> None:
    """Energy falls as exp(-4νk²t), k = 2π/λ; Taylor & Green 1937.

    For 0.1 s: by 0.3 s the flow has drawn the lattice out by a factor of 2.5 where it parts, and
    energy goes where particles fall into place again, 1.7 times as fast at any spacing.
    """
    nu, end = 0.02, 0.1
    changes = {"viscosity.kinematic": nu, "kernel": "wendland", "sound_speed": 10.0}
    fluid = SphFluid(params_of(PLANE | VORTICES, **changes, spacing=0.5 * SPACING))
    before = fluid.totals().kinetic
    run(fluid, end)
    rate = -np.log(fluid.totals().kinetic / before) / end
    assert rate == pytest.approx(16.0 * np.pi**2 * nu, rel=0.03)


def poiseuille(**changes: Any) -> SphFluid:
    """A channel between plates, driven by gravity along it, from its steady flow."""
    table = {
        "spacing": 0.05,
        "dimensions": 2,
        "sound_speed": 8.0,
        "fluid": [[[0.0, 0.0, 0.0], [0.5, 1.0, 1.0]]],
        "boundary.walls": [[0.0, 0.0, 0.0], [0.5, 1.0, 1.0]],
        "boundary.open_faces": [],
        "boundary.periodic": ["x"],
        "gravity": [1.6, 0.0, 0.0],
        "boundary.method": "mdbc",
        "negative_pressure": True,
        "density_diffusion": 0.1,
        "viscosity.kinematic": 1.0,
        "initial.velocity": ["0.8 * z * (1 - z)", "0", "0"],
    }
    return SphFluid(params_of(table, **changes))


def test_flow_between_plates_stays_as_it_is() -> None:
    """u = g z (H - z) / 2ν; its discharge g H³ / 12ν.

    With 20 particles across, 1.8 % more flows; with 40, 1.2 %: pairs have too little viscosity.
    """
    fluid = poiseuille()
    run(fluid, 1.0)
    view = fluid.view()
    z, u = view["points"][:, 2], view["velocity"][:, 0]
    assert u == pytest.approx(0.8 * z * (1.0 - z), abs=0.02 * 0.2)
    assert u.mean() == pytest.approx(1.6 / 12.0, rel=0.02)


def test_the_weight_of_what_goes_round_is_counted() -> None:
    """Walls take the work of gravity: steady flow loses the potential energy of its fall."""
    fluid = poiseuille()
    before = fluid.totals()
    run(fluid, 1.0)
    totals = fluid.totals()
    fallen = totals.mass * 1.6 * 1.6 / 12.0 * 1.0  # J, m g u t
    assert before.potential - totals.potential == pytest.approx(fallen, rel=0.02)
    assert fluid.state.crossings[0] > 0


@pytest.mark.parametrize("threads", [2])
def test_threads_and_a_saved_state_change_no_bit(threads: int) -> None:
    fluid, loaded = poiseuille(), poiseuille()
    shared = SphFluid(fluid.params, Resources(threads))
    for solver in (fluid, shared):
        run(solver, 0.05)
    loaded.load(fluid.save())
    for solver in (fluid, shared, loaded):
        run(solver, 0.05)
    for solver in (shared, loaded):
        for name, array in fluid.save().items():
            assert np.array_equal(solver.save()[name], array), name


def test_gauges_near_a_face_see_what_is_behind_it() -> None:
    """In still water, pressure gauges at one height read the same."""
    gauges = {"gauges.pressure_gauges": [[0.0, 0.5, 0.1], [0.25, 0.5, 0.1], [0.5, 0.5, 0.1]]}
    gauges |= {"gauges.level_gauges": [[0.0, 0.5], [0.25, 0.5]]}
    tank = {"gravity": [0.0, 0.0, -9.81], "sound_speed": 40.0, "initial.velocity": ["0", "0", "0"]}
    fluid = poiseuille(**tank, **gauges)
    run(fluid, 0.01)
    outputs = outputs_of(fluid)
    pressure = outputs["pressure_gauge.pressure"]
    assert pressure == pytest.approx(pressure[1], rel=1e-3)
    assert pressure[1] == pytest.approx(9810.0 * 0.9, rel=0.02)
    assert outputs["level_gauge.height"] == pytest.approx(1.0, abs=0.03)


def test_a_body_in_a_face_is_pushed_as_inside() -> None:
    """Samples beyond a face act from their places wrapped into the tank."""
    forces = []
    for shift in (0.0, 0.5, 2.0):
        fluid = SphFluid(params_of(ALL, **{"boundary.method": "dbc"}))
        line = (np.arange(3) - 1.0) * SPACING
        arm = np.stack(np.meshgrid(line, line, line), axis=-1).reshape(-1, 3)
        static = {
            "surface.normal": np.tile([0.0, 0.0, 1.0], (27, 1)),
            "surface.volume": np.full(27, SPACING**3),
            "surface.body": np.zeros(27),
        }
        fluid.bind(static, frozenset({"surface", "surface_load"}))
        state = {name: np.array(array) for name, array in fluid.save().items()}
        place = state["position_density"][: fluid.state.fluid, :3]
        hole = np.flatnonzero((np.abs(place - 0.5) < 2.0 * SPACING).all(axis=1))
        state["position_density"][hole, 3] *= 1.001
        place[:, 0] += shift
        fluid.load(state)
        centre = np.array([0.5 + shift + 0.3 * SPACING, 0.5, 0.5])
        velocity = np.tile([1.0, 0.0, 0.0], (27, 1))
        fluid.take({"surface.position": centre + arm, "surface.velocity": velocity})
        fluid.step(1e-5)
        forces.append(outputs_of(fluid)["surface_load.force"])
    assert np.abs(forces[0]).max() > 0.0
    scale = np.abs(forces[0]).max()
    assert forces[1] == pytest.approx(forces[0], abs=1e-9 * scale)
    assert forces[2] == pytest.approx(forces[0], abs=1e-9 * scale)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"boundary.walls": None}, "needs boundary.walls, whose length along x is the period"),
        ({"boundary.open_faces": ["x-"]}, "faces are neither open nor planes of symmetry"),
        ({"boundary.periodic": ["y"]}, "must be x or z in two dimensions"),
        (
            {"boundary.periodic": ["z"], "gravity": [0.0, 0.0, -1.0]},
            "needs gravity without z, for a tank without a bottom",
        ),
        ({"smoothing": 3.0, "boundary.walls": [[0.0, 0.0, 0.0], [0.5, 1.0, 1.0]],
          "fluid": [[[0.0, 0.0, 0.0], [0.5, 1.0, 1.0]]]}, "must be 0.9375 m or more along x"),
        (
            {"boundary.obstacles": [[[0.0, 0.0, 0.0], [0.25, 1.0, 0.25]]],
             "fluid": [[[0.0, 0.0, 0.5], [1.0, 1.0, 1.0]]], "boundary.periodic": ["x"]},
            r"obstacles\[0\] must stand between the faces across x, 0 to 1 m",
        ),
        (
            {"boundary.periodic": ["z"], "boundary.symmetry": ["x-"]},
            "boundary.symmetry is not available with boundary.periodic",
        ),
        (
            {"boundary.motion": {"period": 1.0, "amplitude": [0.1, 0.0, 0.0]}},
            "boundary.motion is not available with boundary.periodic",
        ),
        ({"gauges.front_gauge": "x"}, "front_gauge must not lie along an axis on which"),
    ],
)  # fmt: skip
def test_what_cannot_repeat_is_refused(changes: dict[str, Any], words: str) -> None:
    params, mistakes = read(SphFluidParams, nested(PLANE | changes), "water")
    assert params is None
    assert re.search(words, mistakes[0]), mistakes


def test_several_ranks_are_refused() -> None:
    class Several:
        size, rank = 2, 0

    match = r"boundary.periodic must be empty of a fluid on 2 ranks"
    with pytest.raises(SceneError, match=match):
        SphFluid(params_of(PLANE), Resources(communicator=Several()))
