"""Clouds of nodes that go with bodies: overlaps, holes, walls, and what is refused."""

import subprocess
import sys

import numpy as np
import pytest

from quintet.components.meshless_gas.accuracy import accuracy_notes
from quintet.components.meshless_gas.blunt_bodies import Stream, fay_riddell
from quintet.components.meshless_gas.clouds.grading import capped
from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.moving.kernels.fresh_nodes import write_fresh
from quintet.components.meshless_gas.moving.kernels.fringe import choose
from quintet.components.meshless_gas.moving.outputs import unit_heat
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.errors import SceneError, StepError
from quintet.interfaces.params import read

MACH = 2.5
RADIUS = 0.5  # m
PRESSURE = 1.0 / 1.4  # Pa: the speed of sound is 1 m/s
WAY = 5.0  # radii


def scene(share=0.0, way=WAY, gas=None, bodies=None, **keys):
    """A cylinder that has a share of the relative velocity, the gas the rest."""
    wind = [MACH * (1.0 - share), 0.0, 0.0] if gas is None else gas
    free = {"density": 1.0, "pressure": PRESSURE, "velocity": wind}
    begin = share * way * RADIUS
    body = {
        "centre": [begin, 0.0, 0.0],
        "radius": RADIUS,
        "velocity": [-share * MACH, 0.0, 0.0],
        "points_around": 48,
        "thickness": 0.7,
        "spacing": 0.125,
    }
    inflow = {"kind": "inflow", "state": free}
    return {
        "gas": {"gamma": 1.4, "gas_constant": PRESSURE},
        "neighbours": 8,
        "courant": 0.5,
        "box": {
            "lowest": [-1.7, 0.0, -1.7],
            "highest": [begin + 2.0, 0.0, 1.7],
            "spacing": 0.125,
        },
        "boundaries": {
            "x-": inflow,
            "x+": {"kind": "outflow"} if wind[0] else inflow,
            "z-": inflow,
            "z+": inflow,
        },
        "initial": free,
        "moving": {"bodies": bodies or [body]} | keys,
    }


def params_of(settings):
    params, mistakes = read(MeshlessGasParams, settings, "gas")
    assert not mistakes, mistakes
    return params


def gas_of(settings):
    return MeshlessGas(params_of(settings))


def mean_drag_and_pressure(gas, end):
    """Mean drag coefficient and mean wall pressures of the second half of a flight."""
    drags, pressures = [], []
    while gas.state.time < end - 1e-12:
        gas.step(min(gas.stable_dt(), end - gas.state.time))
        if gas.state.time > 0.5 * end:
            outputs = gas.give(frozenset(["bodies.coefficient", "surface.pressure"]))
            drags.append(outputs["bodies.coefficient"][0, 0])
            pressures.append(outputs["surface.pressure"])
    return np.mean(drags), np.mean(pressures, axis=0)


@pytest.fixture(scope="module")
def fixed_loads():
    return mean_drag_and_pressure(gas_of(scene()), WAY * RADIUS / MACH)


@pytest.mark.parametrize("share", [0.5, 1.0])
def test_a_body_that_moves_feels_what_one_in_a_stream_feels(fixed_loads, share):
    drag, pressure = mean_drag_and_pressure(gas_of(scene(share)), WAY * RADIUS / MACH)
    assert abs(drag / fixed_loads[0] - 1.0) < 0.005
    assert np.abs(pressure - fixed_loads[1]).max() < 0.01 * fixed_loads[1].max()


