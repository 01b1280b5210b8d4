"""Limits of stability that scenes predict by a formula are what the formula gives."""

import math
import tomllib
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

from quintet.components.particle_dynamics.analysis.lattice_energy import LatticeEnergy
from quintet.components.particle_dynamics.build import build
from quintet.components.particle_dynamics.params import ParticleLatticeParams
from quintet.components.shared.scene_limits import keys_of, scene_at_limit
from quintet.interfaces.params import read
from quintet.scenarios.dust_in_stream.relaxation import GAS_CONSTANT, viscosity

SCENES = Path(__file__).resolve().parents[2] / "scenarios"


def limits_of(scene):
    """The scene's table, and its limits by name."""
    table = tomllib.loads((SCENES / scene / "scene.toml").read_text("utf-8"))
    return table, {limit["name"]: limit for limit in table["stability"]}


def lower_reaches(window):
    """Largest distance [m] of the lower of two masses from its place in 4 s of serial windows.

    Within a window each moves exactly: the lower one under the mean force of the last window, the
    upper one on a foot at the mean of the lower one's two positions.
    """
    ω = 10.0  # rad/s, of either mass on its spring
    c, s = math.cos(ω * window), math.sin(ω * window)
    lower, upper, pull = np.zeros(2), np.array([0.1, 0.0]), 0.0  # m, m/s; N
    largest = 0.0
    for _ in range(int(4.0 / window)):
        before, shift = lower, np.array([pull / 100.0, 0.0])  # m, where the springs balance
        lower = shift + np.array([[c, s / ω], [-ω * s, c]]) @ (lower - shift)
        foot = np.array([0.5 * (before[0] + lower[0]), 0.0])
        moved = foot + np.array([[c, s / ω], [-ω * s, c]]) @ (upper - foot)
        pull = -(moved[1] - upper[1]) / window  # N, the mean: all of what changes the upper mass
        upper = moved
        largest = max(largest, abs(lower[0]))
    return largest


def test_serial_windows_of_two_springs_are_stable_up_to_the_prediction():
    _, limits = limits_of("two_springs")
    limit = limits["window, serial"]
    (bounds,) = limit["bounds"]
    largest = 0.5 * (bounds["high"] - bounds["low"])  # m
    predicted = limit["predicted"]
    assert lower_reaches(0.98 * predicted) < largest < lower_reaches(1.02 * predicted)


def test_a_step_of_a_heated_slab_without_overshoot():
    table, limits = limits_of("heated_slab")
    (part,) = table["components"]["slab"]["parts"]
    count = part["elements"][0]
    edge = part["highest"][0] / count
    conductance = part["conductivity"] / edge  # W/(m2 K)
    capacity_of_layer = part["density"] * part["specific_heat"] * edge  # J/(m2 K)
    capacity = np.full(count, capacity_of_layer)
    capacity[0] *= 0.5  # of the heated face; the cold face is held
    conduction = conductance * (2.0 * np.eye(count) - np.eye(count, k=1) - np.eye(count, k=-1))
    conduction[0, 0] = conductance
    root = np.sqrt(capacity)
    rates, modes = np.linalg.eigh(conduction / np.outer(root, root))
    steady = np.linalg.solve(conduction, np.eye(count)[0])  # K per W/m2
    shares = modes[0] / root[0] * (modes.T @ (root * -steady))  # of the face's deviation
    γ = 1.0 - math.sqrt(0.5)

    def deviation(dt):
        z = -rates * dt
        return shares @ ((1.0 + (1.0 - 2.0 * γ) * z) / (1.0 - γ * z) ** 2)

    predicted = limits["window without overshoot"]["predicted"]
    assert brentq(deviation, 2.0, 20.0) == pytest.approx(predicted, rel=1e-3)


def test_energy_of_a_lattice_by_the_modified_energy_of_all_its_modes():
    table, limits = limits_of("lattice_in_motion")
    params, _ = read(ParticleLatticeParams, keys_of(table, "particle_lattice"), "cube")
    lattice = LatticeEnergy(params)
    squares = np.linalg.eigvalsh(lattice.stiffness(lattice.start) / lattice.mass).clip(0.0)
    assert squares[-1] == pytest.approx(build(params).frequency ** 2, rel=1e-6)

    def gain(courant):  # a step is 2 courant over the highest frequency
        q = courant**2 * squares / squares[-1]
        steps = table["end"] * math.sqrt(squares[-1]) / (2.0 * courant)
        phase = 2.0 * np.arcsin(np.sqrt(q)) * steps
        return (q / (1.0 - q) * np.sin(phase) ** 2).mean() / (np.cos(phase) ** 2).mean() - 0.01

    (limit,) = limits.values()
    assert brentq(gain, 0.05, 0.5) == pytest.approx(limit["predicted"], rel=0.01)


