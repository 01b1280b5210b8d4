"""Warnings of results that are probably wrong: energy that grows, numerical fracture."""

import math

import numpy as np
import pytest

from quintet.components.shared.materials.params import Material
from quintet.components.sph_solid.component import SphSolid
from quintet.components.sph_solid.params import Body, Region, SphSolidParams

DX = 1e-3  # m
LONG, WIDE = 24, 6  # particles
RUBBER = Material(density=1000.0, youngs_modulus=1e7, poissons_ratio=0.4)


def strip(material=RUBBER, **settings):
    """A strip in plane strain."""
    body = Body(lowest=(0.0, 0.0, 0.0), highest=(LONG * DX, 1.0, WIDE * DX), material=material)
    defaults = {"viscosity_linear": 0.0, "viscosity_quadratic": 0.0}
    return SphSolid(
        SphSolidParams(spacing=DX, dimensions=2, bodies=(body,), **(defaults | settings))
    )


def stretch(solid, speed):
    """Pull both ends apart, at a speed [m/s]."""
    x = solid.state.position[:, 0]
    solid.state.velocity[:, 0] = speed * np.sin(math.pi * (x / (LONG * DX) - 0.5))
    return solid


def run(solid, time):
    while solid.state.time < time:
        solid.step(solid.stable_dt())
    return solid


def test_material_that_tears_although_nothing_fails_is_told():
    settings = {"viscosity_linear": 0.2, "viscosity_quadratic": 0.4}
    torn = run(stretch(strip(total_lagrangian=False, **settings), 60.0), 6e-4)
    assert "numerical fracture" in torn.warnings()["fracture"]
    assert 0.0 < torn.state.torn[1] < 6e-4
    whole = run(stretch(strip(total_lagrangian=True, **settings), 30.0), 6e-4)
    assert not whole.warnings()


def test_material_that_fails_by_its_law_is_not_called_torn():
    brittle = Material(density=1e3, youngs_modulus=1e7, poissons_ratio=0.4, spall_stress=1e6)
    solid = run(stretch(strip(brittle, total_lagrangian=False), 60.0), 6e-4)
    assert solid.state.failed.any() and "fracture" not in solid.warnings()


def test_a_law_of_failure_that_never_acts_does_not_hide_a_tear():
    tough = Material(density=1e3, youngs_modulus=1e7, poissons_ratio=0.4, spall_stress=1e12)
    settings = {"viscosity_linear": 0.2, "viscosity_quadratic": 0.4}
    solid = run(stretch(strip(tough, total_lagrangian=False, **settings), 60.0), 6e-4)
    assert "fracture" in solid.warnings()


def test_an_isolated_body_that_gains_energy_is_told():
    solid = stretch(strip(total_lagrangian=False, courant=1.0), 5.0)
    for _ in range(400):
        solid.step(solid.stable_dt())
        if solid.warnings():
            break
    assert "gained" in solid.warnings()["energy"]
    assert "Lower courant (now 1)" in solid.warnings()["energy"]


def test_motion_that_the_artificial_viscosity_takes_from_elastic_bodies_is_told():
    solid = run(stretch(strip(total_lagrangian=True, viscosity_linear=2.0), 5.0), 4e-4)
    assert "turned" in solid.warnings()["viscosity"]


def test_work_that_is_done_on_glued_particles_is_no_gain():
    layer = Region(lowest=(0.0, 0.0, 0.0), highest=(DX, 1.0, 1.0))
    solid = strip(glued=(layer,))
    solid.bind({}, frozenset({"glued", "glued_load"}))
    pull = np.tile([-3.0, 0.0, 0.0], (len(solid.state.active), 1))
    for _ in range(200):
        solid.take({"glued.velocity": pull})
        solid.step(solid.stable_dt())
    assert solid.state.work > 0.0 and not solid.warnings()
    assert np.ptp(solid.state.sums) < 2e-3 * solid.state.ranges.max()


@pytest.mark.parametrize("speed", [0.0, 1000.0])
def test_a_body_at_rest_or_in_even_motion_is_sound(speed):
    solid = strip()
    solid.state.velocity[:, 0] = speed
    for _ in range(70):
        solid.step(solid.stable_dt())
    assert not solid.warnings()


@pytest.mark.parametrize(
    ("speed", "settings", "sentence"),
    [
        (1000.0, {"viscosity_linear": 0.0}, "too little artificial viscosity"),
        (1000.0, {"viscosity_linear": 10.0}, "so much artificial viscosity"),
        (1000.0, {}, None),
        (200.0, {"viscosity_linear": 0.1, "viscosity_quadratic": 0.5}, None),
    ],
)
def test_viscosities_that_do_not_suit_the_speed_of_impact_are_told(speed, settings, sentence):
    low, high = (0.0, 0.0, 0.0), (3 * DX, 3 * DX, 3 * DX)
    body = Body(lowest=low, highest=high, material="steel", velocity=(0.0, 0.0, -speed))
    solid = SphSolid(SphSolidParams(spacing=DX, bodies=(body,), **settings))
    warning = solid.warnings().get("viscosity")
    assert warning is None if sentence is None else sentence in warning


def test_a_slow_impact_with_the_viscosity_of_shocks_is_noted():
    low, high = (0.0, 0.0, 0.0), (3 * DX, 3 * DX, 3 * DX)
    body = Body(lowest=low, highest=high, material="steel", velocity=(0.0, 0.0, -200.0))
    (note,) = SphSolid(SphSolidParams(spacing=DX, bodies=(body,))).notes()
    assert "viscosity_linear = 0.1" in note


def test_smoothing_that_reaches_too_few_particles_is_refused():
    with pytest.raises(ValueError, match=r"smoothing must lie between 0.9 and 4"):
        strip(smoothing=0.6)
