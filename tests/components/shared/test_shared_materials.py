"""Laws of solid materials against exact solutions."""

import math

import numpy as np
import pytest
from numba import njit
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from quintet.components.shared.materials import equation_of_state as eos
from quintet.components.shared.materials import fracture, strength
from quintet.components.shared.materials.params import (
    JohnsonCook,
    JohnsonCookDamage,
    Material,
    MaterialName,
    material,
)
from quintet.components.shared.materials.solid import densest, solid
from quintet.interfaces.materials.library import library
from quintet.interfaces.params import parameters, read

PLASTIC = ["42CrMo4", "Ti-6Al-4V", "aluminium", "copper", "steel"]


# The laws are inlined into solvers' kernels; here each is called from Python.
@njit
def _pressure(mu, energy, law):
    return eos.pressure_and_energy(mu, energy, 0.0, law)[0]


@njit
def _sound(mu, energy, pressure, law):
    return eos.sound_speed_squared(mu, energy, pressure, law)


@njit
def _temperature(mu, energy, law):
    return eos.temperature(mu, energy, law)


@njit
def _strained(s, gradient, shear, dt):
    return strength.turned_and_strained(s, gradient, shear, dt)


@njit
def _returned(s, strain, temperature, dt, law):
    return strength.returned(s, strain, temperature, dt, law)


@njit
def _flow(strain, rate, soft, law):
    return strength.flow_stress(strain, rate, soft, law)


@njit
def _softening(temperature, law):
    return strength.softening(temperature, law)


@njit
def _principal(s, pressure):
    return fracture.greatest_principal(s, pressure)


@njit
def _damage(s, pressure, delta, temperature, dt, law):
    return fracture.damage_growth(s, pressure, delta, temperature, dt, law)


def _matrix(s):
    xx, yy, zz, xy, yz, zx = s
    return np.array([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]])


def _six(m):
    return (m[0, 0], m[1, 1], m[2, 2], m[0, 1], m[1, 2], m[2, 0])


@pytest.mark.parametrize(
    ("name", "speed", "shock", "pressure"),
    [
        ("aluminium", 7400.0, 10279.0, 105.7e9),
        ("aluminium", 1000.0, 5997.0, 8.336e9),
        ("steel", 923.0, 5283.6, 19.14e9),
    ],
)
def test_the_equation_of_state_has_its_hugoniot(name, speed, shock, pressure):
    """U_s = c + S u_p, p = ρ₀U_s u_p, ρ/ρ₀ = U_s/(U_s - u_p), e = u_p²/2: Rankine & Hugoniot."""
    law = solid(material(name))
    u = 0.5 * speed  # m/s, both bodies of the same material
    us = math.sqrt(law.c2) + law.s1 * u
    assert us == pytest.approx(shock, rel=1e-4)
    p = _pressure(us / (us - u) - 1.0, 0.5 * u * u, law)
    assert p == pytest.approx(law.density * us * u, rel=1e-12)
    assert p == pytest.approx(pressure, rel=1e-3)


@pytest.mark.parametrize("name", [name for name in library() if "mie_gruneisen" in library()[name]])
def test_every_shocked_material_of_the_library_has_the_hugoniot_of_its_source(name):
    law, eos_table = solid(material(name)), library()[name]["mie_gruneisen"]
    u = 300.0  # m/s, behind the shock
    linear = eos_table["sound_speed"] + eos_table["s1"] * u
    us = 0.5 * linear + math.sqrt(0.25 * linear**2 + eos_table.get("s2", 0.0) * u * u)
    # Grüneisen's coefficient as of LS-DYNA makes the locus of the reference that of Rankine and
    # Hugoniot, whatever its change with compression.
    p = _pressure(us / (us - u) - 1.0, 0.5 * u * u, law)
    assert p == pytest.approx(library()[name]["density"] * us * u, rel=1e-12)


