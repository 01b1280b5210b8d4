"""A gas between walls along which it slips, against the exact solution."""

import math
from typing import Any

import numpy as np
import pytest
from gases import output

from quintet.components.meshless_gas.boundaries import Boundary
from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.laws.transport import Transport
from quintet.components.meshless_gas.viscous.kernels.slip import write_slip_tractions, write_slips
from quintet.interfaces.params import read

GAMMA, R, PRANDTL, SPEED = 1.4, 1.0 / 1.4, 0.72, 1.0
WALL = {"kind": "isothermal", "temperature": 1.0}
SHARES = {"momentum": 0.9, "energy": 0.8}
VISCOSITY, SUTHERLAND = 0.08, 0.4  # Pa s, K; Knudsen number 0.12 by the gap
SLIP = 11.0 / 9.0  # mean free paths, Maxwell's (2 - σ)/σ
JUMP = 175.0 / 72.0  # mean free paths, Smoluchowski's (2 - α)/α 2γ/(γ + 1)/Pr


def between_walls(nodes: int, upper: dict[str, Any], end: float = 35.0) -> MeshlessGas:
    """A settled gas between walls at z = 0 and 1 m, the upper one moving at its speed of sound."""
    h = 1.0 / nodes
    table = {
        "viscous": True,
        "gas": {"gas_constant": R, "viscosity": VISCOSITY, "reference_temperature": 1.0,
                "sutherland": SUTHERLAND, "prandtl": PRANDTL},
        "initial": {"density": 1.0, "pressure": R, "velocity": [0.5, 0.0, 0.0]},
        "neighbours": 8,
        "limiter": "van_albada",
        "limiter_threshold": 1e-2,
        "local_steps": True,
        "box": {"lowest": [0.0, 0.0, 0.0], "highest": [4.0 * h, 0.0, 1.0], "spacing": h},
        "boundaries": {"z-": WALL | {"accommodation": SHARES},
                       "z+": {"velocity": [SPEED, 0.0, 0.0], "accommodation": SHARES} | upper},
    }  # fmt: skip
    params, mistakes = read(MeshlessGas.Params, table, "gas")
    assert not mistakes, mistakes
    gas = MeshlessGas(params)
    while gas.state.time < end:
        gas.step(gas.stable_dt())
    return gas


UPPER = {"isothermal": WALL, "adiabatic": {"kind": "adiabatic"}}


def exact(adiabatic: bool, pressure: float) -> dict[str, float]:
    """Slip, temperature at the lower wall and friction of the flow, at the pressure that it has.

    c μ dT/dy + τ u = E all through, c = c_p/Pr, τ = μ du/dy; E = τU if the upper wall takes no
    heat, τU/2 if both walls are alike. Thus T(u) is a parabola, and τ h = ∫ μ(T(u)) du.
    """
    c = GAMMA / (GAMMA - 1.0) * R / PRANDTL
    u0, u1, t0, tau = 0.1, 0.9, 1.0, 0.05
    energy = SPEED if adiabatic else 0.5 * SPEED  # E/τ

    def temperature(u: Any) -> Any:
        return t0 + (energy * (u - u0) - 0.5 * (u * u - u0 * u0)) / c

    def viscosity(u: Any) -> Any:
        t = temperature(u)
        return VISCOSITY * t**1.5 * (1.0 + SUTHERLAND) / (t + SUTHERLAND)

    def free_path(u: float) -> float:  # over the viscosity
        return math.sqrt(0.5 * math.pi * R * temperature(u)) / pressure

    for _ in range(200):
        u = np.linspace(u0, u1, 2001)
        tau = float(np.trapezoid(viscosity(u), u))
        new0 = SLIP * free_path(u0) * tau
        new1 = SPEED - SLIP * free_path(u1) * tau
        t0 = 1.0 + JUMP * free_path(u0) * tau * (energy - u0) / c
        u0, u1 = 0.5 * (u0 + new0), 0.5 * (u1 + new1)
    return {"slip": u0, "temperature": t0, "friction": tau}


