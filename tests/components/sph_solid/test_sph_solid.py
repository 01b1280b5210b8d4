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


def box(size, material=ELASTIC, at=(0, 0, 0), velocity=(0.0, 0.0, 0.0)):
    low = tuple(DX * a for a in at)
    high = tuple(DX * (a + n) for a, n in zip(at, size, strict=True))
    return Body(lowest=low, highest=high, material=material, velocity=velocity)


def block(size, material=ELASTIC, **given):
    return SphSolid(SphSolidParams(spacing=DX, bodies=(box(size, material),), **given))


def strike(**given):
    """Two blocks, of steel and aluminium, that strike each other askew."""
    bodies = (
        box((5, 5, 5), "steel"),
        box((4, 4, 4), "aluminium", (5, 1, 0), (-300.0, 0.0, 20.0)),
    )
    return SphSolid(SphSolidParams(spacing=DX, bodies=bodies, **given))


def energy(made):
    found = made.totals()
    return found.kinetic + found.internal


def ordered(made, name):
    """Values of particles in the order of their birth."""
    return getattr(made.state, name)[np.argsort(made.state.identity)]


@pytest.mark.parametrize("dimensions", [2, 3])
def test_corrected_gradients_of_linear_fields_are_exact(dimensions):
    """At particles out of place, and at the surface: all but edges with too few neighbours."""
    made = block((9, 9, 9), kernel_correction=True, dimensions=dimensions, **CALM)
    random = np.random.default_rng(1)
    plane = np.array([1.0, dimensions == 3, 1.0])
    made.state.position += 0.1 * DX * plane * random.uniform(-1, 1, made.state.position.shape)
    made.state.reach = 0.0  # lists are made again
    gradient = np.array([[1.0, 2.0, 3.0], [0.0, 1.5, 0.0], [0.5, 0.0, -1.0]])  # 1/s
    gradient = gradient * plane * plane[:, None]
    made.state.velocity[:] = made.state.position @ gradient.T
    dt = 1e-9
    made.step(dt)
    strain = 0.5 * dt * (gradient + gradient.T)
    exact = 2.0 * ELASTIC.shear * (strain - np.trace(strain) / 3.0 * np.eye(3))
    exact = exact[[0, 1, 2, 0, 1, 2], [0, 1, 2, 1, 2, 0]]
    corrected = made.rows.correction[:, 0] != 0.0
    assert corrected.mean() > 0.85
    assert np.abs(made.state.deviator[corrected] - exact).max() < 1e-6 * np.abs(exact).max()
    pressure = -ELASTIC.bulk * np.trace(strain)
    assert made.state.pressure[corrected] == pytest.approx(pressure, rel=1e-6)


def test_momentum_is_kept_to_rounding():
    made = strike()
    start = made.totals()
    for _ in range(60):
        made.step(made.stable_dt())
    end = made.totals()
    size = 300.0 * start.mass
    assert np.abs(end.momentum - start.momentum).max() < 1e-14 * size
    assert end.kinetic < 0.7 * start.kinetic  # they did strike


@pytest.mark.parametrize(("given", "gain"), [({}, 3.0), ({"kernel_correction": True}, 1.5)])
def test_energy_of_a_strike_is_kept_at_second_order(given, gain):
    """With corrected gradients at first order: corrections are those of the step's middle."""
    drifts = []
    for courant in (0.3, 0.15):
        made = strike(courant=courant, **given)
        start = energy(made)
        while made.state.time < 8e-7:
            made.step(made.stable_dt())
        drifts.append(abs(energy(made) / start - 1.0))
    assert drifts[0] < 2e-3 and drifts[0] > gain * drifts[1]


def test_energy_of_waves_is_kept_at_second_order():
    drifts = []
    for dt in (8e-8, 4e-8):
        made = block((8, 4, 4), kernel_correction=False, **CALM)
        made.state.velocity[:, 0] = 10.0 * np.sin(math.pi * made.state.position[:, 0] / (8 * DX))
        start = energy(made)
        for _ in range(round(8e-6 / dt)):
            made.step(dt)
        drifts.append(abs(energy(made) / start - 1.0))
    assert drifts[0] < 5e-3 and drifts[0] > 3.0 * drifts[1]


def test_a_rotation_strains_nothing():
    body = Body(shape="cylinder", base=(0, -0.5, 0), top=(0, 0.5, 0), radius=6 * DX,
                material=ELASTIC)  # fmt: skip
    made = SphSolid(
        SphSolidParams(spacing=DX, bodies=(body,), dimensions=2, kernel_correction=True, **CALM)
    )
    omega = 4000.0  # rad/s
    x, _, z = made.state.position.T
    made.state.velocity[:, 0], made.state.velocity[:, 2] = omega * z, -omega * x
    start = made.totals()
    for _ in range(1000):
        made.step(8e-8)
    assert 1000 * 8e-8 * omega > 0.3  # rad
    # What is left is what the spin stretches it by, ρ ω² R²; nothing of G times the angle.
    assert von_mises(made.state.deviator).max() < 1.5 * RHO * omega**2 * (6 * DX) ** 2
    turned, before = made.totals().angular_momentum[1], start.angular_momentum[1]
    assert turned == pytest.approx(before, rel=1e-3)


