"""Bodies of particles beyond their usual range: stable, or an error that names a particle."""

import dataclasses
import math

import numpy as np
import pytest

from quintet.components.shared.materials.params import material
from quintet.components.sph_solid.component import SphSolid
from quintet.components.sph_solid.params import Body, SphSolidParams, SymmetryPlane
from quintet.components.sph_solid.view import von_mises
from quintet.interfaces.errors import StepError

DX = 1e-3  # m
COPPER = material("copper")
ALUMINIUM = material("aluminium")


def energy(solid):
    totals = solid.totals()
    return totals.kinetic + totals.internal


def striking_block(speed, block_material, size=(4, 4, 6), **settings):
    """A block that strikes a plane of symmetry [m/s]."""
    high = tuple(DX * n for n in size)
    body = Body(
        lowest=(0.0, 0.0, 0.0), highest=high, material=block_material, velocity=(0, 0, -speed)
    )
    planes = (SymmetryPlane(axis="z"),)
    return SphSolid(SphSolidParams(spacing=DX, bodies=(body,), symmetry=planes, **settings))


def test_plastic_strain_goes_beyond_five():
    solid = striking_block(900.0, COPPER)
    solid.state.strain[:] = 4.5
    start = energy(solid)
    while solid.state.time < 1.2e-5:
        solid.step(solid.stable_dt())
    assert solid.state.strain.max() > 5.0 and np.isfinite(solid.state.position).all()
    assert energy(solid) == pytest.approx(start, rel=0.01)


def test_at_melting_it_bears_no_shear():
    assert ALUMINIUM.johnson_cook is not None
    melting = ALUMINIUM.johnson_cook.melting_temperature
    solid = striking_block(300.0, dataclasses.replace(ALUMINIUM, temperature=melting + 20.0))
    start = energy(solid)
    for _ in range(60):
        solid.step(solid.stable_dt())
    hot = solid.state.temperature >= melting
    assert hot.any() and (von_mises(solid.state.deviator[hot]) < 1e-3 * 330e6).all()
    assert energy(solid) == pytest.approx(start, rel=0.01)


def test_what_is_pressed_beyond_the_equation_of_state_is_named():
    """At the Hugoniot's pole, η = 1/S, the pressure is infinite."""
    solid = striking_block(100.0, "steel", (3, 3, 3))
    solid.state.density_ratio[5] = 3.2
    with pytest.raises(StepError, match=r"particle \d+ of body 0, at .* Lower courant"):
        solid.step(solid.stable_dt())


def test_bodies_that_begin_in_each_other_fly_apart_or_are_named():
    steel = Body(lowest=(0.0, 0.0, 0.0), highest=(4 * DX, 4 * DX, 4 * DX), material="steel")
    aluminium = Body(
        lowest=(2.3 * DX, 0.2 * DX, 0.1 * DX), highest=(5.3 * DX, 3.2 * DX, 3.1 * DX),
        material="aluminium", velocity=(-100.0, 0.0, 0.0),
    )  # fmt: skip
    solid = SphSolid(SphSolidParams(spacing=DX, bodies=(steel, aluminium)))
    start = solid.totals().momentum
    for _ in range(100):
        solid.step(solid.stable_dt())
    assert math.isfinite(energy(solid))
    np.testing.assert_allclose(solid.totals().momentum, start, atol=1e-12 * abs(start[0]))
