"""Bodies that keep their initial pairs: stretching, rotation, contact, restart."""

import math

import numpy as np
import pytest

from quintet.components.shared.materials.params import Material
from quintet.components.sph_solid.component import SphSolid
from quintet.components.sph_solid.params import Body, SphSolidParams, SymmetryPlane

DX = 1e-3  # m
LONG, WIDE = 24, 6  # particles
RUBBER = Material(density=1000.0, youngs_modulus=1e7, poissons_ratio=0.4)
CALM = {"viscosity_linear": 0.0, "viscosity_quadratic": 0.0}


def strip(**settings):
    """A strip in plane strain."""
    body = Body(lowest=(0.0, 0.0, 0.0), highest=(LONG * DX, 1.0, WIDE * DX), material=RUBBER)
    settings = CALM | {"total_lagrangian": True} | settings
    return SphSolid(SphSolidParams(spacing=DX, dimensions=2, bodies=(body,), **settings))


def run(solid, time):
    while solid.state.time < time:
        solid.step(min(solid.stable_dt(), time - solid.state.time + 1e-15))
    return solid


def stretch(solid, speed):
    """Set velocities that pull both ends apart at a speed [m/s]."""
    x = solid.state.position[:, 0]
    solid.state.velocity[:, 0] = speed * math.pi * np.sin(math.pi * (x / (LONG * DX) - 0.5)) / 2.0
    return solid


@pytest.mark.parametrize("dimensions", [2, 3])
def test_gradients_of_linear_motion_are_exact_in_deformed_bodies(dimensions):
    edge = 5 * DX
    body = Body(lowest=(0.0, 0.0, 0.0), highest=(edge, edge, edge), material=RUBBER)
    params = SphSolidParams(
        spacing=DX, dimensions=dimensions, bodies=(body,), total_lagrangian=True
    )
    solid, random = SphSolid(params), np.random.default_rng(3)
    deformation = np.eye(3) + 0.3 * random.uniform(-1.0, 1.0, (3, 3))
    rate = random.uniform(-1.0, 1.0, (3, 3))
    if dimensions == 2:
        deformation[1], deformation[:, 1], rate[1], rate[:, 1] = (0, 1, 0), (0, 1, 0), 0.0, 0.0
    count = solid.state.particles
    solid.rows.place[:count, :3] = solid.state.position @ deformation.T
    solid.rows.motion[:count, :3] = solid.rows.place[:count, :3] @ rate.T
    solid.sums.write_gradients(solid.rows, solid.law)
    assert solid.rows.gradient == pytest.approx(np.tile(rate.ravel(), (count, 1)), abs=1e-12)


def length(solid):
    """Stretch of the whole strip."""
    return np.ptp(solid.state.position[:, 0]) / ((LONG - 1) * DX) - 1.0


def test_a_strip_that_is_stretched_comes_back_unless_its_particles_form_clumps():
    slow = {"courant": 0.25, "viscosity_linear": 0.2, "viscosity_quadratic": 0.4}
    plain = stretch(strip(total_lagrangian=False, **slow), 15.0)
    repelled = stretch(strip(total_lagrangian=False, artificial_stress=0.3, **slow), 15.0)
    lasting = stretch(strip(**slow), 15.0)
    for solid in (plain, repelled, lasting):
        assert length(run(solid, 1e-4)) > 0.12
    assert length(run(plain, 4e-4)) > 0.06
    assert length(run(repelled, 4e-4)) < -0.05
    assert length(run(lasting, 3.5e-4)) < -0.05


def test_energy_and_momentum_of_a_strip_that_is_stretched_by_a_third_are_kept():
    solid = stretch(strip(courant=0.25), 30.0)
    before, longest = solid.totals(), 0.0
    for n in range(1, 9):
        longest = max(longest, length(run(solid, n * 1e-4)))
    after = solid.totals()
    assert longest > 0.28
    start_energy = before.kinetic + before.internal
    assert after.kinetic + after.internal == pytest.approx(start_energy, rel=2e-3)
    momentum_scale = np.abs(solid.state.velocity).max() * after.mass
    assert np.abs(after.momentum).max() < 1e-12 * momentum_scale


def test_a_rotation_strains_nothing():
    solid = strip()
    x = solid.state.position - solid.state.position.mean(axis=0)
    rate = 200.0  # 1/s, 2.4 m/s at the ends: waves run 146 m/s
    solid.state.velocity[:, 0], solid.state.velocity[:, 2] = -rate * x[:, 2], rate * x[:, 0]
    before = solid.totals().kinetic
    run(solid, 0.5 / rate)
    after = solid.totals()
    assert after.kinetic == pytest.approx(before, rel=2e-3)
    assert abs(after.internal) < 1e-3 * before
    position = solid.state.position[np.argsort(solid.state.identity)]
    displacement = position[-1] - position[0] - (x[-1] - x[0])
    assert np.linalg.norm(displacement) == pytest.approx(
        2.0 * math.sin(0.25) * np.linalg.norm(x[-1] - x[0]), rel=0.02
    )