def test_a_hugoniot_with_three_coefficients(name="steel"):
    """U_s = c + S₁u + S₂(u/U_s)u + S₃(u/U_s)²u."""
    base = material(name)
    law = solid(base)._replace(s2=-0.4, s3=0.2)
    u = 800.0
    c = math.sqrt(law.c2)
    us = brentq(lambda s: s - c - u * (law.s1 + law.s2 * u / s + law.s3 * (u / s) ** 2), c, 3 * c)
    p = _pressure(us / (us - u) - 1.0, 0.5 * u * u, law)
    assert p == pytest.approx(law.density * us * u, rel=1e-10)


def test_energy_at_a_steps_end_is_implicit_in_the_pressure():
    law = solid(material("aluminium"))
    energy, mu_end, mu_start, p = 1e4, 0.02, 0.01, 1e9
    volume = (1.0 / (1.0 + mu_end) - 1.0 / (1.0 + mu_start)) / law.density
    result = njit(lambda: eos.pressure_and_energy(mu_end, energy - 0.5 * p * volume, volume, law))()
    assert result[0] == pytest.approx(_pressure(mu_end, result[1], law), rel=1e-12)
    assert result[1] == pytest.approx(energy - 0.5 * (p + result[0]) * volume, rel=1e-12)


@pytest.mark.parametrize("mu", [-0.02, 1e-6, 0.1, 0.5])
def test_speed_of_sound_is_the_slope_of_the_isentrope(mu):
    law = solid(material("aluminium"))._replace(a=0.3)
    e, h = 3e5, 1e-6
    p = _pressure(mu, e, law)
    rho = law.density * (1.0 + mu)
    step = h * law.density
    ends = [_pressure(mu + s * h, e + s * step * p / rho**2, law) for s in (-1.0, 1.0)]
    bulk = (ends[1] - ends[0]) / (2.0 * step)
    longitudinal = bulk + 4.0 / 3.0 * law.shear / rho
    assert _sound(mu, e, p, law) == pytest.approx(longitudinal, rel=1e-5)


@pytest.mark.parametrize("name", ["aluminium", "steel"])
@pytest.mark.parametrize("mu", [-0.1, -0.01, 0.02, 0.2, 0.5])
def test_temperature_on_the_isentrope_is_exponential_in_eta(name, mu):
    law = solid(material(name))
    eta = mu / (1.0 + mu)

    def slope(eta, e):
        return _pressure(eta / (1.0 - eta), e[0], law) / law.density

    e = solve_ivp(slope, (0.0, eta), [0.0], rtol=1e-11, atol=1e-8).y[0, -1]
    exact = law.temperature * math.exp(law.gamma * eta)
    assert _temperature(mu, e, law) == pytest.approx(exact, rel=1e-6)
    heated = e + 50.0 * law.specific_heat
    assert _temperature(mu, heated, law) == pytest.approx(exact + 50.0, rel=1e-6)


def test_at_rest_all_is_as_at_the_start():
    law = solid(material("aluminium"))
    assert _pressure(0.0, 0.0, law) == 0.0
    assert _temperature(0.0, 0.0, law) == law.temperature
    wave = material("aluminium").bulk + 4.0 / 3.0 * law.shear
    assert _sound(0.0, 0.0, 0.0, law) == pytest.approx(wave / law.density)


def test_the_pole_of_the_hugoniot_is_known():
    assert densest(solid(material("aluminium"))) == pytest.approx(1.0 / 1.338, abs=1e-3)
    assert densest(solid(material("steel"))) == pytest.approx(1.0 / 1.49, abs=1e-3)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_jaumanns_rate_turns_a_stress_with_the_material(axis):
    spin = np.zeros((3, 3))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    spin[i, j], spin[j, i] = -1.0, 1.0  # rad/s about the axis
    start = np.array([[3.0, 1.0, -2.0], [1.0, -1.0, 0.5], [-2.0, 0.5, -2.0]])
    angle, errors = 0.5, []
    c, s = math.cos(angle), math.sin(angle)
    turn = np.eye(3)
    turn[i, i], turn[i, j], turn[j, i], turn[j, j] = c, -s, s, c
    for steps in (500, 1000):
        stress = _six(start)
        for _ in range(steps):
            stress = _strained(stress, tuple(spin.ravel()), 1e9, angle / steps)
        errors.append(np.abs(_matrix(stress) - turn @ start @ turn.T).max())
        assert np.trace(_matrix(stress)) == pytest.approx(0.0, abs=1e-12)
    assert errors[0] < 4e-3 and errors[0] / errors[1] == pytest.approx(2.0, rel=0.02)


