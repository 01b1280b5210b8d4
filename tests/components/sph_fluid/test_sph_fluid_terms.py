"""Terms that a scene may add: diffusion of density, kinematic viscosity, a slab."""

import math

import numpy as np
import pytest
from fluid_params import fluid_params

from quintet.components.sph_fluid.component import SphFluid

BOX = ((0.0, 0.0, 0.0), (0.6, 0.6, 0.6))


def drop(**changes):
    settings = {"spacing": 0.05, "sound_speed": 60.0, "fluid": (BOX,), "viscosity.artificial": 0.0}
    return SphFluid(fluid_params(**(settings | {"gravity": (0.0, 0.0, 0.0)} | changes)))


def rates(fluid):
    fluid.lists.sort(fluid.state)
    fluid._list()
    fluid._compute_rates(0.0, 0.0)
    return fluid.pairs.rates.rate[: fluid.state.fluid]


def test_diffusion_makes_no_mass_and_levels_density():
    fluid = drop(density_diffusion=0.1)
    noise = np.random.default_rng(1).normal(0.0, 1.0, fluid.state.fluid)
    fluid.state.position_density[:, 3] += noise
    growth = rates(fluid)[:, 3]
    excess = fluid.state.position_density[: fluid.state.fluid, 3] - 1000.0
    assert abs(growth.sum()) < 1e-10 * np.abs(growth).sum()
    assert (growth * excess).sum() < 0.0


def test_diffusion_leaves_water_under_its_own_weight_alone():
    settings = {"gravity": (0.0, 0.0, -9.81), "sound_speed": 48.6}
    rate = rates(drop(density_diffusion=0.1, **settings))[:, 3]
    assert np.abs(rates(drop(**settings))[:, 3]).max() == 0.0
    # Fourtakas' term alone accounts for the weight; the rest is its expansion in p/B.
    uniform = drop(density_diffusion=0.1, **settings)
    uniform.state.position_density[:, 3] = 1000.0
    assert np.abs(rate).max() < 0.05 * np.abs(rates(uniform)[:, 3]).max()


def test_kinematic_viscosity_has_the_value_asked_for():
    # u = sin kz decays with ν k².
    fluid = drop(viscosity__kinematic=0.01, dimensions=2, spacing=0.02)
    wave = 2.0 * math.pi / 0.6
    state = fluid.state
    state.velocity_pressure[:, 0] = np.sin(wave * state.position_density[:, 2])
    rate = rates(fluid)
    place = state.position_density[: state.fluid]
    inside = ((place[:, [0, 2]] > 0.1) & (place[:, [0, 2]] < 0.5)).all(axis=1)
    expected = -0.01 * wave**2 * np.sin(wave * place[inside, 2])
    error = np.abs(rate[inside, 0] - expected).max() / np.abs(expected).max()
    assert error < 0.02


def test_viscous_step_limit_is_stated():
    fluid = drop(viscosity__kinematic=10.0)
    assert fluid.stable_dt() == pytest.approx(0.125 * fluid.constants.smoothing.length**2 / 10.0)


def test_viscosity_and_diffusion_keep_momentum():
    fluid = drop(viscosity__kinematic=0.1, density_diffusion=0.1, boundary__method="mdbc")
    fluid.state.velocity_pressure[:, :3] = np.random.default_rng(2).normal(
        0.0, 0.1, (fluid.state.fluid, 3)
    )
    force = rates(fluid)[:, :3]
    assert np.abs(force.sum(axis=0)).max() < 1e-11 * np.abs(force).sum()


def test_a_slab_weighs_as_much_as_its_water():
    slab = drop(dimensions=2)
    assert len(slab.state.position_density) == 12 * 12
    assert slab.totals().mass == pytest.approx(1000.0 * 0.6**3)


def test_a_slab_falls_like_a_block():
    slab = drop(dimensions=2, gravity=(0.0, 0.0, -9.81), sound_speed=30.0)
    slab.state.position_density[:, 3] = 1000.0
    slab.state.velocity_pressure[:, 3] = 0.0
    for _ in range(10):
        slab.step(1e-4)
    assert slab.totals().momentum[2] == pytest.approx(-9.81 * 1e-3 * slab.totals().mass, rel=1e-12)
    assert np.ptp(slab.state.position_density[:, 1]) == 0.0
