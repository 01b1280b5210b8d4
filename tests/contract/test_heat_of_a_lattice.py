"""A conducting lattice and a slab: the temperature between them follows from their resistances."""

import laboratory
import numpy as np
import pytest

from quintet.components.particle_dynamics.component import ParticleLattice
from quintet.components.particle_dynamics.params import ParticleLatticeParams
from quintet.interfaces.params import read

HOT, COLD, BETWEEN = 400.0, 200.0, 310.0  # K
TOP = 50.0  # Hz
FREQUENCY = 2.0 * np.pi * TOP  # rad/s
UNIT = 1.0 * (0.5 * FREQUENCY) ** 2  # J, m (a omega)2
WINDOW = 20.0  # s


def bath(height, temperature, coupled):
    return {
        "lowest": [0.0, 0.0, height],
        "highest": [1.0, 1.0, height],
        "temperature": temperature,
        "rate": 3.0 * FREQUENCY,
        "tether": 0.3 * FREQUENCY**2,
        "coupled": coupled,
    }


# Five layers of four points, the lowest on the face of the slab.
LATTICE = {
    "lattice": {
        "cells": [1, 1, 4],
        "spacing": 0.5,
        "mass": 1.0,
        "lowest": [0.25, 0.25, 0.0],
        "temperature": 0.5 * (BETWEEN + COLD),
    },
    "seven_roots": {"top_frequency": TOP},
    "boltzmann": 4e-5 * UNIT / 300.0,
    "collision_rate": FREQUENCY,
    "courant": 0.125,
    "substeps": 1000,
    "averages": {"begin": 20.0, "block": 20.0},
    "baths": [bath(0.0, BETWEEN, True), bath(2.0, COLD, False)],
}


def conductance(folder):
    """Heat flow [W/K] through the lattice over the difference of its baths, in a run of its own."""
    params, mistakes = read(ParticleLatticeParams, LATTICE, "lattice", folder)
    assert not mistakes
    lattice = ParticleLattice(params)
    for _ in range(20):
        lattice.step(WINDOW)
    flow = lattice.give({"baths.heat_flow"})["baths.heat_flow"]
    assert flow[0] == pytest.approx(-flow[1], rel=0.02)
    return 0.5 * (flow[0] - flow[1]) / (BETWEEN - COLD)


@pytest.mark.slow
def test_a_lattice_and_a_slab_find_the_temperature_between_them(tmp_path):
    """Within 3 % of the difference; every joule that leaves the lattice's wall reaches the slab."""
    lattice_conductance = conductance(tmp_path)
    # W/K, so that the temperature should be BETWEEN.
    slab = lattice_conductance * (BETWEEN - COLD) / (HOT - BETWEEN)
    components = {
        "slab": {"kind": "toy_heat:Slab", "hot": HOT, "conductance": slab / 4},
        "bar": {"kind": "particle_lattice"} | LATTICE,
    }
    link = {"kind": "heat", "name": "heat", "between": ["bar", "slab"], "relaxation": [0.5, 0.2]}
    settings = {"window": WINDOW, "end": 24 * WINDOW, "order": ["slab", "bar"]}
    trace = laboratory.couple(laboratory.scene(tmp_path, components, link, **settings))
    temperatures = trace.history("slab", "node_temperature.temperature").mean(axis=1)
    assert temperatures[8:].mean() == pytest.approx(BETWEEN, abs=0.03 * (HOT - COLD))
    assert trace.account.heat_residual <= 1e-12
