"""Structures that strike a rigid wall: stable, or ended with a sentence that names the place."""

import dataclasses

import numpy as np
import pytest

from quintet.components.fe_plate.component import FePlate
from quintet.components.fe_plate.meshes.params import Part
from quintet.components.fe_plate.params import (
    FePlateParams,
    RigidWall,
)
from quintet.components.fe_plate.state import STRAIN
from quintet.components.fe_plate.view import von_mises
from quintet.components.shared.materials.params import JohnsonCook, Material, material

WALL = RigidWall(point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0))


def striking_block(speed, material="steel", elements=(8, 8, 8), **keys):
    size = tuple(4e-4 * n for n in elements)
    part = Part(
        lowest=(0.0, 0.0, 0.0),
        highest=size,
        elements=elements,
        material=material,
        velocity=(0.0, 0.0, -speed),
    )
    return FePlate(FePlateParams(parts=(part,), rigid_walls=(WALL,), **keys))


def advance(structure, steps):
    for _ in range(steps):
        structure.step(min(structure.stable_dt(), 1e-7))
    totals = structure.totals()
    return totals.kinetic + totals.internal


@pytest.mark.parametrize(
    ("material", "speed"),
    [("steel", 300.0), ("steel", 1000.0), ("aluminium", 6000.0), ("aluminium", 12000.0)],
)
def test_a_block_that_strikes_a_wall_stays_finite_and_gains_no_energy(material, speed):
    structure = striking_block(speed, material)
    start = structure.totals().kinetic
    end = advance(structure, 400)
    # Lost energy stays at the wall: half a layer of elements stops at once, and so do nodes that
    # erosion has set free.
    assert 0.5 * start < end < 1.001 * start
    assert end - structure.totals().work == pytest.approx(start, rel=0.01)
    assert np.isfinite(structure.state.points).all() and np.isfinite(structure.state.position).all()
    assert structure.places.active(structure.state).mean() < 1.0


def test_elements_that_are_eroded_may_be_turned_inside_out():
    structure = striking_block(300.0)
    advance(structure, 600)
    volume = np.empty(len(structure.mesh.corner))
    corner = structure.state.position[structure.mesh.corner]
    edges = [corner[:, k] - corner[:, 0] for k in (1, 3, 4)]
    volume = np.einsum("ij,ij->i", edges[0], np.cross(edges[1], edges[2]))
    is_eroded = structure.places.active(structure.state) == 0.0
    assert is_eroded.any() and (volume[~is_eroded] > 0.0).all()


def test_plastic_strains_beyond_three_stay_stable():
    structure = striking_block(1200.0, "42CrMo4")
    start = structure.totals().kinetic
    end = advance(structure, 700)
    assert structure.places.of(structure.state, STRAIN).max() > 3.0
    assert 0.9 * start < end < 1.001 * start


def test_a_plate_of_one_element_strikes_a_wall():
    structure = striking_block(1000.0, "42CrMo4", (6, 6, 1))
    start = structure.totals().kinetic
    end = advance(structure, 400)
    assert 0.45 * start < end < 1.001 * start  # half of its mass stops at once
    assert end - structure.totals().work == pytest.approx(start, rel=0.01)
    assert structure.state.wall_impulse.sum() > 0.9 * structure.totals().mass * 1000.0


def test_the_wall_shortens_the_step_before_it_is_met():
    near, far = striking_block(10e3, "aluminium"), striking_block(10.0, "aluminium")
    assert near.stable_dt() < 0.3 * far.stable_dt()
    assert near.stable_dt() * 10e3 < 0.25 * 4e-4  # m, of an element


def test_beyond_melting_nothing_bears_shear():
    molten = dataclasses.replace(material("42CrMo4"), temperature=1900.0)
    structure = striking_block(300.0, molten)
    start = structure.totals().kinetic
    end = advance(structure, 300)
    assert 0.9 * start < end < 1.001 * start
    assert von_mises(structure.places, structure.state).max() < 1.0  # Pa
    assert structure.places.of(structure.state, STRAIN).max() > 0.3


def test_plastic_strains_beyond_five_stay_stable():
    weak = Material(
        density=7850.0,
        youngs_modulus=2e11,
        poissons_ratio=0.3,
        johnson_cook=JohnsonCook(a=3e8),
    )
    structure = striking_block(3500.0, weak)
    start = structure.totals().kinetic
    end = advance(structure, 1200)
    assert structure.places.of(structure.state, STRAIN).max() > 5.0
    assert 0.85 * start < end < 1.001 * start