@pytest.mark.full
def test_a_body_flies_through_a_finer_part_of_a_box_as_through_a_fine_one():
    uniform, refined = scene(1.0), scene(1.0)
    for settings in (uniform, refined):
        settings["box"] |= {"lowest": [-3.0, 0.0, -3.0], "highest": [WAY * RADIUS + 3.0, 0.0, 3.0]}
    path = {"lowest": [-1.9, 0.0, -1.6], "highest": [WAY * RADIUS + 1.6, 0.0, 1.6]}
    refined["box"] |= {"spacing": 0.25, "refinements": [path]}
    fine, coarse = gas_of(uniform), gas_of(refined)
    assert coarse.items() < 0.65 * fine.items()
    drag, pressure = mean_drag_and_pressure(fine, WAY * RADIUS / MACH)
    coarse_drag, coarse_pressure = mean_drag_and_pressure(coarse, WAY * RADIUS / MACH)
    assert abs(coarse_drag / drag - 1.0) < 0.002
    assert np.abs(coarse_pressure - pressure).max() < 0.005 * pressure.max()


def test_a_cloud_that_moves_with_the_gas_leaves_it_uniform():
    gas = gas_of(scene(share=1.0, gas=[-MACH, 0.0, 0.0]))
    for _ in range(12):
        gas.step(gas.stable_dt())
    inner = gas.motion.domain.inner
    assert gas.motion.holes.fresh_count > 20
    assert np.allclose(gas.state.primitive[inner, 1], -MACH, rtol=1e-12)
    assert np.allclose(gas.state.primitive[inner, 4], PRESSURE, rtol=1e-12)


def about_an_axis(**body):
    settings = scene(share=1.0, gas=[-MACH, 0.0, 0.0])
    settings["box"]["lowest"][2] = 0.0
    settings["boundaries"]["z-"] = {"kind": "symmetry"}
    settings["moving"]["axisymmetric"] = True
    settings["moving"]["bodies"][0] |= body
    return settings


def test_a_sphere_that_moves_with_the_gas_leaves_it_uniform_about_an_axis():
    gas = gas_of(about_an_axis())
    for _ in range(12):
        gas.step(gas.stable_dt())
    inner = gas.motion.domain.inner
    assert gas.motion.holes.fresh_count > 10
    assert np.allclose(gas.state.primitive[inner, 1], -MACH, rtol=1e-12)
    assert np.allclose(gas.state.primitive[inner, 4], PRESSURE, rtol=1e-12)


def in_a_stream(**body):
    """A sphere about an axis, in a box that ends where its cloud is cut off."""
    settings = about_an_axis(velocity=[0.0, 0.0, 0.0], centre=[0.0, 0.0, 0.0], **body)
    wind = {"density": 1.0, "pressure": PRESSURE, "velocity": [MACH, 0.0, 0.0]}
    settings |= {"initial": wind}
    leave = {"kind": "outflow"}
    settings["boundaries"] |= {"x-": {"kind": "inflow", "state": wind}, "x+": leave, "z+": leave}
    settings["box"]["highest"][0] = 0.0 if "sector" in body else 1.7
    return settings


def test_a_cloud_that_ends_at_a_sector_says_what_the_whole_says_upstream():
    _, whole_pressure = mean_drag_and_pressure(gas_of(in_a_stream()), 1.2)
    gas = gas_of(in_a_stream(sector=0.5 * np.pi))
    _, cut_pressure = mean_drag_and_pressure(gas, 1.2)
    angle = gas.give(frozenset(["surface.angle"]))["surface.angle"]
    whole_angle = (np.arange(24) + 0.5) * np.pi / 24
    upstream = angle < 1.3
    difference = np.abs(cut_pressure - np.interp(angle, whole_angle, whole_pressure))
    assert difference[upstream].max() < 0.015 * whole_pressure.max()
    imbalance = gas.give(frozenset(["balance.imbalance"]))["balance.imbalance"][0]
    assert abs(imbalance) < 0.01
    saved_state = gas.save()
    gas.step(1e-3)
    after = gas.save()
    gas.load(saved_state)
    gas.step(1e-3)
    assert np.array_equal(gas.state.primitive, after["primitive"])
    still = np.full_like(gas.fluxes.primitive, PRESSURE)  # gas at rest pushes nowhere
    gas.motion.add_flows(gas.motion.domain, still, np.zeros(5))
    base_force = gas.motion.outputs.base_force[0]
    assert base_force[0] == pytest.approx(-np.pi * RADIUS**2 * PRESSURE, rel=2e-3)
    assert np.abs(gas.motion.loads[0, :3] + base_force).max() < 1e-12 * abs(base_force[0])


