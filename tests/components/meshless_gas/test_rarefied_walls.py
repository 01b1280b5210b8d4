"""A gas between walls along which it slips, against the exact solution."""

import math
from typing import Any

import numpy as np
import pytest
from gases import given

from quintet.components.meshless_gas.boundaries import Boundary
from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.transport import Transport, sutherland
from quintet.components.meshless_gas.viscous.laws import jump_length, mean_free_path, slip_length
from quintet.components.meshless_gas.viscous.slip import write_slip_tractions
from quintet.interfaces.params import read

GAMMA, R, PRANDTL, SPEED = 1.4, 1.0 / 1.4, 0.72, 1.0
WALL = {"kind": "isothermal", "temperature": 1.0}
SHARES = {"momentum": 0.9, "energy": 0.8}
VISCOSITY = 0.08  # Knudsen number 0.12 by the gap


def between_walls(nodes: int, upper: dict[str, Any], end: float = 35.0) -> MeshlessGas:
    """A settled gas between walls at z = 0 and 1 m, the upper one moving at its speed of sound."""
    h = 1.0 / nodes
    table = {
        "viscous": True,
        "gas": {"gas_constant": R, "viscosity": VISCOSITY, "reference_temperature": 1.0,
                "sutherland": 0.4, "prandtl": PRANDTL},
        "initial": {"density": 1.0, "pressure": R, "velocity": [0.5, 0.0, 0.0]},
        "neighbours": 8,
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


def exact(gas: MeshlessGas, adiabatic: bool, pressure: float) -> dict[str, float]:
    """Slip, temperature at the lower wall and friction of the flow, at the pressure that it has.

    c μ dT/dy + τ u = E all through, c = c_p/Pr, τ = μ du/dy; E = τU if the upper wall takes no
    heat, τU/2 if both walls are alike. Thus T(u) is a parabola, and τ h = ∫ μ(T(u)) du.
    """
    law, c = gas.viscous.law, GAMMA / (GAMMA - 1.0) * R / PRANDTL
    slip = slip_length(SHARES["momentum"])
    jump = jump_length(SHARES["energy"], GAMMA, PRANDTL)
    u0, u1, t0, tau = 0.1, 0.9, 1.0, 0.05
    energy = SPEED if adiabatic else 0.5 * SPEED  # E/τ

    def temperature(u: Any) -> Any:
        return t0 + (energy * (u - u0) - 0.5 * (u * u - u0 * u0)) / c

    def viscosity(u: Any) -> Any:
        return np.vectorize(lambda one: sutherland.py_func(one, law))(temperature(u))

    def free_path(u: float) -> float:
        return mean_free_path.py_func(viscosity(u), pressure, temperature(u), R) / viscosity(u)

    for _ in range(200):
        u = np.linspace(u0, u1, 2001)
        tau = float(np.trapezoid(viscosity(u), u))
        new0 = slip * free_path(u0) * tau
        new1 = SPEED - slip * free_path(u1) * tau
        t0 = 1.0 + jump * free_path(u0) * tau * (energy - u0) / c
        u0, u1 = 0.5 * (u0 + new0), 0.5 * (u1 + new1)
    return {"slip": u0, "temperature": t0, "friction": tau}


def errors(kind: str, nodes: int) -> dict[str, float]:
    """Relative errors at the lower wall."""
    gas = between_walls(nodes, UPPER[kind])
    adiabatic = kind == "adiabatic"
    found = exact(gas, adiabatic, float(given(gas, "wall.pressure").mean()))
    lower = given(gas, "wall.position")[:, 2] < 0.5
    friction, heat = given(gas, "wall.friction")[lower, 0], given(gas, "wall.heat_flux")[lower]
    density, speed, *_, pressure = gas.state.primitive[np.flatnonzero(at_bottom(gas))].T
    share = SPEED if adiabatic else 0.5 * SPEED
    return {
        "slip": speed.mean() / found["slip"] - 1.0,
        "jump": ((pressure / (density * R)).mean() - 1.0) / (found["temperature"] - 1.0) - 1.0,
        "friction": friction.mean() / found["friction"] - 1.0,
        "heat": heat.mean() / (share * found["friction"]) - 1.0,  # of sliding included
    }


def at_bottom(gas: MeshlessGas) -> np.ndarray:
    """Nodes (n,) of the lower wall."""
    return np.asarray(gas.domain.cloud.positions[: gas.domain.cloud.nodes, 2] < 1e-9)


@pytest.mark.parametrize("kind", UPPER)
def test_gas_slips_and_its_temperature_jumps_as_maxwell_and_smoluchowski_say(kind: str) -> None:
    found = errors(kind, 8)
    assert all(abs(one) < 0.01 for one in found.values()), found


@pytest.mark.full
@pytest.mark.parametrize("kind", UPPER)
def test_slip_and_jump_converge_with_an_order_of_1_5_at_least(kind: str) -> None:
    coarse, fine = errors(kind, 8), errors(kind, 32)
    orders = {name: math.log(coarse[name] / fine[name], 4.0) for name in coarse}
    assert all(one > 1.5 for one in orders.values()), orders
    assert all(abs(one) < 1e-3 for one in fine.values()), fine


def test_gas_that_slips_goes_on_from_a_saved_state_with_the_same_bits() -> None:
    gas = between_walls(8, WALL, end=0.3)
    kept, step = gas.save(), gas.stable_dt()
    for _ in range(3):
        gas.step(step)
    first = gas.state.conservative.copy()
    gas.load(kept)
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


def test_only_a_wall_that_holds_a_gas_has_accommodation_coefficients() -> None:
    _, mistakes = read(Boundary, {"kind": "slip", "accommodation": SHARES}, "wall")
    assert "found accommodation" in mistakes[0]
    _, mistakes = read(Boundary, WALL | {"accommodation": {"momentum": 1.1}}, "wall")
    assert mistakes
