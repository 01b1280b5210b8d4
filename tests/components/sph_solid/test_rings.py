"""Axisymmetric rings, against exact solutions and against bodies in three dimensions."""

import math

import numpy as np
import pytest

from quintet.components.shared.materials.params import Material
from quintet.components.sph_solid import axisymmetric as image_lists
from quintet.components.sph_solid.component import SphSolid
from quintet.components.sph_solid.kernels.azimuthal_images import image_counts
from quintet.components.sph_solid.params import Body, SphSolidParams, SymmetryPlane
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import StepError

E, NU, RHO = 7e10, 0.3, 2700.0
ELASTIC = Material(density=RHO, youngs_modulus=E, poissons_ratio=NU)
CALM = {"viscosity_linear": 0.0, "viscosity_quadratic": 0.0}
DX = 1e-3  # m
RINGS = {"spacing": DX, "dimensions": 2, "axisymmetric": True}


def rings(size, **settings):
    """A solid cylinder about the axis."""
    body = Body(lowest=(0, 0, 0), highest=(DX * size[0], 1.0, DX * size[1]), material=ELASTIC)
    return SphSolid(SphSolidParams(bodies=(body,), **RINGS, **settings))


def strike(**settings):
    """A ball of aluminium that strikes a plate at 7400 m/s."""
    ball = Body(shape="sphere", centre=(0, 0, 3 * DX), radius=3 * DX, material="aluminium",
                velocity=(0.0, 0.0, -7400.0))  # fmt: skip
    plate = Body(lowest=(0, 0, -8 * DX), highest=(20 * DX, 1.0, 0), material="aluminium")
    return SphSolid(SphSolidParams(bodies=(ball, plate), **RINGS, **settings))


def test_rings_have_the_mass_of_what_they_are_cut_from():
    assert rings((7, 5)).totals().mass == pytest.approx(
        RHO * math.pi * (7 * DX) ** 2 * 5 * DX, rel=1e-12
    )
    ball = Body(shape="sphere", centre=(0, 0, 0), radius=4 * DX, material=ELASTIC)
    solid = SphSolid(SphSolidParams(bodies=(ball,), **RINGS))
    assert solid.totals().mass == pytest.approx(RHO * math.pi / 6.0 * (8 * DX) ** 3, rel=1e-12)


@pytest.mark.parametrize("correction", [False, True])
def test_the_hoop_strain_is_that_of_the_radius(correction):
    """u_r = a r strains hoops by a, with the right sign, at the axis and away from it."""
    solid = rings((24, 12), kernel_correction=correction, **CALM)
    dt, rate = 1e-9, 1000.0
    solid.state.velocity[:, 0] = rate * solid.state.position[:, 0]
    solid.step(dt)
    inner = np.abs(solid.state.position[:, 2] - 6 * DX) < 3 * DX
    inner &= solid.state.position[:, 0] < 20 * DX
    ratio = 1.0 if correction else solid.state.density_ratio[inner]
    hoop = solid.rows.gradient[inner, 4] / ratio
    assert hoop == pytest.approx(rate, rel=1e-6 if correction else 0.05)
    assert solid.rows.gradient[inner, 0] / ratio == pytest.approx(
        rate, rel=1e-6 if correction else 0.05
    )


def test_momentum_along_the_axis_is_kept_to_rounding():
    solid = strike()
    start = solid.totals()
    for _ in range(150):
        solid.step(solid.stable_dt())
    end = solid.totals()
    assert abs(end.momentum[2] / start.momentum[2] - 1.0) < 1e-13
    drift = (end.kinetic + end.internal) / (start.kinetic + start.internal) - 1.0
    assert abs(drift) < 3e-3
    assert end.kinetic < 0.6 * start.kinetic


def test_steps_far_beyond_the_stable_one_end_in_an_error_of_the_step():
    bar = strike(courant=8.0)
    with pytest.raises(StepError, match="Lower courant"):
        for _ in range(20):
            bar.step(bar.stable_dt())