def test_a_cloud_that_ends_where_its_box_does_not_is_refused():
    settings = in_a_stream(sector=0.5 * np.pi)
    settings["box"]["highest"][0] = 0.5
    with pytest.raises(SceneError, match="must end there too"):
        gas_of(settings)


def test_heat_is_told_over_that_of_fay_and_riddell_at_a_sphere():
    warm = in_a_stream(temperature=2.0) | {"viscous": True}
    warm["gas"] = warm["gas"] | {"viscosity": 1e-3, "reference_temperature": 1.0, "sutherland": 1.0}
    stream = Stream(MACH, PRESSURE, 1.0, 1.4, PRESSURE, 0.72, (1e-3, 1.0, 1.0))
    assert unit_heat(params_of(warm))[0] == pytest.approx(fay_riddell(stream, RADIUS, 2.0))
    flying = about_an_axis(temperature=2.0) | {k: warm[k] for k in ("viscous", "gas")}
    flying["initial"] = warm["initial"] | {"velocity": [0.0, 0.0, 0.0]}
    assert unit_heat(params_of(flying))[0] == pytest.approx(fay_riddell(stream, RADIUS, 2.0))
    assert unit_heat(params_of(in_a_stream()))[0] == np.inf


def test_layers_grow_to_the_largest_and_no_further():
    heights = capped(np.array([0.01, 0.03]), 1.0, 20, 0.07)
    steps = np.diff(heights, axis=0)
    assert np.allclose(steps[0], [0.01, 0.03])
    assert np.allclose(heights[-1], 1.0)
    assert steps.max() < 0.07 + 1e-12
    assert (np.diff(steps, axis=0) > -1e-12).all()


def test_bodies_off_the_axis_are_refused():
    gas = gas_of(about_an_axis(is_driven=True))
    motion = {
        "motion.position": gas.motion.pose.centre + np.array([0.0, 0.0, 0.01]),
        "motion.velocity": gas.motion.pose.velocity,
    }
    with pytest.raises(SceneError, match="lie and move on the axis"):
        gas.take(motion)
    turning = {
        "motion.position": gas.motion.pose.centre,
        "motion.velocity": gas.motion.pose.velocity,
        "motion.angular_velocity": np.array([[0.0, 0.1, 0.0]]),
    }
    with pytest.raises(SceneError, match="do not turn about y"):
        gas.take(turning)


def test_fresh_nodes_get_linear_fields_exactly():
    rng = np.random.default_rng(1)
    positions = rng.uniform(-1.0, 1.0, (9, 3))
    positions[0] = 0.0
    positions[1, ::2], positions[2, ::2] = [0.9, -0.8], [-0.9, 0.8]  # the node lies among them
    field = 3.0 + positions[:, ::2] @ rng.uniform(-0.5, 0.5, (2, 5))
    exact = field[0].copy()
    field[0] = -1.0
    far = np.array([[9.0, 0.0, 9.0]]), np.array([0.1])
    write_fresh(np.array([0]), np.arange(1, 9)[None], positions, np.ones(9), *far, field)
    assert np.allclose(field[0], exact, rtol=1e-9)


def test_nodes_behind_a_body_are_no_neighbours():
    positions = np.array([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [-1.0, 0.0, 2.5]])
    body = np.zeros((1, 3)), np.array([0.5])
    near, candidates = np.zeros((3, 1), np.int32), np.array([[1, 2]])
    lacking_node = choose(np.array([0]), candidates, positions, np.full(3, 0.1), *body, 1, 4, near)
    assert lacking_node == -1
    assert near[0, 0] == 2


