"""Finite elements against exact solutions."""

import math

import numpy as np
import pytest
from scipy.sparse.linalg import LinearOperator, eigsh

from quintet.components.fe_plate.component import FePlate
from quintet.components.fe_plate.kernels.eight_points import write_point_volumes
from quintet.components.fe_plate.kernels.geometry import write_volumes
from quintet.components.fe_plate.meshes.selections import Faces, Fixed
from quintet.components.fe_plate.params import FePlateParams, Part, Pressure, RigidWall
from quintet.components.fe_plate.state import DEVIATOR, POINT_ROWS, PRESSURE, STRAIN
from quintet.components.shared.materials.params import JohnsonCook, Material
from quintet.interfaces.component import Resources
from quintet.interfaces.errors import StepError

E, NU, RHO = 7e10, 0.3, 2700.0
ELASTIC = Material(density=RHO, youngs_modulus=E, poissons_ratio=NU)
CALM = {"viscosity_linear": 0.0, "viscosity_quadratic": 0.0}
INTEGRATIONS = pytest.mark.parametrize("integration", ["reduced", "full"])


def block(size, elements, material=ELASTIC, **given):
    part = Part(lowest=(0.0, 0.0, 0.0), highest=size, elements=elements, material=material)
    return FePlate(FePlateParams(parts=(part,), **given))


def distort(made, amount):
    """Move the inner nodes of a structure at random, by a share of an edge [m], before it runs."""
    inner = np.ones(len(made.mesh.node), bool)
    inner[made.surface] = False
    random = np.random.default_rng(2)
    made.state.position[inner] += amount * random.uniform(-1.0, 1.0, (inner.sum(), 3))
    return inner


@INTEGRATIONS
@pytest.mark.parametrize("amount", [0.0, 0.25])
def test_patch_test(amount, integration):
    """A linear field of velocity stresses all elements alike and leaves inner nodes without force.

    Of a distorted mesh too: Flanagan & Belytschko's mean gradient is the exact one.
    """
    made = block((0.3, 0.3, 0.3), (3, 3, 3), integration=integration, **CALM)
    inner = distort(made, amount * 0.1)
    write = write_volumes if integration == "reduced" else write_point_volumes
    write(made.state.position, made.model.corner, 0.0, made.model.volume)
    assert made.model.volume[made.places.point].sum() == pytest.approx(0.027, rel=1e-12)
    gradient = np.array([[1.0, 2.0, 3.0], [0.0, 1.5, 0.0], [0.5, 0.0, -1.0]])  # 1/s
    made.state.velocity[:] = made.state.position @ gradient.T
    dt = 1e-6  # s
    made.step(dt)
    strain = 0.5 * dt * (gradient + gradient.T)
    shear, bulk = ELASTIC.shear, ELASTIC.bulk
    stress = 2.0 * shear * (strain - np.trace(strain) / 3.0 * np.eye(3))
    size = np.abs(stress).max()
    exact = stress[[0, 1, 2, 0, 1, 2], [0, 1, 2, 1, 2, 0]]
    points = made.state.points.transpose(1, 0, 2).reshape(POINT_ROWS, -1)
    deviator = points[DEVIATOR : DEVIATOR + 6, made.places.point.ravel()]
    assert np.abs(deviator - exact[:, None]).max() < 1e-5 * size
    assert np.abs(deviator - deviator[:, :1]).max() < 1e-9 * size
    assert made.places.of(made.state, PRESSURE) == pytest.approx(-bulk * np.trace(strain), rel=1e-5)
    assert np.abs(made.state.internal[inner]).max() < 1e-9 * size * 0.01  # of the force on a side