def errors(kind: str, nodes: int) -> dict[str, float]:
    """Relative errors at the lower wall."""
    gas = between_walls(nodes, UPPER[kind])
    adiabatic = kind == "adiabatic"
    expected = exact(adiabatic, float(output(gas, "wall.pressure").mean()))
    lower = output(gas, "wall.position")[:, 2] < 0.5
    friction, heat = output(gas, "wall.friction")[lower, 0], output(gas, "wall.heat_flux")[lower]
    density, speed, *_, pressure = gas.state.primitive[np.flatnonzero(at_bottom(gas))].T
    share = SPEED if adiabatic else 0.5 * SPEED
    return {
        "slip": speed.mean() / expected["slip"] - 1.0,
        "jump": ((pressure / (density * R)).mean() - 1.0) / (expected["temperature"] - 1.0) - 1.0,
        "friction": friction.mean() / expected["friction"] - 1.0,
        "heat": heat.mean() / (share * expected["friction"]) - 1.0,  # of sliding included
    }


def at_bottom(gas: MeshlessGas) -> np.ndarray:
    """Nodes (n,) of the lower wall."""
    return np.asarray(gas.motion.domain.cloud.positions[: gas.motion.domain.cloud.nodes, 2] < 1e-9)


@pytest.mark.parametrize("kind", UPPER)
def test_gas_slips_and_its_temperature_jumps_as_maxwell_and_smoluchowski_say(kind: str) -> None:
    deviations = errors(kind, 8)
    assert all(abs(deviation) < 0.01 for deviation in deviations.values()), deviations


@pytest.mark.full
@pytest.mark.parametrize("kind", UPPER)
def test_slip_and_jump_converge_with_an_order_of_1_5_at_least(kind: str) -> None:
    coarse, fine = errors(kind, 8), errors(kind, 32)
    orders = {name: math.log(coarse[name] / fine[name], 4.0) for name in coarse}
    assert all(order > 1.5 for order in orders.values()), orders
    assert all(abs(deviation) < 1e-3 for deviation in fine.values()), fine


def test_gas_that_slips_goes_on_from_a_saved_state_with_the_same_bits() -> None:
    gas = between_walls(8, WALL, end=0.3)
    saved_state, step = gas.save(), gas.stable_dt()
    for _ in range(3):
        gas.step(step)
    first = gas.state.conservative.copy()
    gas.load(saved_state)
    for _ in range(3):
        gas.step(step)
    np.testing.assert_array_equal(gas.state.conservative, first)


def test_gas_that_turns_with_a_sphere_as_a_whole_has_no_shear() -> None:
    distance = np.array([1.0, 1.1, 1.3])
    outward = np.array([0.6, 0.0, 0.8])
    places = distance[:, None] * outward
    law = Transport(VISCOSITY, 1.0, 0.0, 3.5, 1.0)
    primitive = np.ones((3, 5))
    primitive[:, 1:4] = np.cross([0.0, 2.0, 0.0], places)
    friction, heat = np.empty((1, 3)), np.empty(1)
    write_slip_tractions(
        np.array([0], np.int32), np.array([[1, 2]], np.int32), places, outward[None],
        np.empty((3, 0), np.int32), np.empty((3, 0, 3)), np.zeros((1, 3)), 1.0, law,
        primitive, friction, heat,
    )  # fmt: skip
    assert friction == pytest.approx(0.0, abs=1e-12)
    assert heat == pytest.approx(0.0, abs=1e-12)


