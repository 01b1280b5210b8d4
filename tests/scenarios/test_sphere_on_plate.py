"""A sphere strikes a thin plate: Zener's equation, by which the scene is judged."""

import tomllib
from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from quintet.coupler.scene.read import library

Run = Callable[..., dict]
RADIUS, THICK, GAP = 5e-3, 4e-3, 5e-7  # m
STEEL, ALUMINIUM = (2.1e11, 0.3, 7800.0), (7.0e10, 0.33, 2700.0)  # Pa, 1, kg/m3


def zener(speed: float) -> tuple[float, float, float]:
    """Rebound [m/s], time of rest [s] after the touch, and deflection [m] of the plate after it.

    C. Zener, Phys. Rev. 59 (1941) 669: d²σ/dτ² + (1 + λ d/dτ) σ^{3/2} = 0.
    """
    (e_i, nu_i, density_i), (e_j, nu_j, density_j) = STEEL, ALUMINIUM
    modulus = 1.0 / ((1.0 - nu_i**2) / e_i + (1.0 - nu_j**2) / e_j)
    stiff, mass = 4.0 / 3.0 * modulus * RADIUS**0.5, density_i * 4.0 / 3.0 * np.pi * RADIUS**3
    bending = e_j * THICK**3 / (12.0 * (1.0 - nu_j**2))
    yields = 1.0 / (8.0 * (bending * density_j * THICK) ** 0.5)  # m/s of the plate per N
    scale = (mass**2 / (stiff**2 * speed)) ** 0.2  # s
    inelasticity = yields * mass / scale

    def rate(_: float, state: np.ndarray) -> list[float]:
        force = max(state[0], 0.0) ** 1.5
        return [1.0 - state[1] - inelasticity * force, force]

    def rests(_: float, state: np.ndarray) -> float:
        return float(state[1]) - 1.0

    def parts(time: float, state: np.ndarray) -> float:
        return float(state[0]) if time > 0.1 else 1.0

    parts.terminal = True  # type: ignore[attr-defined]
    solved = solve_ivp(rate, (0.0, 20.0), [0.0, 0.0], events=(rests, parts), rtol=1e-10, atol=1e-12)
    impulse = float(solved.y[1, -1])
    rest = float(solved.t_events[0][0]) * scale
    return (impulse - 1.0) * speed, rest, -yields * mass * speed * impulse


def test_the_scene_expects_what_zener_has() -> None:
    expected = tomllib.loads(library()["sphere_on_plate"].read_text())["expect"]
    rebound, rest, deflection = zener(0.1)
    exact = rebound, GAP / 0.1 + rest, deflection
    for row, value in zip(expected, exact, strict=True):
        assert row["value"] == pytest.approx(value, rel=1e-4)
        assert row["within"] <= 0.0202 * abs(value)


def test_a_sphere_gives_a_plate_as_much_as_zener_has(run_scene: Run) -> None:
    results = run_scene("sphere_on_plate", "--transport", "memory")
    assert all(outcome["met"] for outcome in results["expect"]), results["expect"]
    (link,) = results["ledger"]["links"]
    assert link["momentum_residual"] <= 1e-12
    assert results["energy_gained"] < 0.01
    assert results["warnings"] == []


def test_a_faster_sphere_leaves_more_in_the_plate(run_scene: Run) -> None:
    speed, rebound = 0.5, zener(0.5)[0]
    results = run_scene(
        "sphere_on_plate", "--transport", "memory", "--set", "end=7e-5",
        "--set", f"components.sphere.bodies.0.velocity=[0.0, 0.0, {-speed}]",
        "--set", f"components.sphere.impact_speed={speed}", "--set", "expect.0.begin=7e-5",
        "--set", "expect.2.begin=6e-5", "--set", "expect.2.end=7e-5",
    )  # fmt: skip
    assert results["by_name"]["sphere.rebound"]["value"] == pytest.approx(rebound, rel=0.02)
