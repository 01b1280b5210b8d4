"""Clouds of nodes that go with bodies in space: shells, overlaps, and what is refused."""

import math

import numpy as np
import pytest

from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.moving.kernels.fresh_nodes import write_fresh_in_space
from quintet.components.meshless_gas.moving.shells import shell
from quintet.components.meshless_gas.moving_bodies import Body
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import read

MACH = 3.0
PRESSURE = 1.0 / 1.4  # Pa: the speed of sound is 1 m/s
OBLIQUE = np.array([0.8, 0.36, 0.48])  # of length 1


@pytest.mark.parametrize(("is_cross", "most"), [(False, 20), (True, 8)])
def test_shells_fill_their_space_and_nodes_have_those_around_them(is_cross, most):
    body = Body(centre=(0.0, 0.0, 0.0), radius=1.0, points_around=24, thickness=0.5, spacing=0.2)
    body_shell = shell(body, 1, 0, is_cross)
    nodes, outer = body_shell.cloud.nodes, 1.0 + body.heights[-1]
    assert nodes == 162 * len(body.heights)
    walls = body_shell.cloud.areas[: body_shell.rays]
    assert math.isclose(np.sqrt((walls**2).sum(axis=1)).sum(), 4.0 * math.pi, rel_tol=1e-12)
    assert np.allclose(walls.sum(axis=0), 0.0, atol=1e-12)
    assert not body_shell.cloud.areas[body_shell.rays :].any()
    volume = 4.0 / 3.0 * math.pi * (outer**3 - 1.0)
    assert math.isclose(body_shell.cloud.volumes.sum(), volume, rel_tol=0.01)
    near = body_shell.home != np.arange(nodes)[:, None]
    assert near.sum(axis=1).max() == most
    pairs = {(i, j) for i in range(nodes) for j in body_shell.home[i] if i != j}
    assert all((j, i) in pairs for i, j in pairs)


def scene(share=0.0, gas=None, way=4.0, direction=(1.0, 0.0, 0.0), cross=True, **keys):
    """A sphere that has a share of the relative velocity, the gas the rest."""
    along = np.array(direction)
    wind = list(MACH * (1.0 - share) * along) if gas is None else gas
    free = {"density": 1.0, "pressure": PRESSURE, "velocity": list(wind)}
    begin = share * way * along
    body = {
        "centre": list(begin),
        "radius": 1.0,
        "velocity": list(-share * MACH * along),
        "points_around": 24,
        "thickness": 0.7,
        "spacing": 0.3,
        "first_spacing": 0.15,
    }
    inflow = {"kind": "inflow", "state": free}
    outflow = {"kind": "outflow"}
    sides = {face: outflow if any(wind) else inflow for face in ("y-", "y+", "z-", "z+", "x+")}
    return {
        "gas": {"gamma": 1.4, "gas_constant": PRESSURE},
        "dimensions": 3,
        "neighbours": 18,
        "courant": 0.6,
        "box": {
            "lowest": list(np.minimum(begin, 0.0) - 2.7),
            "highest": list(np.maximum(begin, 0.0) + 2.7),
            "spacing": 0.3,
        },
        "boundaries": {"x-": inflow} | sides,
        "initial": free,
        "moving": {"bodies": [body], "line_stencils": cross},
    } | keys


def gas_of(settings):
    params, mistakes = read(MeshlessGasParams, settings, "gas")
    assert not mistakes, mistakes
    return MeshlessGas(params)


@pytest.mark.full
@pytest.mark.parametrize("cross", [False, True])
def test_a_cloud_that_moves_with_the_gas_leaves_it_uniform_in_space(cross):
    gas = gas_of(scene(share=1.0, gas=-MACH * OBLIQUE, way=2.0, direction=OBLIQUE, cross=cross))
    for _ in range(8):
        gas.step(gas.stable_dt())
    inner = gas.motion.domain.inner
    assert gas.motion.holes.fresh_count > 20
    same = [1.0, *(-MACH * OBLIQUE), PRESSURE]
    assert np.abs(gas.state.primitive[inner] - same).max() < 1e-12


@pytest.mark.full
def test_fresh_nodes_get_linear_fields_exactly_in_space():
    rng = np.random.default_rng(1)
    positions = rng.uniform(-1.0, 1.0, (13, 3))
    positions[0] = 0.0
    positions[1], positions[2] = [0.9, -0.8, 0.7], [-0.9, 0.8, -0.7]  # the node lies among them
    field = 3.0 + positions @ rng.uniform(-0.5, 0.5, (3, 5))
    exact = field[0].copy()
    field[0] = -1.0
    far = np.array([[9.0, 0.0, 9.0]]), np.array([0.1])
    write_fresh_in_space(np.array([0]), np.arange(1, 13)[None], positions, np.ones(13), *far, field)
    assert np.allclose(field[0], exact, rtol=1e-9)


