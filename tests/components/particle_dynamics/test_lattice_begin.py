"""Lattices that begin from the state of another run."""

import math

import numpy as np
import pytest

from quintet.components.particle_dynamics.component import ParticleLattice
from quintet.components.particle_dynamics.params import (
    Averages,
    Bath,
    Lattice,
    ParticleLatticeParams,
    SevenRootForce,
)
from quintet.components.particle_dynamics.state import TIME

A, MASS, TOP = 0.01, 1e-3, 50.0  # m, kg, Hz
UNIT = MASS * (A * 2.0 * math.pi * TOP) ** 2  # J; also the unit of temperature, with k = 1
FORCE = SevenRootForce(top_frequency=TOP)


def lattice(temperature=0.0, **settings):
    points = Lattice(cells=(3, 1, 1), spacing=A, mass=MASS, temperature=temperature)
    return ParticleLattice(
        ParticleLatticeParams(lattice=points, seven_roots=FORCE, boltzmann=1.0, **settings)
    )


def run(solver, seconds):
    while solver.state.energies[TIME] < seconds * (1.0 - 1e-9):
        solver.step(solver.stable_dt())


def test_averages_begin_again_from_the_state_of_another_run():
    warm, step = 1e-4 * UNIT, 0.06 / (2.0 * math.pi * TOP)
    first = lattice(warm)
    run(first, 50.5 * step)
    solver = lattice(warm, averages=Averages(begin=10.5 * step))
    solver.begin_from(first.save())
    kinetic = []
    for _ in range(30):
        solver.step(step)
        kinetic.append(0.5 * MASS * (solver.state.velocity**2).sum())
    mean = sum(kinetic[10:]) / 19.5  # of the time since then
    hotness = solver.give({"points.hotness"})["points.hotness"]
    assert hotness.sum() == pytest.approx(mean, rel=1e-9)
    loaded = lattice(warm, averages=Averages(begin=10.5 * step))
    loaded.load(solver.save())
    for component in (solver, loaded):
        component.step(step)
    ends = [component.give({"points.hotness"})["points.hotness"] for component in (solver, loaded)]
    assert np.array_equal(*ends)


def test_a_run_from_the_state_of_another_has_its_own_baths_and_frozen_points():
    box = {"lowest": (0.0, 0.0, 0.0), "highest": (0.0, A, A), "rate": 1e5}
    first = lattice(1e-4 * UNIT, baths=(Bath(**box, temperature=1e-4 * UNIT),))
    run(first, 1e-3)
    cold = Bath(**box, temperature=0.0)
    solver = lattice(baths=(cold,), frozen=((3 * A, 0.0, 0.0),))
    solver.begin_from(first.save())
    (point,) = solver.built.frozen
    before = solver.state.position[point].copy()
    run(solver, 2e-3)
    assert np.array_equal(solver.state.position[point], before)
    in_bath = np.linalg.norm(solver.state.velocity[solver.bathed.point], axis=1).max()
    assert in_bath < 0.2 * np.linalg.norm(solver.state.velocity, axis=1).max()