def test_a_small_strain_gives_hookes_law():
    gradient = np.array([[1.0, 0.4, -0.2], [0.6, -0.5, 0.1], [0.0, 0.3, 0.2]]) * 1e-9
    stress = _matrix(_strained((0.0,) * 6, tuple(gradient.ravel()), 8e10, 1.0))
    strain = 0.5 * (gradient + gradient.T)
    exact = 2.0 * 8e10 * (strain - np.trace(strain) / 3.0 * np.eye(3))
    np.testing.assert_allclose(stress, exact, rtol=1e-12, atol=1e-9)


@pytest.mark.parametrize("name", PLASTIC)
@pytest.mark.parametrize("strain", [0.0, 1e-6, 0.3])
@pytest.mark.parametrize("excess", [1.0001, 1.01, 3.0])
@pytest.mark.parametrize("dt", [1e-9, 1e-6, 10.0])
def test_the_returned_stress_is_the_flow_stress(name, strain, excess, dt):
    law = solid(material(name))
    temperature = law.temperature + 50.0
    soft = _softening(temperature, law)
    static_flow = _flow(strain, 0.0, soft, law)[0]
    shape = np.array([[2.0, 0.3, 0.1], [0.3, -1.5, 0.7], [0.1, 0.7, -0.5]])
    shape *= excess * static_flow / math.sqrt(1.5 * (shape * shape).sum())
    s, delta, work = _returned(_six(shape), strain, temperature, dt, law)
    equivalent = math.sqrt(1.5 * (_matrix(s) ** 2).sum())
    assert delta > 0.0
    assert equivalent == pytest.approx(_flow(strain + delta, delta / dt, soft, law)[0], rel=1e-7)
    assert equivalent + 3.0 * law.shear * delta == pytest.approx(excess * static_flow, rel=1e-10)
    assert work == pytest.approx(equivalent * delta)
    np.testing.assert_allclose(_matrix(s) / equivalent, shape / (excess * static_flow), atol=1e-12)


def test_below_the_flow_stress_nothing_yields_and_melt_bears_no_shear():
    law = solid(material("steel"))
    elastic = (1e8, -1e8, 0.0, 2e7, 0.0, 0.0)
    assert _returned(elastic, 0.1, 300.0, 1e-8, law) == (elastic, 0.0, 0.0)
    s, delta, _ = _returned(elastic, 0.1, 2000.0, 1e-8, law)
    assert math.sqrt(1.5 * (_matrix(s) ** 2).sum()) < 1.0
    assert delta > 0.0
    springy = Material(density=1e3, youngs_modulus=1e9, poissons_ratio=0.3)
    assert _returned(elastic, 0.0, 300.0, 1e-8, solid(springy)) == (elastic, 0.0, 0.0)


def test_the_greatest_principal_stress_is_an_eigenvalue():
    random = np.random.default_rng(1)
    for _ in range(50):
        m = random.normal(size=(3, 3)) * 1e9
        m = m + m.T
        pressure = -np.trace(m) / 3.0
        s = m + pressure * np.eye(3)
        assert _principal(_six(s), pressure) == pytest.approx(np.linalg.eigvalsh(m)[-1], rel=1e-9)
    assert _principal((0.0,) * 6, 5.0) == -5.0
    assert _principal((2.0, -1.0, -1.0, 0.0, 0.0, 0.0), 0.0) == pytest.approx(2.0)
    assert _principal((1.0, 1.0, -2.0, 0.0, 0.0, 0.0), 0.0) == pytest.approx(1.0)