def longest_step_of_bars(scale):
    """2/ω_max [s] of two rows of elements with the spring of contact between them."""
    table, _ = limits_of("bars_in_contact")
    left, right = (table["components"][name]["parts"][0] for name in ("left", "right"))
    material = left["material"]
    E, ν, ρ = (material[key] for key in ("youngs_modulus", "poissons_ratio", "density"))
    modulus = E * (1.0 - ν) / (1.0 + ν) / (1.0 - 2.0 * ν)
    a, b = (
        (part["highest"][0] - part["lowest"][0]) / part["elements"][0] for part in (left, right)
    )
    m, n = left["elements"][0], right["elements"][0]
    springs = np.array([*[modulus / a] * m, scale * modulus / (a + b), *[modulus / b] * n])
    mass = ρ * np.array([0.5 * a, *[a] * (m - 1), 0.5 * a, 0.5 * b, *[b] * (n - 1), 0.5 * b])
    diagonal = np.concatenate([[0.0], springs]) + np.concatenate([springs, [0.0]])
    matrix = np.diag(diagonal) - np.diag(springs, 1) - np.diag(springs, -1)
    square = np.linalg.eigvalsh(matrix / np.sqrt(np.outer(mass, mass)))[-1]
    return 2.0 / math.sqrt(square)


def test_the_spring_of_contact_shortens_the_step_of_two_bars():
    _, limits = limits_of("bars_in_contact")
    step, scale = limits["step of both sides"], limits["penalty stiffness"]
    assert longest_step_of_bars(1.0) == pytest.approx(step["predicted"], rel=1e-3)
    window = scale["settings"]["window"]
    assert longest_step_of_bars(scale["predicted"]) == pytest.approx(window, rel=1e-3)


def test_windows_of_dust_that_answers_at_once():
    table, limits = limits_of("dust_in_stream")
    dust, _ = table["components"]["dust"]["spheres"]
    assert len(limits) == 3
    for limit in limits.values():
        settings = limit["settings"]
        cell = table["components"]["gas"]["box"]["spacing"]
        mass = 4.0 / 3.0 * math.pi * dust["radius"] ** 3 * dust["density"]
        initial = table["components"]["gas"]["initial"]
        density = initial["pressure"] / GAS_CONSTANT / initial["temperature"]
        η = settings["components.dust.spheres.0.parcel"] * mass / (density * cell**2)  # 1 m deep
        assert η == pytest.approx(float(limit["name"].rpartition(" ")[2]), rel=0.01)
        τ = 2.0 * dust["density"] * dust["radius"] ** 2 / 9.0 / viscosity(initial["temperature"])
        window = τ / η * math.log((1.0 + η) / (1.0 - η))
        assert window == pytest.approx(limit["predicted"], rel=1e-3)


def test_a_step_that_doubles_the_energy_of_a_swing():
    _, limits = limits_of("newtons_cradle")
    (limit,) = limits.values()
    (sphere,) = limit["settings"]["components.row.spheres"]
    mass = 4.0 / 3.0 * math.pi * sphere["radius"] ** 3 * sphere["density"]
    step = 2.0 * math.sqrt(0.5) / math.sqrt(sphere["tether"] / mass)
    assert step == pytest.approx(limit["predicted"], rel=2e-3)


@pytest.mark.parametrize("number", range(3))
def test_one_kick_of_a_whole_collision_doubles_the_energy(number):
    path = SCENES / "sphere_rebound" / "scene.toml"
    scene, limit = scene_at_limit(path, "step", number)
    spheres = scene["components"]["spheres"]
    glass, (sphere, _) = spheres["materials"]["glass"], spheres["bodies"]
    reduced_modulus = glass["youngs_modulus"] / 2.0 / (1.0 - glass["poissons_ratio"] ** 2)
    k = 4.0 / 3.0 * reduced_modulus * math.sqrt(0.5 * sphere["radius"])  # N/m^(3/2)
    mass = 2.0 / 3.0 * math.pi * sphere["radius"] ** 3 * sphere["density"]  # kg, reduced
    speed = 2.0 * sphere["velocity"][0]
    step = ((1.0 + math.sqrt(2.0)) * mass / (k * math.sqrt(speed))) ** 0.4
    assert step == pytest.approx(limit["predicted"][number], rel=2e-3)


def test_the_relaxation_of_windows_of_a_gate_with_the_water_that_it_moves():
    """Causin, Gerbeau & Nobile (2005); the mass of water is a measurement, quoted in the scene."""
    table, limits = limits_of("elastic_gate")
    limit = limits["relaxation of repeated windows"]
    water = float(limit["source"].partition("M = ")[2].partition(" ")[0])  # kg/m2
    (part,) = table["components"]["gate"]["parts"]
    thickness = part["highest"][0] - part["lowest"][0]
    gate = limit["settings"]["components.gate.parts.0.material.density"] * thickness
    assert 2.0 / (1.0 + water / gate) == pytest.approx(limit["predicted"], rel=5e-3)
