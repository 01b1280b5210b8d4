"""Bodies of particles against exact solutions."""

import math

import numpy as np
import pytest
from scipy.sparse.linalg import LinearOperator, eigsh

from quintet.components.shared.materials.params import Material
from quintet.components.sph_solid.component import SphSolid
from quintet.components.sph_solid.glue import glued_rows
from quintet.components.sph_solid.params import (
    Body,
    Fixed,
    Region,
    SphSolidParams,
    SymmetryPlane,
)
from quintet.components.sph_solid.view import von_mises
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import StepError

E, NU, RHO = 7e10, 0.3, 2700.0
ELASTIC = Material(density=RHO, youngs_modulus=E, poissons_ratio=NU)
CALM = {"viscosity_linear": 0.0, "viscosity_quadratic": 0.0}
DX = 1e-3  # m


def box(size, material=ELASTIC, offset=(0, 0, 0), velocity=(0.0, 0.0, 0.0)):
    low = tuple(DX * a for a in offset)
    high = tuple(DX * (a + n) for a, n in zip(offset, size, strict=True))
    return Body(lowest=low, highest=high, material=material, velocity=velocity)


def block(size, material=ELASTIC, **settings):
    return SphSolid(SphSolidParams(spacing=DX, bodies=(box(size, material),), **settings))


def strike(**settings):
    """Two blocks, of steel and aluminium, that strike each other askew."""
    bodies = (
        box((5, 5, 5), "steel"),
        box((4, 4, 4), "aluminium", (5, 1, 0), (-300.0, 0.0, 20.0)),
    )
    return SphSolid(SphSolidParams(spacing=DX, bodies=bodies, **settings))


def energy(solid):
    totals = solid.totals()
    return totals.kinetic + totals.internal


def values_by_identity(solid, name):
    """Values of particles in the order of their identities."""
    return getattr(solid.state, name)[np.argsort(solid.state.identity)]


@pytest.mark.parametrize("dimensions", [2, 3])
def test_corrected_gradients_of_linear_fields_are_exact(dimensions):
    """At displaced particles and at the surface; edges with too few neighbours are left out."""
    solid = block((9, 9, 9), kernel_correction=True, dimensions=dimensions, **CALM)
    random = np.random.default_rng(1)
    plane = np.array([1.0, dimensions == 3, 1.0])
    solid.state.position += 0.1 * DX * plane * random.uniform(-1, 1, solid.state.position.shape)
    solid.state.reach = 0.0  # forces new lists
    gradient = np.array([[1.0, 2.0, 3.0], [0.0, 1.5, 0.0], [0.5, 0.0, -1.0]])  # 1/s
    gradient = gradient * plane * plane[:, None]
    solid.state.velocity[:] = solid.state.position @ gradient.T
    dt = 1e-9
    solid.step(dt)
    strain = 0.5 * dt * (gradient + gradient.T)
    exact = 2.0 * ELASTIC.shear * (strain - np.trace(strain) / 3.0 * np.eye(3))
    exact = exact[[0, 1, 2, 0, 1, 2], [0, 1, 2, 1, 2, 0]]
    corrected = solid.rows.correction[:, 0] != 0.0
    assert corrected.mean() > 0.85
    assert np.abs(solid.state.deviator[corrected] - exact).max() < 1e-6 * np.abs(exact).max()
    pressure = -ELASTIC.bulk * np.trace(strain)
    assert solid.state.pressure[corrected] == pytest.approx(pressure, rel=1e-6)


def test_momentum_is_kept_to_rounding():
    solid = strike()
    start = solid.totals()
    for _ in range(60):
        solid.step(solid.stable_dt())
    end = solid.totals()
    momentum_scale = 300.0 * start.mass
    assert np.abs(end.momentum - start.momentum).max() < 1e-14 * momentum_scale
    assert end.kinetic < 0.7 * start.kinetic  # they did strike


@pytest.mark.parametrize(("settings", "gain"), [({}, 3.0), ({"kernel_correction": True}, 1.5)])
def test_energy_of_a_strike_is_kept_at_second_order(settings, gain):
    """First order with corrected gradients, as the corrections are those of mid-step."""
    drifts = []
    for courant in (0.3, 0.15):
        solid = strike(courant=courant, **settings)
        start = energy(solid)
        while solid.state.time < 8e-7:
            solid.step(solid.stable_dt())
        drifts.append(abs(energy(solid) / start - 1.0))
    assert drifts[0] < 2e-3 and drifts[0] > gain * drifts[1]


