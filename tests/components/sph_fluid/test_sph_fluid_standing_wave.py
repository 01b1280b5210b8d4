"""The standing wave that a fluid may start from, and the viscosity that fades it."""

import math
from dataclasses import asdict

import numpy as np
import pytest
from fluid_params import fluid_params, nested
from test_sph_fluid_laws import lattice, law, rates

from quintet.components.sph_fluid import SphFluidParams
from quintet.components.sph_fluid.build import state
from quintet.components.sph_fluid.setup.standing_wave import StandingWave
from quintet.interfaces.params import read

BOX = ((0.2, 0.0, -0.1), (1.2, 0.1, 0.4))  # m
G = (0.0, 0.0, -9.81)
WAVE = StandingWave(amplitude=0.02, length=1.0)
K = 2.0 * math.pi  # 1/m


def velocity(x, z):
    return WAVE.velocity(np.array([[x, 0.05, z]]), BOX, G)[0]


def test_frequency_is_that_of_deep_and_of_shallow_water():
    assert WAVE.frequency(5.0, 9.81) == pytest.approx(math.sqrt(9.81 * K))
    assert WAVE.frequency(0.001, 9.81) == pytest.approx(math.sqrt(9.81 * 0.001) * K, rel=1e-4)


@pytest.mark.parametrize("place", [(0.31, 0.3), (0.7, 0.0), (1.05, -0.05)])
def test_flow_has_neither_sources_nor_spin(place):
    (x, z), step = place, 1e-5
    along = (velocity(x + step, z) - velocity(x - step, z)) / (2 * step)
    up = (velocity(x, z + step) - velocity(x, z - step)) / (2 * step)
    assert along[0] + up[2] == pytest.approx(0.0, abs=1e-7)
    assert along[2] - up[0] == pytest.approx(0.0, abs=1e-7)


def test_flow_passes_no_wall_and_rises_at_the_low_end():
    assert velocity(0.2, 0.1)[0] == pytest.approx(0.0, abs=1e-15)
    assert velocity(1.2, 0.1)[0] == pytest.approx(0.0, abs=1e-15)
    assert velocity(0.5, -0.1)[2] == 0.0
    # The surface rises as A sin ωt does.
    assert velocity(0.2, 0.4)[2] == pytest.approx(0.02 * WAVE.frequency(0.5, 9.81))


def test_fluid_starts_with_the_energy_of_the_wave():
    params = fluid_params(spacing=0.0125, sound_speed=25.0, fluid=(BOX,), wave=asdict(WAVE))
    initial = state(params)
    kinetic = 0.5 * 1000.0 * 0.0125**3 * (initial.velocity_pressure[:, :3] ** 2).sum()
    assert kinetic == pytest.approx(0.25 * 1000.0 * 9.81 * 0.02**2 * 0.1, rel=0.01)  # ρgA²/4


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"wave": {"amplitude": 0.02, "length": 0.7}}, "whole half waves; found 2.857 in 1 m"),
        ({"wave": {"amplitude": 0.0, "length": 1.0}}, "water.wave.amplitude should be greater"),
        ({"gravity": [1.0, 0.0, -9.81]}, "wave needs gravity along -z; found (1.0, 0.0, -9.81)"),
        ({"fluid": [BOX, [[2.0, 0.0, 0.0], [3.0, 0.1, 0.4]]]}, "wave needs one box of fluid"),
        ({"wave": {"amplitude": 0.02, "lenght": 1.0}}, "Did you mean length?"),
    ],
)
def test_a_wrong_wave_is_refused_with_a_sentence(changes, sentence):
    base = {"spacing": 0.1, "sound_speed": 30.0, "fluid": [BOX]}
    wave = {"wave": {"amplitude": 0.02, "length": 1.0}}
    params, mistakes = read(SphFluidParams, nested(base | wave | changes), "water")
    assert params is None and sentence in "\n".join(mistakes), mistakes


@pytest.mark.parametrize("dimensions", [2, 3])
def test_viscosity_on_approach_alone_is_half_of_monaghans(dimensions):
    # Monaghan, Rep. Prog. Phys. 68 (2005) 1703: ν = α h c₀ / 2(D + 2) if it acts on all pairs; of
    # the pairs in a shear flow, half approach.
    spacing, k = 0.05, 3.0
    fluid = law(spacing, 1.5, dimensions, viscosity__artificial=0.1)
    points = lattice(24, spacing, dimensions)
    speed = np.zeros_like(points)
    speed[:, 0] = np.sin(k * points[:, 2] + 0.3)
    acceleration = rates(points, speed, np.full(len(points), 1000.0), fluid)[:, 0]
    inside = (np.abs(points) < 0.2).all(axis=1)
    u, a = speed[inside, 0], acceleration[inside]
    viscosity = -(a @ u) / (u @ u) / k**2  # from a = -νk²u
    expected = 0.1 * 40.0 * 1.5 * spacing / (4.0 * (dimensions + 2))
    assert viscosity == pytest.approx(expected, rel=0.08)