@pytest.mark.full
def test_of_first_order_at_seams_states_are_constant_around_nodes_that_reach_over_them():
    settings = scene()
    gas = gas_of(settings)
    settings["moving"]["fringe_order"] = 1
    first_order = gas_of(settings)
    gas.step(gas.stable_dt())
    first_order.step(first_order.stable_dt())
    across = first_order.motion.fringe.across
    assert len(across) > 100
    assert not first_order.fluxes.gradients[across].any()
    assert gas.fluxes.gradients[across].any()
    assert first_order.fluxes.gradients[first_order.motion.domain.inner].any()


@pytest.mark.full
def test_a_saved_state_goes_on_with_the_same_bits_in_space():
    gas = gas_of(scene(share=1.0, direction=OBLIQUE))
    for _ in range(4):
        gas.step(gas.stable_dt())
    saved_state, resumed = gas.save(), gas_of(scene(share=1.0, direction=OBLIQUE))
    resumed.load(saved_state)
    for solver in (gas, resumed):
        for _ in range(5):
            solver.step(solver.stable_dt())
    for name, array in gas.save().items():
        assert np.array_equal(array, resumed.save()[name], equal_nan=True), name


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"neighbours": 6}, "8 neighbours"),
        ({"moving.axisymmetric": True}, "need two dimensions"),
        ({"dimensions": 2}, "three dimensions and lattices"),
        ({"box.jitter": 0.2}, "lattices without jitter"),
        ({"viscous": True, "moving.fringe_order": 1}, "gradients at overlaps"),
    ],
)
def test_what_clouds_in_space_do_not_go_with_is_refused(change, sentence):
    settings = scene()
    for path, value in change.items():
        table, _, key = path.rpartition(".")
        (settings[table] if table else settings)[key] = value
    if "moving.axisymmetric" in change:
        settings["box"]["lowest"][2] = 0.0
        settings["boundaries"]["z-"] = {"kind": "symmetry"}
    if settings["dimensions"] == 2:
        for face in ("y-", "y+"):
            settings["boundaries"].pop(face)
    with pytest.raises(SceneError, match=sentence):
        gas_of(settings)


def test_shells_that_end_in_a_plane_fill_half_of_their_space():
    body = Body(
        centre=(0.0, 0.0, 0.0), radius=1.0, points_around=40, thickness=0.5, spacing=0.2,
        first_spacing=0.05,
        sector=0.5 * math.pi, first_spacing_at_sector=0.06,
    )  # fmt: skip
    body_shell = shell(body, 1, 0, True)
    positions, outer = body_shell.cloud.positions, 1.0 + body.heights[-1]
    assert positions[:, 0].max() < 1e-12
    assert np.allclose(positions[body_shell.leaving, 0], 0.0, atol=1e-12)
    assert len(body_shell.leaving) % (len(body.heights) - 1) == 0
    walls = body_shell.cloud.areas[: body_shell.rays]
    assert np.allclose(walls.sum(axis=0), [-math.pi, 0.0, 0.0], atol=0.02)
    volume = 2.0 / 3.0 * math.pi * (outer**3 - 1.0)
    assert math.isclose(body_shell.cloud.volumes.sum(), volume, rel_tol=0.02)
    # Beside each lies one that is advanced, nearer to the axis and of the same shell.
    apart = positions[body_shell.before] - positions[body_shell.leaving]
    assert (apart[:, 0] < 0.0).all()
    assert np.isin(body_shell.cloud.kind[body_shell.before], 0).all()
    assert np.sqrt((apart**2).sum(axis=1)).max() < 0.5


def drag(share, direction):
    """Mean coefficient of drag along a direction, over the last two of four radii of way."""
    settings = scene(share=share, direction=direction)
    body = settings["moving"]["bodies"][0]
    body |= {"points_around": 36, "spacing": 0.2, "thickness": 0.75}
    body.pop("first_spacing")
    settings["box"]["spacing"] = 0.2
    gas, end, coefficients = gas_of(settings), 4.0 / MACH, []
    while gas.state.time < end - 1e-12:
        gas.step(min(gas.stable_dt(), end - gas.state.time))
        if gas.state.time > 0.5 * end:
            coefficients.append(
                gas.give(frozenset(["bodies.coefficient"]))["bodies.coefficient"][0]
            )
    return float(np.mean(coefficients, axis=0) @ np.array(direction))


@pytest.mark.full
@pytest.mark.parametrize("direction", [(1.0, 0.0, 0.0), tuple(OBLIQUE)])
def test_a_sphere_that_flies_in_space_has_the_drag_of_one_in_a_stream(direction):
    fixed = drag(0.0, direction)
    assert drag(1.0, direction) == pytest.approx(fixed, rel=0.02)
    assert drag(0.5, direction) == pytest.approx(fixed, rel=0.02)