def test_damage_is_the_share_of_the_strain_at_fracture():
    alloy = Material(
        density=7850.0,
        youngs_modulus=2e11,
        poissons_ratio=0.3,
        johnson_cook=JohnsonCook(a=4e8, reference_rate=1.0, melting_temperature=1800.0),
        damage=JohnsonCookDamage(d1=0.05, d2=3.44, d3=-2.12, d4=0.002, d5=0.61),
        specific_heat=450.0,
    )
    law = solid(alloy)
    s = (2.0, -1.0, -1.0, 0.0, 0.0, 0.0)  # uniaxial: equivalent stress 3, mean stress 1
    fracture_strain = (0.05 + 3.44 * math.exp(-2.12 / 3.0)) * (1.0 + 0.002 * math.log(1e3))
    fracture_strain *= 1.0 + 0.61 * 100.0 / 1502.0
    damage = _damage(s, -1.0, 1e-3, 398.0, 1e-6, law)
    assert damage == pytest.approx(1e-3 / fracture_strain, rel=1e-12)
    assert _damage(s, -1.0, 1e-3, 398.0, 1e-6, solid(material("steel"))) == 0.0


def test_a_strain_at_fracture_below_zero_breaks_the_material_at_once():
    """6061-T6 of Lesuer, Kay & LeBlanc (2001) has D₁ = -0.77: at high tension it fails at once."""
    alloy = Material(
        density=2703.0,
        youngs_modulus=7e10,
        poissons_ratio=0.3,
        johnson_cook=JohnsonCook(a=3.24e8, b=1.14e8, n=0.42, melting_temperature=925.0),
        damage=JohnsonCookDamage(d1=-0.77, d2=1.45, d3=-0.47, d4=0.0, d5=1.6),
        specific_heat=896.0,
    )
    law, s = solid(alloy), (2.0, -1.0, -1.0, 0.0, 0.0, 0.0)
    fracture_strain = -0.77 + 1.45 * math.exp(-0.47 / 3.0)
    assert fracture_strain == pytest.approx(0.47, abs=0.01)
    assert _damage(s, -1.0, 1e-3, 298.0, 1e-6, law) == pytest.approx(1e-3 / fracture_strain)
    assert _damage(s, -6.0, 1e-3, 298.0, 1e-6, law) >= 1.0
    with pytest.raises(ValueError, match=r"in uniaxial tension.*found -0.28"):
        JohnsonCookDamage(d1=-0.77, d2=0.57, d3=-0.47)


@pytest.mark.parametrize(
    ("keys", "rule"),
    [
        ({}, "one of youngs_modulus and shear_modulus must be given"),
        ({"youngs_modulus": 1e9}, "with youngs_modulus poissons_ratio is needed"),
        ({"shear_modulus": 1e9}, "nothing tells its bulk modulus"),
        (
            {"youngs_modulus": 1e9, "poissons_ratio": 0.3, "failure_strain": 0.2},
            "failure_strain is of plastic strain; give johnson_cook too",
        ),
    ],
)
def test_a_material_that_lacks_something_is_refused(keys, rule):
    with pytest.raises(ValueError, match=rule):
        Material(density=1e3, **keys)


def test_moduli_follow_from_each_other():
    elastic = Material(density=1e3, youngs_modulus=9e9, poissons_ratio=0.25)
    assert elastic.shear == pytest.approx(3.6e9) and elastic.bulk == pytest.approx(6e9)
    aluminium = material("aluminium")
    assert aluminium.bulk == pytest.approx(78.92e9, rel=1e-4)


@parameters
class Part:
    material: MaterialName | Material


@pytest.mark.parametrize(
    ("value", "message"),
    [
        ("stele", "part.material should be a material of the library (steel, aluminium,"),
        ({"densty": 7800.0}, "part.material.densty is not known. Did you mean density?"),
    ],
)
def test_a_wrong_material_is_refused_once_and_in_words(value, message):
    parsed, (mistake,) = read(Part, {"material": value}, "part")
    assert parsed is None and mistake.startswith(message)