def test_a_stressed_body_that_turns_keeps_its_stress():
    """Jaumann's rate turns the deviator with the body: its equivalent stays."""
    made = block((5, 5, 5), kernel_correction=True, **CALM)
    before = np.array([2e6, -1e6, -1e6, 5e5, 0.0, 3e5])
    made.state.deviator[:] = before
    middle = made.state.position.mean(axis=0)
    omega = np.array([0.0, 0.0, 1e6])  # rad/s: it turns much before it springs back
    made.state.velocity[:] = np.cross(omega, made.state.position - middle)
    dt, inner = 1e-8, np.linalg.norm(made.state.position - middle, axis=1) < 1.1 * DX
    chosen = made.state.identity[inner]
    made.state.acceleration[:] = np.cross(omega, made.state.velocity)
    made.step(dt)
    turned = ordered(made, "deviator")[chosen]
    angle = dt * omega[2]
    turn = np.array([[1.0, -angle, 0.0], [angle, 1.0, 0.0], [0.0, 0.0, 1.0]])
    xx, yy, zz, xy, yz, zx = before
    tensor = np.array([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]])
    exact = (turn @ tensor @ turn.T)[[0, 1, 2, 0, 1, 2], [0, 1, 2, 1, 2, 0]]
    np.testing.assert_allclose(turned[0], exact, atol=3.0 * angle**2 * 2e6 + 1e4)


def test_waves_run_along_a_bar_at_their_speed():
    """Free at both ends, in plane strain, its first mode has the period 2L/√(E/(1 - ν²)ρ)."""
    count = 48
    made = block((count, 1, 6), kernel_correction=True, dimensions=2, **CALM)
    length = count * DX
    shape = np.cos(math.pi * made.state.position[:, 0] / length)[np.argsort(made.state.identity)]
    made.state.velocity[:, 0] = 1.0 * np.cos(math.pi * made.state.position[:, 0] / length)
    period = 2.0 * length / math.sqrt(E / (1.0 - NU**2) / RHO)
    dt, moved = made.stable_dt(), []
    for _ in range(round(1.6 * period / dt)):
        made.step(dt)
        moved.append(ordered(made, "velocity")[:, 0] @ shape)
    signs = np.sign(moved)
    crossings = np.flatnonzero(signs[:-1] != signs[1:]) * dt
    assert 2.0 * np.diff(crossings).mean() == pytest.approx(period, rel=0.02)


def greatest_frequency(made):
    """ω [rad/s] of these very particles, from their own forces on small displacements."""
    state, dt = made.save(), 1e-9
    size = made.state.position.size

    def stiffness(u):
        made.load(state)
        made.state.velocity[:] = u.reshape(-1, 3) / dt * 1e-9
        made.state.acceleration[:] = 0.0
        made.step(dt)
        return -made.state.acceleration.ravel() * 1e9

    operator = LinearOperator((size, size), matvec=stiffness, dtype=float)
    found = eigsh(operator, 1, which="LA", return_eigenvectors=False, tol=1e-4)
    made.load(state)
    return math.sqrt(found[0])


@pytest.mark.parametrize(("share", "grows"), [(0.98, False), (1.05, True)])
def test_the_step_is_stable_below_twice_over_the_greatest_frequency(share, grows):
    made = block((6, 5, 5), **CALM)
    dt = 2.0 / greatest_frequency(made)
    told = made.state.bound / dt
    assert 0.5 * told < 0.8  # with the courant number that is given if none is said
    random = np.random.default_rng(1)
    made.state.velocity[:] = 1e-6 * random.normal(size=made.state.position.shape)
    start = np.abs(made.state.velocity).max()
    try:
        for _ in range(400):
            made.step(share * dt)
            largest = np.abs(made.state.velocity).max()
            if largest > 1e4 * start:
                break
    except StepError:  # they have flown apart
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
    one, other = whole.state.position[quarter], part.state.position
    keys = [np.lexsort(np.round(a / DX * 1e3).T) for a in (one, other)]
    np.testing.assert_allclose(one[keys[0]], other[keys[1]], atol=1e-9 * DX)
    assert 4.0 * energy(part) == pytest.approx(energy(whole), rel=1e-12)


def test_plane_strain_bears_stress_along_y():
    """Stretched along x and free along z, σ_yy = ν σ_xx, σ_xx = E ε/(1 - ν²)."""
    made = block((12, 1, 6), dimensions=2, kernel_correction=True, viscosity_linear=0.3)
    strain = 1e-4
    gradient = np.diag([strain, 0.0, -NU / (1.0 - NU) * strain]) / 1e-7
    made.state.velocity[:] = made.state.position @ gradient.T
    made.step(1e-7)
    stress = made.state.deviator[:, :3] - made.state.pressure[:, None]
    stress = stress[made.rows.correction[:, 0] != 0.0]  # all but corners
    assert stress[:, 0] == pytest.approx(E * strain / (1.0 - NU**2), rel=1e-3)
    assert stress[:, 1] == pytest.approx(NU * E * strain / (1.0 - NU**2), rel=1e-3)
    assert np.abs(stress[:, 2]).max() < 1e-3 * E * strain