def slipped(
    along: list[float], heights: list[float], warmer: float, curvature: float
) -> tuple[np.ndarray, np.ndarray]:
    """Velocity and friction along x at a wall z = 0, under nodes that flow along it [m/s].

    Two more nodes lie on the wall, warmer and colder by `warmer` at 0.1 m along x.
    """
    places = np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [-0.1, 0.0, 0.0]] + [
        [0.0, 0.0, z] for z in heights
    ])  # fmt: skip
    normals = np.tile([0.0, 0.0, 1.0], (5, 1))
    temperature = np.array([1.0, 1.0 + warmer, 1.0 - warmer, 1.0, 1.0])
    primitive = np.zeros((5, 5))
    primitive[:, 0], primitive[:, 4] = 1.0 / temperature, R
    primitive[3:, 1] = along
    rows, above = np.array([0], np.int32), np.array([[3, 4]], np.int32)
    near = np.array([[1, 2]] + 4 * [[0, 0]], np.int32)
    coefficients = np.zeros((5, 2, 3))
    coefficients[0, :, 0] = 5.0, -5.0  # 1/m
    law = Transport(VISCOSITY, 1.0, SUTHERLAND, 3.5 * R / PRANDTL, R)
    write_slips(
        rows, above, places, normals, near, coefficients, np.empty(0, np.int32), np.zeros((1, 3)),
        np.array([[SLIP, JUMP]]), curvature, law, primitive,
    )  # fmt: skip
    wall, friction, heat = primitive[0, 1:4].copy(), np.empty((1, 3)), np.empty(1)
    write_slip_tractions(
        rows, above, places, normals, near, np.zeros((5, 2, 3)), np.zeros((1, 3)), curvature, law,
        primitive, friction, heat,
    )  # fmt: skip
    return wall, friction[0]


def test_gas_creeps_along_a_wall_to_where_it_is_warmer() -> None:
    creep = 0.75 * VISCOSITY * 0.3  # m/s, 3/4 μ/(ρT) ∂T/∂x with ρT = 1, 0.3 K/m
    free, friction = slipped([creep, creep], [0.05, 0.1], 0.03, 0.0)
    np.testing.assert_allclose(free, [creep, 0.0, 0.0], atol=1e-15)
    np.testing.assert_allclose(friction, 0.0, atol=1e-13)
    # Gas at rest above holds it back: the parabola's slope at the wall is -3/2 u/h.
    length = SLIP * VISCOSITY / R * math.sqrt(0.5 * math.pi * R)
    slower, _ = slipped([0.0, 0.0], [0.05, 0.1], 0.03, 0.0)
    assert slower[0] == pytest.approx(creep / (1.0 + length * 1.5 / 0.05))


def test_gas_slips_round_a_sphere_as_basset_says() -> None:
    # Basset, Hydrodynamics II (1888), art. 497: creeping flow U round a sphere of radius a along
    # which it slips by L. At its equator u/U = 1 + C a/r - D a³/r³, D = -(1 + 2 C)/2 and
    # C = -3/4 (1 + 2 L/a)/(1 + 3 L/a): at the wall 3/2 (L/a)/(1 + 3 L/a).
    length = SLIP * VISCOSITY / R * math.sqrt(0.5 * math.pi * R)  # m, a = 1 m
    c = -0.75 * (1.0 + 2.0 * length) / (1.0 + 3.0 * length)
    d = -0.5 * (1.0 + 2.0 * c)
    heights = [0.001, 0.002]
    r = 1.0 + np.array(heights)
    wall, friction = slipped(list(1.0 + c / r - d / r**3), heights, 0.0, 1.0)
    slip = 1.5 * length / (1.0 + 3.0 * length)
    assert wall[0] == pytest.approx(slip, rel=1e-4)
    assert friction[0] == pytest.approx(VISCOSITY * slip / length, rel=1e-4)


def test_only_a_wall_that_holds_a_gas_has_accommodation_coefficients() -> None:
    _, mistakes = read(Boundary, {"kind": "slip", "accommodation": SHARES}, "wall")
    assert "found accommodation" in mistakes[0]
    _, mistakes = read(Boundary, WALL | {"accommodation": {"momentum": 1.1}}, "wall")
    assert mistakes
