"""Escapes of a lattice from its minimum of energy, and the temperatures that a scene predicts."""

import copy
import tomllib
from pathlib import Path

import numpy as np
import pytest

from quintet.components.particle_dynamics.analysis.escapes import (
    DISPLACEMENTS,
    Saddle,
    climb,
    descend,
    find_saddles,
    lattice_of,
    loses_a_bond,
    median_temperature,
    relative_temperatures,
    saddle_at,
)
from quintet.components.particle_dynamics.analysis.lattice_energy import LatticeEnergy
from quintet.components.particle_dynamics.laws import energy, force
from quintet.components.particle_dynamics.potential import stiffness

SCENE = Path(__file__).resolve().parents[3] / "scenarios" / "hot_bar_baths" / "scene.toml"


@pytest.fixture(scope="module")
def lattice() -> LatticeEnergy:
    return LatticeEnergy(lattice_of(SCENE)[0])


@pytest.fixture(scope="module")
def saddle(lattice: LatticeEnergy) -> Saddle:
    """That of a corner of the hot end which is displaced sideways."""
    mode = np.zeros_like(lattice.start)
    mode[0, 1] = -1.0
    displaced = lattice.start + DISPLACEMENTS[0] * lattice.spacing * mode
    return saddle_at(lattice, climb(lattice, displaced, mode.ravel()))


def test_energy_and_its_derivatives_are_those_of_the_solver(lattice: LatticeEnergy) -> None:
    random = np.random.default_rng(0)
    position = lattice.start + 0.05 * lattice.spacing * random.normal(size=lattice.start.shape)
    arm = position[lattice.i] - position[lattice.j]
    length = np.linalg.norm(arm, axis=1)
    moved = position - lattice.start
    tethers = 0.5 * lattice.tether @ (moved**2).sum(axis=1)
    pairs = sum(energy(lattice.law, r) for r in length.tolist())
    assert lattice.energy(position) == pytest.approx(pairs + tethers, rel=1e-9)
    pull = np.zeros_like(position)
    for i, j, r, direction in zip(lattice.i, lattice.j, length.tolist(), arm, strict=True):
        pull[i] += force(lattice.law, r) / r * direction
        pull[j] -= force(lattice.law, r) / r * direction
    pull += lattice.tether[:, None] * moved
    assert lattice.gradient(position) == pytest.approx(pull, abs=1e-9 * np.abs(pull).max())
    direction = random.normal(size=position.shape)
    small = 1e-6 * lattice.spacing * direction
    change = lattice.gradient(position + small) - lattice.gradient(position - small)
    product = 2.0 * lattice.stiffness(position) @ small.ravel()
    assert change.ravel() == pytest.approx(product, abs=1e-6 * np.abs(product).max())
    assert stiffness(lattice.law, lattice.spacing) > 0.0


def test_over_a_saddle_the_lattice_loses_a_bond(lattice: LatticeEnergy, saddle: Saddle) -> None:
    values, modes = np.linalg.eigh(lattice.stiffness(saddle.position))
    assert values[0] < 0.0 < values[1] and loses_a_bond(lattice, saddle.position)
    move = 0.003 * lattice.spacing * modes[:, 0].reshape(saddle.position.shape)
    ends = [descend(lattice, saddle.position + sign * move) for sign in (1.0, -1.0)]
    assert max(map(lattice.energy, ends)) < lattice.energy(saddle.position)
    assert sorted(map(lattice.intact, ends)) == [27, 28]
    assert not loses_a_bond(lattice, lattice.start)


def test_the_prefactor_without_friction_is_that_of_vineyard(
    lattice: LatticeEnergy, saddle: Saddle
) -> None:
    """Product of the minimum's frequencies over those of the saddle, J. Phys. Chem. Solids 1957."""
    free = copy.copy(lattice)
    free.friction = np.zeros_like(lattice.friction)
    at_rest = np.linalg.eigvalsh(lattice.stiffness(lattice.start))
    at_saddle = np.linalg.eigvalsh(lattice.stiffness(saddle.position))[1:]
    log = 0.5 * (np.log(at_rest).sum() - np.log(at_saddle).sum() - np.log(lattice.mass))
    exact = np.exp(log) / (2.0 * np.pi)
    assert saddle_at(free, saddle.position).prefactor == pytest.approx(exact, rel=1e-6)
    assert saddle.prefactor < exact


def test_temperatures_follow_the_number_of_ways_out_and_the_warmth_of_the_points(
    lattice: LatticeEnergy, saddle: Saddle
) -> None:
    even = np.ones(len(lattice.start))
    hot = median_temperature(lattice, [saddle], even, 40.0)
    assert median_temperature(lattice, [saddle, saddle], even, 20.0) == pytest.approx(hot, rel=1e-9)
    assert median_temperature(lattice, [saddle], 0.5 * even, 40.0) == pytest.approx(2.0 * hot)
    assert median_temperature(lattice, [saddle], even, 80.0) < hot


@pytest.mark.full
def test_the_scene_predicts_what_all_escapes_say(lattice: LatticeEnergy) -> None:
    params, times, end = lattice_of(SCENE)
    relative, saddles = relative_temperatures(params, end), find_saddles(lattice)
    (limit,) = tomllib.loads(SCENE.read_text("utf-8"))["stability"]
    temperatures = [median_temperature(lattice, saddles, relative, time) for time in times]
    assert temperatures == pytest.approx(limit["predicted"], rel=0.01)
