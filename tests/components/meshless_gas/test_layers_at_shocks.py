"""Layers of a body's cloud that are finer where its bow shock stands."""

import numpy as np
import pytest

from quintet.components.meshless_gas.blunt_bodies import pitot_pressure
from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.params import read

MACH = 3.0
PRESSURE = 1.0 / 1.4  # Pa: the speed of sound is 1 m/s
STANDOFF = 0.213  # radii, of the scene blunt_sphere at this Mach number, extrapolated
SPACING = 0.1
FINE = {"shock_height": 0.22, "shock_spacing": 0.025}


def params_of(**body):
    """A sphere of radius 1 m, fixed in a stream, half of it in a box about an axis."""
    wind = {"density": 1.0, "pressure": PRESSURE, "velocity": [MACH, 0.0, 0.0]}
    sphere = {"centre": [0.0, 0.0, 0.0], "radius": 1.0, "points_around": 96, "thickness": 0.9}
    settings = {
        "gas": {"gamma": 1.4, "gas_constant": PRESSURE},
        "neighbours": 8,
        "courant": 0.5,
        "limiter": "van_albada",
        "initial": wind,
        "box": {"lowest": [-2.3, 0.0, 0.0], "highest": [3.2, 0.0, 2.6], "spacing": SPACING},
        "boundaries": {
            "x-": {"kind": "inflow", "state": wind},
            "x+": {"kind": "outflow"},
            "z-": {"kind": "symmetry"},
            "z+": {"kind": "outflow"},
        },
        "moving": {"axisymmetric": True, "bodies": [sphere | {"spacing": SPACING} | body]},
    }
    return read(MeshlessGasParams, settings, "gas")


def mean_standoff_and_pressure(**body):
    """Stand-off in radii and highest pressure on the wall over the pitot pressure."""
    params, mistakes = params_of(**body)
    assert not mistakes
    gas = MeshlessGas(params)
    domain = gas.motion.domain
    places = domain.cloud.positions[domain.every]
    axis = (places[:, 2] < 0.6 * SPACING) & (places[:, 0] < -1.0) & (places[:, 0] > -1.7)
    rows = domain.every[axis][np.argsort(-places[axis, 0])]
    heights = -domain.cloud.positions[rows, 0] - 1.0
    ratio = 1.0 + 2.8 / 2.4 * (MACH**2 - 1.0)  # of pressures across a normal shock
    end, standoffs, pressures = 6.0, [], []
    while gas.state.time < end - 1e-12:
        gas.step(min(gas.stable_dt(), end - gas.state.time))
        if gas.state.time > 0.5 * end:
            middle = 0.5 * PRESSURE * (1.0 + ratio)
            standoffs.append(np.interp(-middle, -gas.state.primitive[rows, 4], heights))
            field = "bodies.highest_pressure"
            pressures.append(gas.give(frozenset([field]))[field][0])
    pitot = pitot_pressure(MACH, 1.4) * PRESSURE
    return np.mean(standoffs), np.mean(pressures) / pitot


def test_layers_are_finest_at_the_shock_and_widen_away_from_it():
    params, _ = params_of(**FINE)
    heights = np.array(params.moving.bodies[0].heights)
    steps = np.diff(heights)
    at_shock = (heights[:-1] > 0.75 * 0.22) & (heights[:-1] < 1.25 * 0.22)
    np.testing.assert_allclose(steps[at_shock], 0.025, rtol=1e-12)
    assert steps.min() == pytest.approx(0.025)
    assert steps.max() <= SPACING + 1e-12
    away = np.maximum(np.abs(heights[:-1] - 0.22) - 0.055, 0.0)
    assert (steps <= 0.025 + 0.5 * away + 1e-12).all()
    assert params.moving.finest_spacing == 0.025


def test_layers_a_quarter_as_thick_halve_the_error_of_the_stand_off():
    standoff, pressure = mean_standoff_and_pressure()
    assert 0.15 < standoff / STANDOFF - 1.0 < 0.22
    finer_standoff, finer_pressure = mean_standoff_and_pressure(**FINE)
    assert 0.0 < finer_standoff / STANDOFF - 1.0 < 0.6 * (standoff / STANDOFF - 1.0)
    assert abs(pressure - 1.0) < 0.04
    assert abs(finer_pressure - 1.0) < 0.025


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ({"shock_height": 0.2}, "belong together"),
        ({"shock_spacing": 0.02}, "belong together"),
        (
            FINE | {"sector": np.pi / 2, "first_spacing_at_sector": 0.05},
            "found first_spacing_at_sector beside it",
        ),
        ({"first_spacing": 1e-12, "growth": 1.0}, "at most 10000 layers; found more over"),
        ({"thickness": 1e9}, "at most 10000 layers; found more over a thickness of 1e+09 m"),
        (FINE | {"shock_spacing": 1e-300}, "Lower thickness, or raise first_spacing"),
    ],
)
def test_settings_that_contradict_each_other_are_refused(body, message):
    _, mistakes = params_of(**body)
    assert message in str(mistakes)
