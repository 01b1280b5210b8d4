"""Laws of clouds, least squares and fluxes."""

import math

import numpy as np
import pytest
from gases import GAMMA, gas_in_box, output, run
from scipy.spatial import cKDTree

from quintet.components.meshless_gas.kernels.ghosts import write_ghost_gradients
from quintet.components.meshless_gas.laws import fluxes as laws
from quintet.components.meshless_gas.laws import limiters
from quintet.components.meshless_gas.laws.boundaries import GATE
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.components.shared.search.nearest import nearest
from quintet.components.shared.threads import Team
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import read

AIR = {"density": 1.0, "pressure": 1.0}
LEFT, RIGHT = (1.3, 0.2, 2.0), (0.7, -0.4, 0.9)


def test_nearest_points_are_those_of_every_distance():
    rng = np.random.default_rng(3)
    points = np.cumsum(rng.exponential(1.0, (500, 3)) ** 3, axis=0)  # spacings differ by 1000
    targets = points[rng.integers(0, 500, 60)] + rng.normal(0.0, 1.0, (60, 3))
    neighbours, squares = nearest(points, np.arange(0, 500, 2), targets, 7, Team(1))
    distances, rows = cKDTree(points[::2]).query(targets, 7)
    assert np.array_equal(neighbours, 2 * rows)
    assert np.sqrt(squares) == pytest.approx(distances)


def flux(left, right, lowest=1e9):
    """Mass, momentum and energy between two states along x."""
    first, second, pressure = laws.ausmpw.py_func(*left, *right, lowest, GAMMA)
    total = [0.0, pressure, 0.0]
    for carried, (density, u, p) in ((first, left), (second, right)):
        enthalpy = GAMMA / (GAMMA - 1.0) * p / density + 0.5 * u * u
        total = [a + carried * b for a, b in zip(total, (1.0, u, enthalpy), strict=True)]
    return total


def test_flux_between_equal_states_is_theirs():
    for density, u, p in (LEFT, RIGHT, (1.0, 3.0, 0.5), (1.0, -3.0, 0.5)):
        energy = p / (GAMMA - 1.0) + 0.5 * density * u * u
        exact = [density * u, density * u * u + p, u * (energy + p)]
        assert flux((density, u, p), (density, u, p)) == pytest.approx(exact)


def test_flux_is_that_of_the_side_from_which_gas_comes_faster_than_sound():
    fast = (1.0, 3.0, 0.5)
    assert flux(fast, (0.8, 2.5, 0.4)) == pytest.approx(flux(fast, fast))


def test_flux_of_the_mirror_image_is_the_image_of_the_flux():
    mass, momentum, energy = flux(LEFT, RIGHT)
    mirrored = flux(*((density, -u, p) for density, u, p in (RIGHT, LEFT)))
    assert mirrored == pytest.approx([-mass, momentum, -energy])


def test_change_to_the_middle_is_exact_for_parabolas_and_nothing_at_extremes():
    assert limiters.van_albada.py_func(-1.0, 3.0, 0.0) == 0.0
    assert limiters.van_albada.py_func(2.0, 2.0, 0.0) == pytest.approx(1.0)
    # Means of x² over cells of 1: 1/12, 13/12, 49/12; at the side of the middle one it is 9/4.
    assert 13 / 12 + limiters.van_albada.py_func(1.0, 3.0, 1e9) == pytest.approx(9 / 4)


def test_wall_pressure_is_that_behind_the_shock_that_stops_the_gas():
    mach = 2.0
    ratio = laws.wall_pressure.py_func(1.0, mach, GAMMA)
    # Rankine and Hugoniot: what a shock of this pressure ratio stops.
    speed = (ratio - 1.0) / math.sqrt(GAMMA * ((GAMMA + 1.0) * ratio + GAMMA - 1.0) / 2.0)
    assert speed == pytest.approx(mach)


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_a_wall_that_gas_meets_slowly_has_its_pressure(share):
    sides = {f"{axis}{side}": {"kind": "slip"} for axis in "xz" for side in "-+"}
    gas = gas_in_box(
        initial=AIR | {"velocity": [share * GATE * math.sqrt(GAMMA), 0.0, 0.0]}, boundaries=sides
    )
    cloud = gas.motion.domain.cloud
    pressure = gas.state.primitive[cloud.normals[: cloud.nodes, 0] < -0.9, 4]
    assert np.allclose(pressure, 1.0, atol=1e-12) if share < 1.0 else (pressure > 1.5).all()