@INTEGRATIONS
def test_a_rotation_strains_nothing(integration):
    made = block((0.03, 0.02, 0.02), (3, 2, 2), integration=integration, **CALM)
    omega = np.array([200.0, -300.0, 150.0])  # rad/s
    middle = np.array([0.015, 0.01, 0.01])
    made.state.velocity[:] = np.cross(omega, made.state.position - middle)
    start = made.totals()
    for _ in range(2000):
        made.step(8e-7)
    turned = 2000 * 8e-7 * np.linalg.norm(omega)
    assert turned > 0.6  # rad
    end = made.totals()
    # What is left is what the spin stretches it by, ρ ω² l²; nothing of G times the angle.
    stretched = RHO * (omega @ omega) * 0.015**2
    assert np.abs(made.places.rows(made.state, DEVIATOR, 6)).max() < 1.5 * stretched
    np.testing.assert_allclose(end.angular_momentum, start.angular_momentum, rtol=1e-6)
    energy = end.kinetic + end.internal
    assert energy == pytest.approx(start.kinetic + start.internal, rel=1e-5)


@INTEGRATIONS
def test_a_force_gives_its_impulse_and_its_work(integration):
    made = block((0.03, 0.02, 0.02), (3, 2, 2), integration=integration, **CALM)
    force = np.random.default_rng(1).normal(size=(len(made.surface), 3)) * 1e3  # N
    made.take({"node_load.force": force})
    for _ in range(300):
        made.step(5e-7)
    found = made.totals()
    np.testing.assert_allclose(found.momentum, 1.5e-4 * force.sum(axis=0), rtol=1e-12)
    work = made.state.load_work.sum()
    assert found.kinetic + found.internal == pytest.approx(work, rel=2e-3)


def test_the_works_of_a_pressure_and_of_damping_are_counted():
    """What was done on it, less what damping took, is all the energy that it has."""
    size = (0.03, 0.02, 0.02)
    made = block(
        size,
        (6, 4, 4),
        fixed=(Fixed(lowest=(0.0, 0.0, 0.0), highest=(0.0, 0.02, 0.02)),),
        pressures=(Pressure(faces=Faces(lowest=(0.03, 0.0, 0.0), highest=size), pressure=1e7),),
        mass_damping=2e4,
        **CALM,
    )
    largest = 0.0
    for _ in range(500):
        made.step(made.stable_dt())
        found = made.totals()
        energy = found.kinetic + found.internal
        largest = max(largest, energy)
        damped = made.state.load_work.sum() - found.work
    assert energy == pytest.approx(found.work, abs=0.01 * largest)
    assert damped > 0.2 * largest


@pytest.mark.parametrize("damping", ["none", "mass_damping", "stiffness_damping"])
def test_damping_slows_a_vibration_as_it_should(damping):
    """Of the first mode of a free bar: exp(-α t/4), exp(-β ω² t/2)."""
    soft = Material(density=RHO, youngs_modulus=E, poissons_ratio=0.0)
    omega = math.pi / 0.04 * math.sqrt(E / RHO)
    periods, wanted = 3, 0.5
    time = periods * 2.0 * math.pi / omega
    values = {"mass_damping": 4.0 / time, "stiffness_damping": 2.0 / (omega**2 * time)}
    given = {} if damping == "none" else {damping: -math.log(wanted) * values[damping]}
    made = block((0.04, 0.01, 0.01), (8, 1, 1), soft, **given, **CALM)
    mode = np.cos(math.pi * made.mesh.node[:, 0] / 0.04)
    made.state.velocity[:, 0] = mode
    steps = math.ceil(time / made.stable_dt())
    for _ in range(steps):
        made.step(time / steps)
    share = made.state.velocity[:, 0] @ mode / (mode @ mode)
    assert share == pytest.approx(1.0 if damping == "none" else wanted, rel=0.02)


@INTEGRATIONS
def test_energy_is_kept_at_second_order(integration):
    drifts = []
    for dt in (6e-7, 3e-7):
        made = block((0.04, 0.02, 0.02), (4, 2, 2), integration=integration, **CALM)
        made.state.velocity[:, 0] = 10.0 * np.sin(math.pi * made.state.position[:, 0] / 0.04)
        start = made.totals().kinetic
        for _ in range(round(6e-5 / dt)):
            made.step(dt)
        end = made.totals()
        drifts.append(abs(end.kinetic + end.internal - start) / start)
    assert drifts[0] < 0.02 and drifts[0] / drifts[1] > 3.0


