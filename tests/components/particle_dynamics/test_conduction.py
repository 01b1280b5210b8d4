"""Heat conduction by random collisions, in theory and in a bar between two baths."""

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

A, MASS, TOP, LAYERS = 0.01, 1e-3, 50.0, 10  # m, kg, Hz
OMEGA = 2.0 * math.pi * TOP
UNIT = MASS * (A * OMEGA) ** 2  # J; also the unit of temperature, with k = 1


def bath(layer, temperature):
    x = layer * A
    return Bath(
        lowest=(x, 0.0, 0.0), highest=(x, 3 * A, 3 * A), temperature=temperature,
        rate=6.0 * OMEGA, tether=0.3 * MASS * OMEGA**2,
    )  # fmt: skip


def test_fast_collisions_conduct_three_quarters_of_their_rate():
    """κ = 3/4 k λ/a.

    A collision turns the relative velocity into a random direction. On average both points then
    have half of their energy, so 3/4 k times their temperature difference is exchanged.
    The conduction of the bonds falls as collisions become more frequent; at a rate of 4 ω it is
    within the scatter.
    """
    rate, temperature = 4.0 * OMEGA, 4e-5 * UNIT
    solver = ParticleLattice(
        ParticleLatticeParams(
            lattice=Lattice(
                cells=(LAYERS - 1, 3, 3), spacing=A, mass=MASS, temperature=temperature
            ),
            seven_roots=SevenRootForce(top_frequency=TOP),
            boltzmann=1.0,
            collision_rate=rate,
            courant=0.125,
            substeps=1000,
            averages=Averages(begin=4.0, block=2.0),
            baths=(bath(0, 1.3 * temperature), bath(LAYERS - 1, 0.7 * temperature)),
        )
    )
    for _ in range(12):
        solver.step(2.0)
    outputs = solver.give({"points.temperature", "baths.heat_flow"})
    layers = outputs["points.temperature"].reshape(LAYERS, 16).mean(axis=1)
    slope = -np.polyfit(np.arange(1, LAYERS - 1), layers[1:-1], 1)[0]
    flow = 0.5 * (outputs["baths.heat_flow"][0] - outputs["baths.heat_flow"][1])
    assert flow / (16 * slope * rate) == pytest.approx(0.75, rel=0.05)
