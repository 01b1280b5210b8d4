"""Bodies in water at extremes: light, heavy, fast, outside the domain, stiff."""

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from quintet.coupler.files.recording import Recording

Run = Callable[..., dict]

SCENE = str(Path(__file__).parent / "small_tank.toml")
BODY = "components.cube.bodies.0"
EDGE, SOUND, G = 0.15, 18.0, 9.81  # m, m/s, m/s2
DISPLACED = 0.1  # m, draught at release
# A slab of water above a cube that starts at the floor.
SLAB = '[{shape = "box", lowest = [0.0, 0.0, 0.2], highest = [0.35, 0.35, 0.4]}]'


@pytest.fixture(scope="module")
def go(run_scene: Run) -> Run:
    """Run with settings; return the results with time [s], height [m] and rise [m/s]."""

    def run(settings: dict) -> dict:
        options = [
            text for path, value in settings.items() for text in ("--set", f"{path}={value}")
        ]
        results = run_scene(SCENE, *options)
        (link,) = results["ledger"]["links"]
        assert results["status"] == "done" and link["momentum_residual"] < 1e-12, results
        with Recording(results["folder"]) as recording:
            results["t"] = recording.times("cube")
            results["x"] = recording.history("cube", "motion.position", 0)
            results["v"] = recording.history("cube", "motion.velocity", 0)
        return results

    return run


def balanced(density: float, window: float, **settings: object) -> dict:
    """Settings of a cube of any density [kg/m3] whose weight equals its buoyancy."""
    gravity = -G * 1000.0 * DISPLACED / EDGE / density
    body = {f"{BODY}.density": density, "components.cube.gravity": [0.0, 0.0, gravity]}
    return body | {"window": window} | settings


@pytest.mark.parametrize("ratio", [0.1, 0.5, 1.0, 5.0, 20.0])
def test_bodies_of_every_density_rise_or_sink_no_faster_than_they_can(
    go: Run, ratio: float
) -> None:
    results = go({f"{BODY}.density": 1000.0 * ratio})
    free = G * (DISPLACED / EDGE / ratio - 1.0)  # m/s2, by weight and buoyancy alone
    height, rise = results["x"][:, 2], results["v"][:, 2]
    assert np.sign(height[-1] - height[0]) == np.sign(free) or ratio == 0.5
    if ratio > 1.0:  # fully immersed in the end
        assert -G * results["t"][-1] < rise[-1] < -0.5 * G * (1.0 - 1.0 / ratio) * results["t"][-1]
    if ratio < 0.5:
        energy = 0.5 * 1000.0 * G * DISPLACED**2 / (1000.0 * ratio * EDGE)  # J/kg, of the water
        assert 0.5 * rise.max() ** 2 < energy


def test_windows_that_hold_a_light_cube_are_as_long_as_predicted(go: Run) -> None:
    # The sound that it radiates resists with ρ c a² per velocity: in a window at most two masses.
    density = 50.0
    limit = 2.0 * density * EDGE / (1000.0 * SOUND)  # s
    stable = go(balanced(density, 0.4 * limit))
    unstable = go(balanced(density, 6.0 * limit))
    assert np.abs(stable["v"][:, 2]).max() < 0.6
    assert np.abs(unstable["v"][:, 2]).max() > 2.0
    # Iterated to convergence, long windows give the motion of short ones.
    iteration = {"scheme": "iterated", "iteration.tolerance": 1e-3}
    iterated = go(balanced(density, 6.0 * limit, **iteration))
    expected = np.interp(iterated["t"], stable["t"], stable["x"][:, 2])
    assert np.abs(iterated["x"][:, 2] - expected).max() < 1e-3


@pytest.mark.parametrize("density", [1000.0, 20000.0])
def test_no_window_is_too_long_for_a_cube_heavier_than_its_added_mass(
    go: Run, density: float
) -> None:
    results = go(balanced(density, 2e-2))
    assert np.abs(results["v"][:, 2]).max() < 0.3


def test_a_cube_dropped_at_20_m_per_s_is_slowed_by_the_water_that_it_takes_along(go: Run) -> None:
    fall = {
        f"{BODY}.density": 800.0,
        f"{BODY}.lowest": [0.1, 0.1, 0.325],
        f"{BODY}.highest": [0.25, 0.25, 0.475],
        f"{BODY}.velocity": [0.0, 0.0, -20.0],
        "components.water.sound_speed": 200.0,
        "window": 1e-4,
        "end": 0.02,
    }
    results = go(fall)
    height, rise = results["x"][:, 2], results["v"][:, 2]
    # Von Kármán (NACA TN 321, 1929): it shares its momentum with half the added mass of a plate,
    # 0.455 ρ a³ for a square, and between walls with more.
    shared = -20.0 * 800.0 / (800.0 + 0.5 * 0.455 * 1000.0)
    assert shared < rise[50] < 0.0
    assert rise.min() > -20.0 - G * 2e-3 and abs(rise[-1]) < abs(rise[50])
    assert height.min() > 0.5 * EDGE


def test_a_cube_that_leaves_the_domain_flies_on_freely(go: Run) -> None:
    up = {f"{BODY}.velocity": [3.0, 0.0, 30.0], "end": 0.3, "window": 5e-3}
    results = go(up)
    t, v = results["t"], results["v"]
    out = results["x"][:, 2] > 1.5
    assert results["x"][-1, 2] > 5.0
    np.testing.assert_allclose(np.diff(v[out, 2]), -G * np.diff(t[out]), rtol=1e-6)
    np.testing.assert_allclose(np.diff(v[out, 0]), 0.0, atol=1e-9)


@pytest.mark.parametrize("young", [3e9, 2e11])
def test_stiff_cubes_rest_on_the_floor_under_water(go: Run, young: float) -> None:
    sunk = {
        f"{BODY}.density": 7800.0,
        f"{BODY}.lowest": [0.1, 0.1, 0.0001],
        f"{BODY}.highest": [0.25, 0.25, 0.1501],
        "components.cube.materials.plastic.youngs_modulus": young,
        "components.water.fluid": SLAB,
        "end": 0.1,
    }
    results = go(sunk)
    assert results["x"][-1, 2] == pytest.approx(0.075, abs=2e-4)
    assert np.abs(results["v"][-1]).max() < 0.02
    # Hertz's contact is 1 / sqrt(E) long, the step a fraction of it.
    step = 0.1 / results["timing"]["components"]["cube"]["steps"]
    assert step * math.sqrt(young) < 10.0