def greatest_frequency(made):
    """ω [rad/s] of this very mesh, from its own forces on small displacements."""
    still = made.state.position.copy()
    free, root = made.model.free.ravel(), np.repeat(np.sqrt(made.model.inverse_mass), 3)
    state = made.save()
    dt = 1e-9

    def stiffness(u):
        made.load(state)
        made.state.velocity[:] = (root * u.ravel() * free).reshape(-1, 3) / dt * 1e-6
        made.state.internal[:] = 0.0
        made.step(dt)
        force = -made.state.internal.ravel() * 1e6
        return free * root * force

    size = still.size
    operator = LinearOperator((size, size), matvec=stiffness, dtype=float)
    found = eigsh(operator, 1, which="LA", return_eigenvectors=False, tol=1e-6)
    made.load(state)
    return math.sqrt(found[0])


@INTEGRATIONS
@pytest.mark.parametrize("size", [(0.03, 0.03, 0.03), (0.09, 0.03, 0.01)])
@pytest.mark.parametrize(("share", "grows"), [(0.98, False), (1.05, True)])
def test_the_step_is_stable_below_twice_over_the_greatest_frequency(
    size, share, grows, integration
):
    made = block(size, (3, 3, 3), integration=integration, **CALM)
    dt = 2.0 / greatest_frequency(made)
    assert 0.4 < made.stable_dt() / 0.9 / dt <= 1.0  # the proven bound is below it
    made.state.velocity[:] = 1e-6 * np.random.default_rng(1).normal(size=(64, 3))
    start = np.abs(made.state.velocity).max()
    largest = 0.0
    try:
        for _ in range(300):
            made.step(share * dt)
            largest = np.abs(made.state.velocity).max()
    except StepError:  # it has turned elements inside out
        largest = math.inf
    assert (largest > 1e3 * start) == grows and (grows or largest < 10.0 * start)


@INTEGRATIONS
def test_patterns_without_strain_are_held(integration):
    """Modes that one quadrature point does not see swing, and do not grow."""
    node = block((0.01, 0.01, 0.01), (1, 1, 1)).mesh.node
    x, y, z = (2.0 * node / 0.01 - 1.0).T
    for pattern in (x * y, y * z, z * x, x * y * z):
        made = block((0.01, 0.01, 0.01), (1, 1, 1), integration=integration, **CALM)
        made.state.velocity[:, 0] = 0.01 * pattern
        largest = 0.0
        for _ in range(400):
            made.step(4e-7)
            moved = np.abs(made.state.position - made.mesh.node).max()
            largest = max(largest, moved)
        assert largest < 0.01 * 400 * 4e-7 / 10.0
        assert np.abs(made.state.velocity).max() < 0.0101


def test_a_bar_under_pressure_rings_about_its_static_length():
    """u = p L/E; a wave up and down the bar takes 4L/√(E/ρ)."""
    length, pressure = 0.1, 1e6
    ends = Faces(lowest=(length, 0.0, 0.0), highest=(length, 0.01, 0.01))
    made = block(
        (length, 0.01, 0.01),
        (20, 2, 2),
        fixed=(Fixed(lowest=(0.0, 0.0, 0.0), highest=(0.0, 0.01, 0.01), directions=("x",)),),
        pressures=(Pressure(faces=ends, pressure=-pressure),),
        **CALM,
    )
    period = 4.0 * length / math.sqrt(E / RHO)
    dt = made.stable_dt()
    steps = round(4.0 * period / dt)
    end = np.flatnonzero(made.mesh.node[:, 0] == length)
    moved = np.empty(steps)
    for k in range(steps):
        made.step(dt)
        moved[k] = made.state.position[end, 0].mean() - length
    assert moved.mean() == pytest.approx(pressure * length / E, rel=0.02)
    crossings = np.flatnonzero(np.diff(np.sign(moved - moved.mean())) > 0) * dt
    assert np.diff(crossings).mean() == pytest.approx(period, rel=0.01)


