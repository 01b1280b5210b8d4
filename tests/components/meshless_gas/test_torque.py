"""Cylinders that turn in a viscous gas: torque by the exact solution, spin by a partner."""

import math

import numpy as np
import pytest
from scipy import integrate, special

from quintet.components.meshless_gas.component import MeshlessGas
from quintet.components.meshless_gas.params import MeshlessGasParams
from quintet.interfaces.params import read

PRESSURE = 1.0 / 1.4  # Pa: the speed of sound is 1 m/s
VISCOSITY, SPIN, RADIUS = 0.1, 0.1, 1.0  # Pa s, rad/s, m
END = 3.0  # s


def turning(rays=24, **body):
    """A cylinder that begins to turn in gas at rest, in a box that it does not feel."""
    spacing = math.tau * RADIUS / rays
    layers = {"points_around": rays, "thickness": 6.0 * spacing, "spacing": spacing}
    table = {
        "gas": {"gas_constant": PRESSURE, "viscosity": VISCOSITY, "reference_temperature": 1.0},
        "viscous": True,
        "neighbours": 8,
        "limiter": "van_albada",
        "box": {"lowest": [-4.0, 0.0, -4.0], "highest": [4.0, 0.0, 4.0], "spacing": spacing},
        "boundaries": {f"{axis}{side}": {"kind": "symmetry"} for axis in "xz" for side in "-+"},
        "initial": {"density": 1.0, "pressure": PRESSURE},
        "moving": {
            "bodies": [
                {"centre": [0.0, 0.0, 0.0], "radius": RADIUS, "first_spacing": 0.5 * spacing}
                | {"temperature": 1.0, "angular_velocity": SPIN} | layers | body,
            ]
        },
    }  # fmt: skip
    params, mistakes = read(MeshlessGasParams, table, "gas")
    return (None, mistakes) if mistakes else (MeshlessGas(params), [])


def exact_torque(time):
    """Torque [N m] per length on a cylinder that began to turn: its transform is 2 + q K0/K1(q).

    q² = s R²/ν; after Carslaw & Jaeger, Conduction of Heat in Solids (1959), section 13.5.
    """
    scaled_time = VISCOSITY * time / RADIUS**2

    def part(log):
        u = math.exp(log)
        return math.exp(-u * u * scaled_time) / (special.j1(u) ** 2 + special.y1(u) ** 2)

    transient = 4.0 / math.pi**2 * integrate.quad(part, -30.0, 8.0, limit=400)[0]
    return -math.tau * VISCOSITY * SPIN * RADIUS**2 * (2.0 + transient)


@pytest.mark.full  # kernels of friction with moving nodes
def test_torque_on_a_cylinder_that_turns_is_that_of_the_exact_solution():
    gas, _ = turning()
    angular_impulse = 0.0  # N m s, by which the cylinder was stopped
    while gas.state.time < END - 1e-12:
        dt = min(gas.stable_dt(), END - gas.state.time)
        gas.step(dt)
        torque = gas.give(frozenset({"bodies.torque"}))["bodies.torque"][0]
        angular_impulse -= dt * torque[1]
        if gas.state.time > 0.5 * END:
            assert torque[1] == pytest.approx(exact_torque(gas.state.time), rel=0.02)
    assert torque[[0, 2]] == pytest.approx(0.0, abs=1e-12)
    exact, _ = integrate.quad(lambda root: -2.0 * root * exact_torque(root * root), 0.0, END**0.5)
    assert angular_impulse == pytest.approx(exact, rel=0.02)


@pytest.mark.full
def test_a_partner_turns_a_cylinder_and_is_told_its_torque():
    alone, driven = turning()[0], turning(is_driven=True)[0]
    motion = {
        "motion.position": np.zeros((1, 3)),
        "motion.velocity": np.zeros((1, 3)),
        "motion.angular_velocity": np.array([[0.0, SPIN, 0.0]]),
    }
    for _ in range(10):
        dt = alone.stable_dt()
        driven.take(motion)
        for gas in (alone, driven):
            gas.step(dt)
    torque = driven.give(frozenset({"load.torque"}))["load.torque"]
    assert np.array_equal(torque, alone.give(frozenset({"bodies.torque"}))["bodies.torque"])
    motion["motion.angular_velocity"] = -motion["motion.angular_velocity"]
    driven.take(motion)
    driven.step(dt)
    assert driven.give(frozenset({"load.torque"}))["load.torque"][0, 1] > -torque[0, 1]


@pytest.mark.full
@pytest.mark.parametrize(
    "wall", [{"temperature": 0.9}, {"temperature": None, "is_adiabatic": True}]
)
def test_friction_and_heat_on_a_flying_body_are_the_same_bits_after_a_restart(wall):
    gas = turning(rays=20, velocity=[0.3, 0.0, 0.1], **wall)[0]
    keys = frozenset({"surface.friction", "surface.heat_flux", "surface.pressure"})
    for _ in range(3):
        gas.step(gas.stable_dt())
    saved, before = gas.save(), gas.give(keys)
    gas.step(gas.stable_dt())
    gas.load(saved)
    after = gas.give(keys)
    assert all(np.array_equal(before[key], after[key]) for key in keys)
    assert np.abs(after["surface.friction"]).max() > 0.0


@pytest.mark.full
def test_an_adiabatic_wall_takes_no_heat_and_is_warmed_by_friction():
    cooled = turning(angular_velocity=0.0, temperature=0.9)[0]
    still, fast = (
        turning(temperature=None, is_adiabatic=True, angular_velocity=spin)[0]
        for spin in (0.0, 0.5)
    )
    heat, warmth = [], []
    for gas in (cooled, still, fast):
        for _ in range(40):
            gas.step(gas.stable_dt())
        heat.append(gas.give(frozenset({"bodies.heat"}))["bodies.heat"][0])
        density, *_, pressure = gas.state.primitive[gas.motion.layout.walls].T
        warmth.append(pressure / (density * PRESSURE))
    assert heat[0] > 0.01 and heat[1] == heat[2] == 0.0
    assert warmth[0] == pytest.approx(0.9) and warmth[1] == pytest.approx(1.0, abs=1e-12)
    # Of gas that is brought to the wall's velocity, about as much as with a Prandtl number of 1.
    assert 1.01 < warmth[2].mean() < 1.0 + 0.2 * 0.5**2 * 1.2


@pytest.mark.full
def test_heat_that_a_partner_takes_is_not_in_the_gas_account_of_work():
    alone, joined = (turning(is_driven=True, temperature=0.9)[0] for _ in range(2))
    joined.bind({}, frozenset({"motion", "load", "heat"}))
    heat = 0.0  # J, to the body
    for _ in range(5):
        dt = alone.stable_dt()
        for gas in (alone, joined):
            gas.step(dt)
        heat += dt * joined.give(frozenset({"heat.heat_flow"}))["heat.heat_flow"][0]
    assert heat > 1e-3
    assert alone.totals().work == pytest.approx(-heat, rel=1e-9)  # nothing else comes in
    assert joined.totals().work == pytest.approx(0.0, abs=1e-9 * heat)


@pytest.mark.parametrize(
    ("body", "sentence"),
    [
        ({"temperature": None}, "found one that slips"),
        ({"is_adiabatic": True}, "found both"),
        ({"sector": 0.5 * math.pi}, "sector"),
    ],
)
def test_what_cannot_turn_the_gas_is_refused(body, sentence):
    _, mistakes = turning(**body)
    assert any(sentence in mistake for mistake in mistakes), mistakes