def test_half_a_strip_before_its_plane_moves_as_the_whole():
    whole = run(stretch(strip(), 3.0), 5e-5)
    plane = SymmetryPlane(axis="x", position=0.5 * LONG * DX)
    half = run(stretch(strip(symmetry=(plane,)), 3.0), 5e-5)
    whole_position = whole.state.position[np.argsort(whole.state.identity)]
    whole_position = whole_position[whole_position[:, 0] > 0.5 * LONG * DX]
    half_position = half.state.position[np.argsort(half.state.identity)]
    order = [
        np.lexsort((position[:, 2].round(9), position[:, 0].round(9)))
        for position in (whole_position, half_position)
    ]
    assert whole_position[order[0]] == pytest.approx(half_position[order[1]], abs=1e-9)


def test_a_resumed_run_has_the_same_bits():
    solid = run(stretch(strip(), 20.0), 3e-5)
    saved = solid.save()
    expected = run(solid, 6e-5).save()
    resumed = strip()
    resumed.load(saved)
    result = run(resumed, 6e-5).save()
    assert all(np.array_equal(expected[key], result[key]) for key in expected)


def test_what_does_not_go_with_it_is_refused():
    for settings in ({"kernel_correction": True}, {"artificial_stress": 0.3}):
        with pytest.raises(ValueError, match="total_lagrangian has corrected gradients"):
            strip(**settings)


def pair(gap=0.5, speed=4.0, **settings):
    """Two strips, one after the other along x, that fly at each other at a speed [m/s]."""
    middle, half = LONG * DX, (LONG + 0.5 * gap) * DX
    bodies = tuple(
        Body(
            lowest=(low, 0.0, 0.0), highest=(low + LONG * DX, 1.0, WIDE * DX), material=RUBBER,
            velocity=(direction * speed, 0.0, 0.0),
        )
        for low, direction in ((middle - half, 1.0), (middle + half - LONG * DX, -1.0))
    )  # fmt: skip
    return SphSolid(SphSolidParams(spacing=DX, dimensions=2, bodies=bodies, **settings))


def test_bodies_that_meet_push_each_other_off_and_exchange_their_momentum():
    """Equal bars exchange their velocities."""
    solid = pair()
    before = solid.totals()
    run(solid, 6e-4)
    after, left = solid.totals(), solid.state.body == 0
    assert -4.0 < solid.state.velocity[left, 0].mean() < -0.85 * 4.0
    assert solid.state.position[left, 0].max() < solid.state.position[~left, 0].min()
    start_energy = before.kinetic + before.internal
    assert after.kinetic + after.internal == pytest.approx(start_energy, rel=5e-3)
    assert np.abs(after.momentum).max() < 1e-12 * 4.0 * after.mass
    assert not solid.warnings()


def test_contact_of_shocked_bodies_gains_no_energy():
    flyer = Body(lowest=(0.0, 0.0, -25 * DX), highest=(3 * DX, 1.0, 0.0), material="aluminium",
                 velocity=(0.0, 0.0, 1000.0))  # fmt: skip
    target = Body(lowest=(0.0, 0.0, 0.0), highest=(3 * DX, 1.0, 75 * DX), material="aluminium")
    planes = SymmetryPlane(axis="x"), SymmetryPlane(axis="x", position=3 * DX, side="-")
    plates = SphSolid(
        SphSolidParams(
            spacing=DX, dimensions=2, bodies=(flyer, target), symmetry=planes, total_lagrangian=True
        )
    )
    for _ in range(100):
        plates.step(plates.stable_dt())
        assert not plates.warnings()


def test_a_body_that_meets_a_plane_moves_as_one_that_meets_its_image():
    whole = run(pair(gap=3.0), 1.2e-3)
    plane = SymmetryPlane(axis="x", position=LONG * DX, side="-")
    body = whole.params.bodies[0]
    params = SphSolidParams(spacing=DX, dimensions=2, bodies=(body,), symmetry=(plane,))
    half = run(SphSolid(params), 1.2e-3)
    velocity = whole.state.velocity[whole.state.body == 0, 0]
    assert half.state.velocity[:, 0].mean() == pytest.approx(velocity.mean(), rel=0.02)
    assert half.state.velocity[:, 0].mean() < -3.0


def test_a_resumed_contact_has_the_same_bits():
    solid, resumed = run(pair(), 4e-5), pair()
    resumed.load(solid.save())
    expected, result = run(solid, 1.2e-4).save(), run(resumed, 1.2e-4).save()
    assert all(np.array_equal(expected[key], result[key]) for key in expected)


def test_elastic_bodies_keep_the_neighbours_of_the_start_unless_told_otherwise():
    assert pair().lists.are_for_good and pair().law.linear == 0.0
    assert not pair(kernel_correction=True).lists.are_for_good
    assert not pair(artificial_stress=0.3).lists.are_for_good
    assert pair(kernel_correction=False).law.linear == 1.0