def test_a_rigid_wall_is_not_passed_and_takes_the_momentum():
    soft = Material(density=1000.0, youngs_modulus=1e7, poissons_ratio=0.3)
    part = Part(
        lowest=(0.0, 0.0, 0.001),
        highest=(0.01, 0.01, 0.021),
        elements=(2, 2, 4),
        material=soft,
        velocity=(0.0, 0.0, -5.0),
    )
    wall = RigidWall(point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 2.0))
    made = FePlate(FePlateParams(parts=(part,), rigid_walls=(wall,)))
    start = made.totals().momentum[2]
    for _ in range(400):
        made.step(made.stable_dt())
        assert made.state.position[:, 2].min() > -1e-12
    end = made.totals().momentum[2]
    assert end > 0.5 * abs(start)  # it has sprung back
    assert made.state.wall_impulse.sum() == pytest.approx(end - start, rel=1e-9)


def test_elements_erode_at_their_failure_strain_and_their_mass_stays():
    brittle = Material(
        density=RHO,
        youngs_modulus=E,
        poissons_ratio=NU,
        johnson_cook=JohnsonCook(a=1e8),
        failure_strain=0.05,
    )
    held = Fixed(lowest=(0.0, 0.0, 0.0), highest=(0.0, 0.01, 0.01))
    made = block((0.05, 0.01, 0.01), (10, 2, 2), brittle, fixed=(held,))
    made.state.velocity[made.mesh.node[:, 0] > 0.026] = (80.0, 0.0, 0.0)
    mass = made.totals().mass
    for _ in range(600):
        made.step(made.stable_dt())
    gone = made.places.active(made.state) == 0.0
    strain = made.places.of(made.state, STRAIN)
    assert 0 < gone.sum() < 20 and (strain[~gone] < 0.05).all()
    assert made.totals().mass == mass
    faces = made.give(frozenset({"face_activity.active"}))["face_activity.active"]
    assert 0.0 < faces.mean() < 1.0
    assert len(made.view()["cells"]) > 0


def test_an_element_that_is_turned_inside_out_is_named():
    made = block((0.01, 0.01, 0.01), (2, 2, 2), **CALM)
    made.state.velocity[13] = (0.0, 0.0, 1e6)
    with pytest.raises(
        StepError, match=r"element \d+, at .* it has -?[\d.e-]+ of that .* inside out"
    ):
        for _ in range(50):
            made.step(1e-9)


def test_mass_that_is_added_to_nodes_slows_them():
    made = block((0.01, 0.01, 0.01), (1, 1, 1))
    mass = made.built.mass[0]
    made.bind({"node_load.added_mass": np.full(8, mass)}, frozenset({"node_load"}))
    made.take({"node_load.force": np.full((8, 3), 2.0)})
    made.step(1e-7)
    np.testing.assert_allclose(made.state.velocity, 1e-7 * 2.0 / (2.0 * mass), rtol=1e-9)
    assert made.totals().mass == pytest.approx(2e-6 * RHO)


@INTEGRATIONS
def test_threads_change_no_bit(integration):
    part = Part(
        lowest=(0.0, 0.0, 0.0), highest=(0.01, 0.01, 0.03), elements=(12, 12, 36), material="steel"
    )
    wall = RigidWall(point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0))
    params = FePlateParams(parts=(part,), rigid_walls=(wall,), integration=integration)
    ends = []
    for threads in (1, 2):
        made = FePlate(params, Resources(threads=threads))
        made.state.velocity[:, 2] = -300.0
        for _ in range(20):
            made.step(made.stable_dt())
        ends.append(made.save())
    for key, array in ends[0].items():
        np.testing.assert_array_equal(array, ends[1][key], err_msg=key)