def test_energy_of_waves_is_kept_at_second_order():
    drifts = []
    for dt in (8e-8, 4e-8):
        solid = block((8, 4, 4), kernel_correction=False, **CALM)
        solid.state.velocity[:, 0] = 10.0 * np.sin(math.pi * solid.state.position[:, 0] / (8 * DX))
        start = energy(solid)
        for _ in range(round(8e-6 / dt)):
            solid.step(dt)
        drifts.append(abs(energy(solid) / start - 1.0))
    assert drifts[0] < 5e-3 and drifts[0] > 3.0 * drifts[1]


def test_a_rotation_strains_nothing():
    body = Body(shape="cylinder", base=(0, -0.5, 0), top=(0, 0.5, 0), radius=6 * DX,
                material=ELASTIC)  # fmt: skip
    solid = SphSolid(
        SphSolidParams(spacing=DX, bodies=(body,), dimensions=2, kernel_correction=True, **CALM)
    )
    omega = 4000.0  # rad/s
    x, _, z = solid.state.position.T
    solid.state.velocity[:, 0], solid.state.velocity[:, 2] = omega * z, -omega * x
    start = solid.totals()
    for _ in range(1000):
        solid.step(8e-8)
    assert 1000 * 8e-8 * omega > 0.3  # rad
    # The centrifugal stress, ρ ω² R², remains; no stress of G times the angle arises.
    assert von_mises(solid.state.deviator).max() < 1.5 * RHO * omega**2 * (6 * DX) ** 2
    spin, start_spin = solid.totals().angular_momentum[1], start.angular_momentum[1]
    assert spin == pytest.approx(start_spin, rel=1e-3)


def test_a_stressed_body_that_turns_keeps_its_stress():
    """Jaumann's rate turns the deviator with the body."""
    solid = block((5, 5, 5), kernel_correction=True, **CALM)
    before = np.array([2e6, -1e6, -1e6, 5e5, 0.0, 3e5])
    solid.state.deviator[:] = before
    middle = solid.state.position.mean(axis=0)
    omega = np.array([0.0, 0.0, 1e6])  # rad/s, fast compared with the elastic recovery
    solid.state.velocity[:] = np.cross(omega, solid.state.position - middle)
    dt, inner = 1e-8, np.linalg.norm(solid.state.position - middle, axis=1) < 1.1 * DX
    identities = solid.state.identity[inner]
    solid.state.acceleration[:] = np.cross(omega, solid.state.velocity)
    solid.step(dt)
    deviator = values_by_identity(solid, "deviator")[identities]
    angle = dt * omega[2]
    turn = np.array([[1.0, -angle, 0.0], [angle, 1.0, 0.0], [0.0, 0.0, 1.0]])
    xx, yy, zz, xy, yz, zx = before
    tensor = np.array([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]])
    exact = (turn @ tensor @ turn.T)[[0, 1, 2, 0, 1, 2], [0, 1, 2, 1, 2, 0]]
    np.testing.assert_allclose(deviator[0], exact, atol=3.0 * angle**2 * 2e6 + 1e4)


def test_waves_run_along_a_bar_at_their_speed():
    """Free at both ends, in plane strain, its first mode has the period 2L/√(E/(1 - ν²)ρ)."""
    count = 48
    solid = block((count, 1, 6), kernel_correction=True, dimensions=2, **CALM)
    length = count * DX
    shape = np.cos(math.pi * solid.state.position[:, 0] / length)[np.argsort(solid.state.identity)]
    solid.state.velocity[:, 0] = 1.0 * np.cos(math.pi * solid.state.position[:, 0] / length)
    period = 2.0 * length / math.sqrt(E / (1.0 - NU**2) / RHO)
    dt, amplitudes = solid.stable_dt(), []
    for _ in range(round(1.6 * period / dt)):
        solid.step(dt)
        amplitudes.append(values_by_identity(solid, "velocity")[:, 0] @ shape)
    signs = np.sign(amplitudes)
    crossings = np.flatnonzero(signs[:-1] != signs[1:]) * dt
    assert 2.0 * np.diff(crossings).mean() == pytest.approx(period, rel=0.02)


def greatest_frequency(solid):
    """Highest ω [rad/s] of the particles, from their forces under small displacements."""
    state, dt = solid.save(), 1e-9
    size = solid.state.position.size

    def stiffness(u):
        solid.load(state)
        solid.state.velocity[:] = u.reshape(-1, 3) / dt * 1e-9
        solid.state.acceleration[:] = 0.0
        solid.step(dt)
        return -solid.state.acceleration.ravel() * 1e9

    operator = LinearOperator((size, size), matvec=stiffness, dtype=float)
    eigenvalues = eigsh(operator, 1, which="LA", return_eigenvectors=False, tol=1e-4)
    solid.load(state)
    return math.sqrt(eigenvalues[0])