def test_a_ball_of_rings_rings_as_one_in_three_dimensions():
    """The first mode of a free elastic ball has the same period, as rings and in 3D."""
    ends = []
    for axisymmetric in (True, False):
        ball = Body(shape="sphere", centre=(0, 0, 0), radius=5 * DX, material=ELASTIC)
        settings = {"dimensions": 2, "axisymmetric": True} if axisymmetric else {}
        planes = () if axisymmetric else (SymmetryPlane(axis="x"), SymmetryPlane(axis="y"))
        solid = SphSolid(
            SphSolidParams(
                spacing=DX,
                bodies=(ball,),
                symmetry=planes,
                kernel_correction=True,
                **settings,
                **CALM,
            )
        )
        x, y, z = solid.state.position.T
        shape = np.stack([-0.5 * x, -0.5 * y, z], axis=1)
        solid.state.velocity[:] = 100.0 * shape
        mass, amplitudes = solid.materials.mass(solid.state), []
        for _ in range(140):
            solid.step(4e-8)
            x, y, z = solid.state.position.T
            shape = np.stack([-0.5 * x, -0.5 * y, z], axis=1)
            amplitudes.append(float((mass[:, None] * solid.state.velocity * shape).sum()))
        ends.append(np.flatnonzero(np.diff(np.sign(amplitudes)))[0] * 4e-8)
    assert ends[0] == pytest.approx(ends[1], rel=0.03)


def test_threads_change_no_bit_and_a_resumed_run_has_the_same():
    original, resumed = strike(), strike()
    threaded = SphSolid(original.params, Resources(threads=2))
    threaded.team.fewest = 50
    for _ in range(20):
        original.step(original.stable_dt())
        threaded.step(threaded.stable_dt())
    resumed.load(original.save())
    for _ in range(10):
        for solid in (original, resumed, threaded):
            solid.step(solid.stable_dt())
    for key, array in original.save().items():
        np.testing.assert_array_equal(array, resumed.save()[key], err_msg=key)
        np.testing.assert_array_equal(array, threaded.save()[key], err_msg=key)


@pytest.mark.parametrize("axisymmetric", [True, False])
def test_lists_that_are_kept_miss_no_pair(axisymmetric, monkeypatch):
    """Forces of a body that flies apart equal those with fresh lists; few searches are needed.

    Rings keep the number of cuts that they had when they were listed.
    """
    ball = Body(shape="sphere", centre=(0, 0, 2 * DX), radius=2 * DX, material="aluminium",
                velocity=(0.0, 0.0, -2000.0))  # fmt: skip
    plate = Body(lowest=(0, 0, -4 * DX), highest=(10 * DX, 10 * DX, 0), material="aluminium")
    settings = {"dimensions": 2, "axisymmetric": True} if axisymmetric else {}
    planes = () if axisymmetric else (SymmetryPlane(axis="x"), SymmetryPlane(axis="y"))
    params = SphSolidParams(
        spacing=DX, bodies=(ball, plate), symmetry=planes, courant=0.3, **settings, **CALM
    )
    solid, searches, search = SphSolid(params), [], None
    search = solid._search
    solid._search = lambda dt: (searches.append(dt), search(dt))
    for step in range(240):
        solid.step(solid.stable_dt())
        if step % 20:
            continue
        fresh = SphSolid(params)
        fresh.load(solid.save())
        fresh.all_ranks.sort(fresh.state, fresh.state.position)
        numbers = np.empty(solid.items(), np.int64)
        numbers[solid.state.identity] = image_counts(solid.state.reference[:, 0], params.length)
        with monkeypatch.context() as patch:
            patch.setattr(
                image_lists,
                "image_counts",
                lambda *_, solver=fresh, n=numbers: n[solver.state.identity],
            )
            fresh._list()
        fresh.rows.fill(fresh.state, fresh.state.position, fresh.state.sound)
        fresh.materials.write_stresses(fresh.state, fresh.rows, fresh.law)
        fresh._write_accelerations()
        acceleration, expected = (
            solver.state.acceleration[np.argsort(solver.state.identity)]
            for solver in (solid, fresh)
        )
        np.testing.assert_allclose(expected, acceleration, atol=1e-9 * np.abs(acceleration).max())
    assert len(searches) < 120
