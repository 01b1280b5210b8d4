"""Stretched bodies of particles form clumps, unless an artificial stress repels them."""

import numpy as np
import pytest

from quintet.components.shared.materials.params import Material
from quintet.components.sph_solid.component import SphSolid
from quintet.components.sph_solid.kernels.material import write_artificial
from quintet.components.sph_solid.params import Body, SphSolidParams, SymmetryPlane

DX = 1e-3  # m
SIDE = 16  # particles along x and z
STRETCHED = 0.95  # density over that at rest
RUBBER = Material(density=1000.0, youngs_modulus=1e7, poissons_ratio=0.4)


def stretched_square(**settings):
    """A square in plane strain between symmetry planes, in uniform tension, slightly disturbed."""
    edge = SIDE * DX
    planes = [
        SymmetryPlane(axis=axis, position=position, side=side)
        for axis in ("x", "z")
        for position, side in ((0.0, "+"), (edge, "-"))
    ]
    body = Body(lowest=(0.0, 0.0, 0.0), highest=(edge, 1.0, edge), material=RUBBER)
    solid = SphSolid(
        SphSolidParams(spacing=DX, dimensions=2, bodies=(body,), symmetry=tuple(planes), **settings)
    )
    state, bulk = solid.state, RUBBER.bulk
    state.volume *= STRETCHED
    state.density_ratio[:], state.pressure[:] = STRETCHED, (STRETCHED - 1.0) * bulk
    shift = 0.01 * DX * np.random.default_rng(1).uniform(-1.0, 1.0, (state.particles, 3))
    state.position += shift * (1.0, 0.0, 1.0)
    solid._begin()
    return solid


def nearest_pair(solid):
    """Smallest distance of two particles over the spacing."""
    position = solid.state.position
    distance = np.linalg.norm(position[:, None] - position[None, :], axis=2)
    np.fill_diagonal(distance, np.inf)
    return distance.min() / DX


def run(solid, steps=600):
    for _ in range(steps):
        solid.step(solid.stable_dt())
    return solid


def test_stretched_particles_form_clumps_and_an_artificial_stress_holds_them_apart():
    settings = {"kernel_correction": False}
    assert nearest_pair(stretched_square(**settings)) > 0.97
    assert nearest_pair(run(stretched_square(**settings))) < 0.6
    assert nearest_pair(run(stretched_square(artificial_stress=0.3))) > 0.85


def test_work_of_the_artificial_stress_is_energy_and_its_forces_balance():
    body = Body(lowest=(0.0, 0.0, 0.0), highest=(8 * DX, 1.0, 8 * DX), material=RUBBER)
    settings = {"spacing": DX, "dimensions": 2, "bodies": (body,), "courant": 0.2}
    solid = SphSolid(SphSolidParams(**settings, artificial_stress=0.3))
    state = solid.state
    state.velocity[:, 0] = 20.0 * (state.position[:, 0] / (4 * DX) - 1.0)  # pulled apart
    before = solid.totals()
    run(solid, 300)
    after = solid.totals()
    start_energy = before.kinetic + before.internal
    assert after.kinetic + after.internal == pytest.approx(start_energy, rel=1e-3)
    momentum_scale = np.abs(state.velocity).max() * after.mass
    assert np.abs(after.momentum - before.momentum).max() < 1e-12 * momentum_scale


def test_the_artificial_stress_is_of_the_tensions_along_principal_axes():
    for stress in np.random.default_rng(2).normal(size=(20, 6)):
        xx, yy, zz, xy, yz, zx = stress
        matrix = np.array([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]])
        value, vector = np.linalg.eigh(matrix)
        exact = vector @ np.diag(np.maximum(value, 0.0)) @ vector.T
        rows = np.zeros((1, 16))
        rows[0, :6] = stress
        write_artificial(0, 1, 1.0, rows)
        assert -rows[0, 8:14] == pytest.approx(exact[[0, 1, 2, 0, 1, 2], [0, 1, 2, 1, 2, 0]])


def test_an_artificial_stress_of_corrected_gradients_or_of_rings_is_refused():
    body = Body(lowest=(0.0, 0.0, 0.0), highest=(DX, 1.0, DX), material=RUBBER)
    for settings in ({"kernel_correction": True}, {"axisymmetric": True}):
        with pytest.raises(ValueError, match="artificial_stress works with uncorrected gradients"):
            SphSolidParams(
                spacing=DX, dimensions=2, bodies=(body,), artificial_stress=0.3, **settings
            )
