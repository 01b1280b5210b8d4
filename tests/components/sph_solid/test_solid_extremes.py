"""Bodies of particles beyond what they are meant for: stable, or an error that names a particle."""

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


def energy(made):
    found = made.totals()
    return found.kinetic + found.internal


def striking(speed, made_of, size=(4, 4, 6), **given):
    """A block that strikes a plane of symmetry [m/s]."""
    high = tuple(DX * n for n in size)
    body = Body(lowest=(0.0, 0.0, 0.0), highest=high, material=made_of, velocity=(0, 0, -speed))
    planes = (SymmetryPlane(axis="z"),)
    return SphSolid(SphSolidParams(spacing=DX, bodies=(body,), symmetry=planes, **given))


def test_plastic_strain_goes_beyond_five():
    made = striking(900.0, COPPER)
    made.state.strain[:] = 4.5
    start = energy(made)
    while made.state.time < 1.2e-5:
        made.step(made.stable_dt())
    assert made.state.strain.max() > 5.0 and np.isfinite(made.state.position).all()
    assert energy(made) == pytest.approx(start, rel=0.01)


def test_at_melting_it_bears_no_shear():
    assert ALUMINIUM.johnson_cook is not None
    melting = ALUMINIUM.johnson_cook.melting_temperature
    made = striking(300.0, dataclasses.replace(ALUMINIUM, temperature=melting + 20.0))
    start = energy(made)
    for _ in range(60):
        made.step(made.stable_dt())
    hot = made.state.temperature >= melting
    assert hot.any() and (von_mises(made.state.deviator[hot]) < 1e-3 * 330e6).all()
    assert energy(made) == pytest.approx(start, rel=0.01)


def test_what_is_pressed_beyond_the_equation_of_state_is_named():
    """At the Hugoniot's pole, η = 1/S, no pressure holds it."""
    made = striking(100.0, "steel", (3, 3, 3))
    made.state.density_ratio[5] = 3.2
    with pytest.raises(StepError, match=r"particle \d+ of body 0, at .* Lower courant"):
        made.step(made.stable_dt())


def test_bodies_that_begin_in_each_other_fly_apart_or_are_named():
    one = Body(lowest=(0.0, 0.0, 0.0), highest=(4 * DX, 4 * DX, 4 * DX), material="steel")
    other = Body(
        lowest=(2.3 * DX, 0.2 * DX, 0.1 * DX), highest=(5.3 * DX, 3.2 * DX, 3.1 * DX),
        material="aluminium", velocity=(-100.0, 0.0, 0.0),
    )  # fmt: skip
    made = SphSolid(SphSolidParams(spacing=DX, bodies=(one, other)))
    start = made.totals().momentum
    for _ in range(100):
        made.step(made.stable_dt())
    assert math.isfinite(energy(made))
    np.testing.assert_allclose(made.totals().momentum, start, atol=1e-12 * abs(start[0]))