def test_gradients_of_ghosts_are_those_of_the_turned_field():
    turn = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0]
    scalar, tensor = np.array([1.0, 2.0, 3.0]), np.arange(9.0).reshape(3, 3)
    gradients = np.zeros((2, 5, 3))
    gradients[0, 0], gradients[0, 1:4] = scalar, tensor
    write_ghost_gradients(0, 1, np.zeros(1, np.int32), turn[None], gradients, np.ones(2))
    assert gradients[1, 0] == pytest.approx(turn @ scalar)
    assert gradients[1, 1:4] == pytest.approx(turn @ tensor @ turn.T)


@pytest.mark.parametrize("kind", ["periodic", "symmetry", "slip"])
def test_a_stream_along_its_boundaries_stays_as_it_is(kind):
    wind = AIR | {"velocity": [1.5, 0.0, 0.0]}
    ends = {"x-": {"kind": "inflow", "state": wind}, "x+": {"kind": "outflow"}}
    sides = {} if kind == "periodic" else {"z-": {"kind": kind}, "z+": {"kind": kind}}
    gas = run(gas_in_box(initial=wind, boundaries={**ends, **sides}), 0.5)
    assert gas.state.primitive == pytest.approx(
        np.tile([1.0, 1.5, 0.0, 0.0, 1.0], (gas.items(), 1))
    )
    assert output(gas, "balance.imbalance") == pytest.approx(0.0, abs=1e-12)
    assert output(gas, "balance.mass_drift") == pytest.approx(0.0, abs=1e-12)


def test_areas_of_a_box_close_and_its_volumes_fill_it():
    sides = {f"{axis}{side}": {"kind": "slip"} for axis in "xz" for side in "-+"}
    cloud = gas_in_box(initial=AIR, boundaries=sides).motion.domain.cloud
    assert cloud.areas.sum(axis=0) == pytest.approx(np.zeros(3))
    assert np.abs(cloud.areas).sum(axis=0) == pytest.approx([2.0, 0.0, 2.0])
    assert cloud.volumes.sum() == pytest.approx(1.0)


def test_a_gas_from_rest_flows_through_a_subsonic_channel_at_its_pressure():
    gas = gas_in_box(
        initial=AIR | {"velocity": [0.4, 0.0, 0.0]},
        boundaries={
            "x-": {"kind": "inflow", "total": {"pressure": 1.2, "temperature": 1.0}},
            "x+": {"kind": "outflow", "pressure": 1.0},
        },
        box={"highest": [1.0, 0.0, 0.5]},
        local_steps=True,
    )
    for _ in range(600):
        gas.step(gas.stable_dt())
    mach = math.sqrt(2.0 / (GAMMA - 1.0) * (1.2 ** ((GAMMA - 1.0) / GAMMA) - 1.0))
    density, u, _, _, pressure = gas.state.primitive[gas.motion.domain.inner].mean(axis=0)
    assert u / math.sqrt(GAMMA * pressure / density) == pytest.approx(mach, rel=0.01)
    assert pressure == pytest.approx(1.0, rel=0.01)


@pytest.mark.parametrize(
    ("keys", "sentence"),
    [
        (
            {"neighbours": 2},
            r"must surround each node; the 2 of node .* Raise neighbours",
        ),
        (
            {"neighbours": 64, "box": {"spacing": 0.5}},
            "must be below the number of nodes",
        ),
    ],
)
def test_a_cloud_with_too_few_neighbours_is_refused(keys, sentence):
    sides = {f"{axis}{side}": {"kind": "slip"} for axis in "xz" for side in "-+"}
    with pytest.raises(SceneError, match=sentence):
        gas_in_box(initial=AIR, boundaries=sides, **keys)


@pytest.mark.parametrize(
    ("keys", "sentence"),
    [
        ({}, "begins with initial or riemann"),
        ({"initial": {"pressure": 1.0}}, "needs density or temperature"),
        ({"initial": AIR, "boundaries": {"y-": {"kind": "slip"}}}, "y- is not known"),
        ({"initial": AIR, "boundaries": {"x-": {"kind": "slip"}}}, "must be periodic or none"),
        ({"initial": AIR, "boundaries": {"x-": {"kind": "inflow"}}}, "takes state or total"),
        ({"initial": AIR, "vortex": {"centre": [0, 0, 0], "strength": 20.0}}, "must leave gas"),
    ],
)
def test_a_wrong_gas_is_refused(keys, sentence):
    box = {"lowest": [0.0, 0.0, 0.0], "highest": [1.0, 1.0, 1.0], "spacing": 0.1}
    _, mistakes = read(MeshlessGasParams, {"box": box, **keys}, "gas")
    assert any(sentence in mistake for mistake in mistakes), mistakes