def test_what_has_failed_bears_no_tension_and_no_shear_for_good():
    brittle = Material(density=RHO, youngs_modulus=E, poissons_ratio=NU, spall_stress=1e8)
    made = SphSolid(SphSolidParams(spacing=DX, bodies=(box((8, 3, 3), brittle),), courant=0.2))
    middle = made.state.position[:, 0].mean()
    made.state.velocity[:, 0] = np.sign(made.state.position[:, 0] - middle) * 60.0
    for _ in range(30):
        made.step(made.stable_dt())
    failed = set(made.state.identity[made.state.failed > 0.0])
    assert 0 < len(failed) < len(made.state.failed)
    made.state.velocity[:, 0] *= -2.0  # and is pushed together again
    for _ in range(60):
        made.step(made.stable_dt())
        torn = made.state.failed > 0.0
        assert failed <= set(made.state.identity[torn])
        assert (made.state.deviator[torn] == 0.0).all() and (made.state.pressure[torn] >= 0.0).all()
    assert made.state.pressure[torn].max() > 0.0


def test_glued_particles_move_as_told_and_say_what_they_bear():
    layer = Region(lowest=(0.0, 0.0, 0.0), highest=(DX, 4 * DX, 4 * DX))
    made = block((6, 4, 4), "steel", glued=(layer,))
    made.bind({}, frozenset({"glued", "glued_load"}))
    count = len(made.state.active)
    assert count == 16
    told = {"glued.velocity": np.tile([30.0, 0.0, 0.0], (count, 1))}
    start = made.describe()["glued_load.position"]
    impulse, dt = np.zeros(3), made.stable_dt()
    forces = [made.state.force.sum(axis=0)]
    for _ in range(25):
        made.take(told)
        made.step(dt)
        given = made.give(frozenset({"glued_load.force"}))["glued_load.force"]
        forces.append(given.sum(axis=0))
        impulse += 0.5 * dt * (forces[-1] + forces[-2])
    moved = made.state.position[glued_rows(made.state)] - start
    np.testing.assert_allclose(moved, np.tile([25 * dt * 30.0, 0.0, 0.0], (count, 1)), atol=1e-15)
    # What the mesh gets the free particles lose.
    np.testing.assert_allclose(made.totals().momentum, -impulse, atol=1e-12 * abs(impulse[0]))
    assert made.totals().mass == pytest.approx(made.materials.mass(made.state).sum() * 5.0 / 6.0)
    made.take({**told, "glue_activity.active": (np.arange(count) > 3).astype(float)})
    made.step(dt)
    given = made.give(frozenset({"glued_load.force"}))["glued_load.force"]
    assert not given[:4].any() and given[4:].any()
    assert made.totals().mass == pytest.approx(made.materials.mass(made.state).sum() * 84.0 / 96.0)


def test_fixed_particles_keep_their_places():
    held = Fixed(lowest=(0.0, 0.0, 0.0), highest=(DX, 1.0, 1.0), directions=("x", "z"))
    made = block((6, 3, 3), fixed=(held,))
    made.state.velocity[made.state.fixed == 0] = (50.0, 0.0, 10.0)
    rows = made.state.identity[made.state.fixed > 0]
    before = ordered(made, "position")[rows]
    for _ in range(50):
        made.step(made.stable_dt())
    after = ordered(made, "position")[rows]
    np.testing.assert_array_equal(after[:, [0, 2]], before[:, [0, 2]])
    assert np.abs(after[:, 1] - before[:, 1]).max() > 0.0


def test_a_resumed_run_has_the_same_bits():
    one, other = (strike(kernel_correction=True, symmetry=(SymmetryPlane(axis="z"),)) for _ in "ab")
    for _ in range(13):
        one.step(one.stable_dt())
    other.load(one.save())
    for _ in range(13):
        one.step(one.stable_dt())
        other.step(other.stable_dt())
    for key, array in one.save().items():
        np.testing.assert_array_equal(array, other.save()[key], err_msg=key)


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
        made = SphSolid(params, Resources(threads=threads))
        for _ in range(25):
            made.step(made.stable_dt())
        ends.append(made.save())
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
    made = SphSolid(params)
    start, momentum = energy(made), made.totals().momentum
    for _ in range(200):
        made.step(made.stable_dt())
    assert made.state.time > 1e-6 and made.state.failed.max() == 1.0
    assert energy(made) == pytest.approx(start, rel=0.03)
    np.testing.assert_allclose(made.totals().momentum, momentum, atol=1e-13 * abs(momentum[2]))