def test_nodes_beside_a_coarser_cloud_have_neighbours_on_its_side():
    fine = [[-0.1 * a, 0.0, 0.1 * b] for a in range(4) for b in (0, -1, 1, -2, 2)]
    positions = np.array([*fine, [0.35, 0.0, 0.1], [0.36, 0.0, -0.2]])
    order = np.argsort((positions**2).sum(axis=1), kind="stable")
    near = np.zeros((len(positions), 8), np.int32)
    far = np.array([[9.0, 0.0, 9.0]]), np.array([0.1])
    spacing = np.full(len(positions), 0.1)
    assert choose(np.array([0]), order[None], positions, spacing, *far, 8, 4, near) == -1
    arms = positions[near[0]]
    assert arms[:, 0].max() == 0.35
    assert arms[:, 2].min() < 0.0 < arms[:, 2].max()
    assert arms[:, 0].min() < 0.0
    assert len(set(near[0])) == 8


def test_hysteresis_keeps_nodes_from_coming_and_going():
    counts = []
    for hysteresis in (0.0, 0.3):
        gas = gas_of(scene(share=1.0, hysteresis=hysteresis))
        for _ in range(60):
            gas.step(gas.stable_dt())
        counts.append(gas.motion.holes.fresh_count)
    assert counts[1] < 0.8 * counts[0]


def test_what_bodies_get_the_gas_loses():
    gas = gas_of(scene(share=1.0, gas=[0.0, 0.0, 0.0]))
    gas.step(gas.stable_dt())
    before, dt = gas.state.entered.copy(), gas.stable_dt()
    gas.step(dt)
    force = gas.give(frozenset(["bodies.force"]))["bodies.force"][0]
    momentum_rate = (gas.state.entered - before)[1:4] / dt
    assert np.abs(momentum_rate + force).max() < 1e-12 * np.abs(force).max()


def test_a_saved_state_goes_on_with_the_same_bits():
    gas = gas_of(scene(share=1.0))
    for _ in range(7):
        gas.step(gas.stable_dt())
    saved_state, runs = gas.save(), []
    for _ in range(2):
        gas.load(saved_state)
        for _ in range(9):
            gas.step(gas.stable_dt())
        runs.append(gas.save())
    resumed = gas_of(scene(share=1.0))
    resumed.load(saved_state)
    for _ in range(9):
        resumed.step(resumed.stable_dt())
    runs.append(resumed.save())
    for name, array in runs[0].items():
        assert np.array_equal(array, runs[1][name], equal_nan=True), name
        assert np.array_equal(array, runs[2][name], equal_nan=True), name


def test_a_body_that_leaves_the_box_is_refused():
    gas = gas_of(scene(share=1.0, way=1.0))
    with pytest.raises(StepError, match="must stay within the box"):
        for _ in range(400):
            gas.step(gas.stable_dt())


def two_bodies(gap):
    return [
        {
            "centre": [x, 0.0, 0.0],
            "radius": 0.25,
            "points_around": 32,
            "thickness": 0.35,
            "first_spacing": 0.02,
            "spacing": 0.125,
            "velocity": [speed, 0.0, 0.0],
        }
        for x, speed in ((0.0, 0.0), (0.5 + gap, -1.0))
    ]


def test_bodies_that_touch_at_the_start_are_a_mistake_of_the_scene():
    pattern = r"moving.bodies.1: bodies 0 and 1 must leave room for two layers .* found 0 m between"
    with pytest.raises(SceneError, match=pattern):
        gas_of(scene(bodies=two_bodies(0.0), gas=[0.0, 0.0, 0.0]))


def test_a_body_whose_cloud_does_not_fit_into_the_box_is_a_mistake_of_the_scene():
    settings = scene()
    settings["moving"]["bodies"][0]["centre"][2] = 1.0
    with pytest.raises(SceneError, match=r"moving.bodies.0: .* across z. Make the box longer"):
        gas_of(settings)