@pytest.mark.parametrize(("share", "grows"), [(0.98, False), (1.05, True)])
def test_the_step_is_stable_below_twice_over_the_greatest_frequency(share, grows):
    solid = block((6, 5, 5), **CALM)
    dt = 2.0 / greatest_frequency(solid)
    ratio = solid.state.bound / dt
    assert 0.5 * ratio < 0.8  # with the default courant number
    random = np.random.default_rng(1)
    solid.state.velocity[:] = 1e-6 * random.normal(size=solid.state.position.shape)
    start = np.abs(solid.state.velocity).max()
    try:
        for _ in range(400):
            solid.step(share * dt)
            largest = np.abs(solid.state.velocity).max()
            if largest > 1e4 * start:
                break
    except StepError:  # the particles have flown apart
        largest = math.inf
    assert (largest > 1e3 * start) == grows and (grows or largest < 10.0 * start)


def test_half_a_body_before_its_plane_moves_as_the_whole():
    whole = SphSolid(
        SphSolidParams(
            spacing=DX,
            bodies=(
                Body(lowest=(-4e-3, -3e-3, 0.0), highest=(4e-3, 3e-3, 3e-3), material="steel"),
                Body(
                    shape="sphere",
                    centre=(0.0, 0.0, 5e-3),
                    radius=2e-3,
                    material="aluminium",
                    velocity=(0.0, 0.0, -900.0),
                ),
            ),
        )
    )
    planes = (SymmetryPlane(axis="x"), SymmetryPlane(axis="y", side="-"))
    part = SphSolid(SphSolidParams(spacing=DX, bodies=whole.params.bodies, symmetry=planes))
    assert 4 * part.items() == whole.items()
    for _ in range(40):
        dt = min(whole.stable_dt(), part.stable_dt())
        whole.step(dt)
        part.step(dt)
    quarter = (whole.state.position[:, 0] > 0.0) & (whole.state.position[:, 1] < 0.0)
    quarter_position, part_position = whole.state.position[quarter], part.state.position
    orders = [
        np.lexsort(np.round(position / DX * 1e3).T)
        for position in (quarter_position, part_position)
    ]
    np.testing.assert_allclose(
        quarter_position[orders[0]], part_position[orders[1]], atol=1e-9 * DX
    )
    assert 4.0 * energy(part) == pytest.approx(energy(whole), rel=1e-12)


def test_plane_strain_bears_stress_along_y():
    """Stretched along x and free along z, σ_yy = ν σ_xx, σ_xx = E ε/(1 - ν²)."""
    solid = block((12, 1, 6), dimensions=2, kernel_correction=True, viscosity_linear=0.3)
    strain = 1e-4
    gradient = np.diag([strain, 0.0, -NU / (1.0 - NU) * strain]) / 1e-7
    solid.state.velocity[:] = solid.state.position @ gradient.T
    solid.step(1e-7)
    stress = solid.state.deviator[:, :3] - solid.state.pressure[:, None]
    stress = stress[solid.rows.correction[:, 0] != 0.0]  # all but corners
    assert stress[:, 0] == pytest.approx(E * strain / (1.0 - NU**2), rel=1e-3)
    assert stress[:, 1] == pytest.approx(NU * E * strain / (1.0 - NU**2), rel=1e-3)
    assert np.abs(stress[:, 2]).max() < 1e-3 * E * strain


def test_what_has_failed_bears_no_tension_and_no_shear_for_good():
    brittle = Material(density=RHO, youngs_modulus=E, poissons_ratio=NU, spall_stress=1e8)
    solid = SphSolid(SphSolidParams(spacing=DX, bodies=(box((8, 3, 3), brittle),), courant=0.2))
    middle = solid.state.position[:, 0].mean()
    solid.state.velocity[:, 0] = np.sign(solid.state.position[:, 0] - middle) * 60.0
    for _ in range(30):
        solid.step(solid.stable_dt())
    failed = set(solid.state.identity[solid.state.failed > 0.0])
    assert 0 < len(failed) < len(solid.state.failed)
    solid.state.velocity[:, 0] *= -2.0  # the halves are pushed together again
    for _ in range(60):
        solid.step(solid.stable_dt())
        failed_rows = solid.state.failed > 0.0
        assert failed <= set(solid.state.identity[failed_rows])
        assert (solid.state.deviator[failed_rows] == 0.0).all() and (
            solid.state.pressure[failed_rows] >= 0.0
        ).all()
    assert solid.state.pressure[failed_rows].max() > 0.0


def test_glued_particles_move_as_told_and_say_what_they_bear():
    layer = Region(lowest=(0.0, 0.0, 0.0), highest=(DX, 4 * DX, 4 * DX))
    solid = block((6, 4, 4), "steel", glued=(layer,))
    solid.bind({}, frozenset({"glued", "glued_load"}))
    count = len(solid.state.active)
    assert count == 16
    inputs = {"glued.velocity": np.tile([30.0, 0.0, 0.0], (count, 1))}
    start = solid.describe()["glued_load.position"]
    impulse, dt = np.zeros(3), solid.stable_dt()
    forces = [solid.state.force.sum(axis=0)]
    for _ in range(25):
        solid.take(inputs)
        solid.step(dt)
        load = solid.give(frozenset({"glued_load.force"}))["glued_load.force"]
        forces.append(load.sum(axis=0))
        impulse += 0.5 * dt * (forces[-1] + forces[-2])
    displacement = solid.state.position[glued_rows(solid.state)] - start
    np.testing.assert_allclose(
        displacement, np.tile([25 * dt * 30.0, 0.0, 0.0], (count, 1)), atol=1e-15
    )
    # The free particles lose the momentum that the mesh receives.
    np.testing.assert_allclose(solid.totals().momentum, -impulse, atol=1e-12 * abs(impulse[0]))
    assert solid.totals().mass == pytest.approx(solid.materials.mass(solid.state).sum() * 5.0 / 6.0)
    solid.take({**inputs, "glue_activity.active": (np.arange(count) > 3).astype(float)})
    solid.step(dt)
    load = solid.give(frozenset({"glued_load.force"}))["glued_load.force"]
    assert not load[:4].any() and load[4:].any()
    assert solid.totals().mass == pytest.approx(
        solid.materials.mass(solid.state).sum() * 84.0 / 96.0
    )


def test_fixed_particles_keep_their_places():
    clamp = Fixed(lowest=(0.0, 0.0, 0.0), highest=(DX, 1.0, 1.0), directions=("x", "z"))
    solid = block((6, 3, 3), fixed=(clamp,))
    solid.state.velocity[solid.state.fixed == 0] = (50.0, 0.0, 10.0)
    rows = solid.state.identity[solid.state.fixed > 0]
    before = values_by_identity(solid, "position")[rows]
    for _ in range(50):
        solid.step(solid.stable_dt())
    after = values_by_identity(solid, "position")[rows]
    np.testing.assert_array_equal(after[:, [0, 2]], before[:, [0, 2]])
    assert np.abs(after[:, 1] - before[:, 1]).max() > 0.0


def test_a_resumed_run_has_the_same_bits():
    original, resumed = (
        strike(kernel_correction=True, symmetry=(SymmetryPlane(axis="z"),)) for _ in "ab"
    )
    for _ in range(13):
        original.step(original.stable_dt())
    resumed.load(original.save())
    for _ in range(13):
        original.step(original.stable_dt())
        resumed.step(resumed.stable_dt())
    for key, array in original.save().items():
        np.testing.assert_array_equal(array, resumed.save()[key], err_msg=key)


def test_threads_change_no_bit():
    params = SphSolidParams(
        spacing=DX,
        bodies=(
            box((20, 20, 8), "aluminium"),
            box((6, 6, 6), "steel", (7, 7, 8), (0.0, 0.0, -2000.0)),
        ),
    )
    ends = []
    for threads in (1, 2):
        solid = SphSolid(params, Resources(threads=threads))
        for _ in range(25):
            solid.step(solid.stable_dt())
        ends.append(solid.save())
    for key, array in ends[0].items():
        np.testing.assert_array_equal(array, ends[1][key], err_msg=key)


def test_eight_particles_at_12_km_per_s_go_through_a_plate_of_one_layer():
    params = SphSolidParams(
        spacing=DX,
        bodies=(
            box((11, 11, 1), "aluminium"),
            box((2, 2, 2), "aluminium", (4, 4, 1), (0.0, 0.0, -12000.0)),
        ),
    )
    solid = SphSolid(params)
    start, momentum = energy(solid), solid.totals().momentum
    for _ in range(200):
        solid.step(solid.stable_dt())
    assert solid.state.time > 1e-6 and solid.state.failed.max() == 1.0
    assert energy(solid) == pytest.approx(start, rel=0.03)
    np.testing.assert_allclose(solid.totals().momentum, momentum, atol=1e-13 * abs(momentum[2]))