def test_partners_whose_bodies_are_smaller_or_fewer_are_refused():
    gas = gas_of(scene(bodies=[two_bodies(0.5)[0] | {"is_driven": True}], gas=[0.0, 0.0, 0.0]))
    for size in (0.5, 0.75):  # larger ones keep others at a distance
        gas.bind({"motion.radius": np.full(1, 0.5 * size)}, frozenset())
    pattern = (
        r"moving.bodies.0: .* at least as large as that in the gas, 0.5 m across, .* 0.4 m. Give"
    )
    with pytest.raises(SceneError, match=pattern):
        gas.bind({"motion.radius": np.full(1, 0.2)}, frozenset())
    with pytest.raises(SceneError, match=r"found 1 driven bodies and 2 of the partner"):
        gas.bind({"motion.radius": np.full(2, 0.25)}, frozenset())


def test_partners_whose_bodies_begin_elsewhere_are_refused():
    gas = gas_of(scene(bodies=[two_bodies(0.5)[0] | {"is_driven": True}], gas=[0.0, 0.0, 0.0]))
    centre = gas.motion.pose.centre.copy()
    gas.prime({"motion.position": centre})
    with pytest.raises(SceneError, match=r"moving.bodies.0: .* must begin where the gas has it"):
        gas.prime({"motion.position": centre + np.array([1e-6, 0.0, 0.0])})


@pytest.mark.parametrize(("position", "velocity"), [(0.01, 0.0), (0.0, 0.3)])
def test_driven_bodies_that_leave_the_plane_are_refused(position, velocity):
    bodies = [two_bodies(0.5)[0] | {"is_driven": True}]
    gas = gas_of(scene(bodies=bodies, gas=[0.0, 0.0, 0.0]))
    motion = {
        "motion.position": gas.motion.pose.centre + np.array([0.0, position, 0.0]),
        "motion.velocity": gas.motion.pose.velocity + np.array([0.0, velocity, 0.0]),
    }
    with pytest.raises(SceneError, match=r"the plane y = 0; the partner of body 0 is at"):
        gas.take(motion)
    motion["motion.velocity"] = np.array([[1.0, 1e-17, 0.0]])
    motion["motion.position"] = np.array([[0.001, -1e-17, 0.0]])
    gas.take(motion)
    assert gas.motion.pose.velocity[0].tolist() == [1.0, 0.0, 0.0]


def test_bodies_that_come_near_each_other_run_until_they_nearly_touch():
    gas = gas_of(scene(bodies=two_bodies(0.5), gas=[0.0, 0.0, 0.0]))
    with pytest.raises(StepError, match="must leave room for two layers"):
        for _ in range(400):
            gas.step(gas.stable_dt())
    assert gas.motion.pose.centre[1, 0] - 0.5 < 0.2
    assert (
        gas.state.primitive[gas.motion.domain.inner, 4].max() > 1.2 * PRESSURE
    )  # gas between them


def test_clouds_with_too_few_neighbours_are_refused():
    with pytest.raises(SceneError, match="8 neighbours"):
        gas_of(scene() | {"neighbours": 6})


def test_scenes_without_bodies_import_no_seams():
    code = (
        "import sys; import quintet.components.meshless_gas.component; "
        "sys.exit('quintet.components.meshless_gas.moving.clouds' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


@pytest.mark.parametrize(("share", "wind"), [(0.0, None), (1.0, [0.0, 0.0, 0.0])])
def test_the_accuracy_of_a_supersonic_body_is_told_by_its_resolution(share, wind):
    (note,) = accuracy_notes(params_of(scene(share, gas=wind)))
    assert "4 nodes on its radius" in note
    assert "about 0.407 m" in note, "0.386 exp(4.67 / M²) radii of a cylinder"
    assert "too large by about 15 %" in note, "half of a spacing of 0.125 m"
    assert accuracy_notes(params_of(scene(0.0, gas=[0.5, 0.0, 0.0]))) == (), "it is subsonic"
    (note,) = accuracy_notes(params_of(in_a_stream(shock_height=0.12, shock_spacing=0.012)))
    assert "about 0.12 m" in note, "0.143 exp(3.24 / M²) radii of a sphere"
    assert "too large by about 10 %" in note
