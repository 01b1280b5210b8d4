"""Finite elements against exact solutions."""

import math

import numpy as np
import pytest

from quintet.components.fe_plate.analysis.longest_step import greatest_frequency
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


def block(size, elements, material=ELASTIC, **keys):
    part = Part(lowest=(0.0, 0.0, 0.0), highest=size, elements=elements, material=material)
    return FePlate(FePlateParams(parts=(part,), **keys))


def distort(structure, amount):
    """Move the inner nodes of a structure at random, by a share of an edge [m], before it runs."""
    inner = np.ones(len(structure.mesh.node), bool)
    inner[structure.surface] = False
    random = np.random.default_rng(2)
    structure.state.position[inner] += amount * random.uniform(-1.0, 1.0, (inner.sum(), 3))
    return inner


@INTEGRATIONS
@pytest.mark.parametrize("amount", [0.0, 0.25])
def test_patch_test(amount, integration):
    """A linear field of velocity stresses all elements alike and leaves inner nodes without force.

    Of a distorted mesh too: Flanagan & Belytschko's mean gradient is the exact one.
    """
    structure = block((0.3, 0.3, 0.3), (3, 3, 3), integration=integration, **CALM)
    inner = distort(structure, amount * 0.1)
    write = write_volumes if integration == "reduced" else write_point_volumes
    write(structure.state.position, structure.model.corner, 0.0, structure.model.volume)
    assert structure.model.volume[structure.places.point].sum() == pytest.approx(0.027, rel=1e-12)
    gradient = np.array([[1.0, 2.0, 3.0], [0.0, 1.5, 0.0], [0.5, 0.0, -1.0]])  # 1/s
    structure.state.velocity[:] = structure.state.position @ gradient.T
    dt = 1e-6  # s
    structure.step(dt)
    strain = 0.5 * dt * (gradient + gradient.T)
    shear, bulk = ELASTIC.shear, ELASTIC.bulk
    stress = 2.0 * shear * (strain - np.trace(strain) / 3.0 * np.eye(3))
    size = np.abs(stress).max()
    exact = stress[[0, 1, 2, 0, 1, 2], [0, 1, 2, 1, 2, 0]]
    points = structure.state.points.transpose(1, 0, 2).reshape(POINT_ROWS, -1)
    deviator = points[DEVIATOR : DEVIATOR + 6, structure.places.point.ravel()]
    assert np.abs(deviator - exact[:, None]).max() < 1e-5 * size
    assert np.abs(deviator - deviator[:, :1]).max() < 1e-9 * size
    assert structure.places.of(structure.state, PRESSURE) == pytest.approx(
        -bulk * np.trace(strain), rel=1e-5
    )
    # Of the force on a side.
    assert np.abs(structure.state.internal[inner]).max() < 1e-9 * size * 0.01


@INTEGRATIONS
def test_a_rotation_strains_nothing(integration):
    structure = block((0.03, 0.02, 0.02), (3, 2, 2), integration=integration, **CALM)
    omega = np.array([200.0, -300.0, 150.0])  # rad/s
    middle = np.array([0.015, 0.01, 0.01])
    structure.state.velocity[:] = np.cross(omega, structure.state.position - middle)
    start = structure.totals()
    for _ in range(2000):
        structure.step(8e-7)
    angle = 2000 * 8e-7 * np.linalg.norm(omega)
    assert angle > 0.6  # rad
    end = structure.totals()
    # The spin stretches it: the stress is about ρ ω² l², and not G times the angle.
    spin_stress = RHO * (omega @ omega) * 0.015**2
    assert np.abs(structure.places.rows(structure.state, DEVIATOR, 6)).max() < 1.5 * spin_stress
    np.testing.assert_allclose(end.angular_momentum, start.angular_momentum, rtol=1e-6)
    energy = end.kinetic + end.internal
    assert energy == pytest.approx(start.kinetic + start.internal, rel=1e-5)


@INTEGRATIONS
def test_a_force_gives_its_impulse_and_its_work(integration):
    structure = block((0.03, 0.02, 0.02), (3, 2, 2), integration=integration, **CALM)
    force = np.random.default_rng(1).normal(size=(len(structure.surface), 3)) * 1e3  # N
    structure.take({"node_load.force": force})
    for _ in range(300):
        structure.step(5e-7)
    totals = structure.totals()
    np.testing.assert_allclose(totals.momentum, 1.5e-4 * force.sum(axis=0), rtol=1e-12)
    work = structure.state.load_work.sum()
    assert totals.kinetic + totals.internal == pytest.approx(work, rel=2e-3)


def test_the_works_of_a_pressure_and_of_damping_are_counted():
    """Its energy is the work done on it, less the energy that damping took."""
    size = (0.03, 0.02, 0.02)
    structure = block(
        size,
        (6, 4, 4),
        fixed=(Fixed(lowest=(0.0, 0.0, 0.0), highest=(0.0, 0.02, 0.02)),),
        pressures=(Pressure(faces=Faces(lowest=(0.03, 0.0, 0.0), highest=size), pressure=1e7),),
        mass_damping=2e4,
        **CALM,
    )
    largest = 0.0
    for _ in range(500):
        structure.step(structure.stable_dt())
        totals = structure.totals()
        energy = totals.kinetic + totals.internal
        largest = max(largest, energy)
        dissipated = structure.state.load_work.sum() - totals.work
    assert energy == pytest.approx(totals.work, abs=0.01 * largest)
    assert dissipated > 0.2 * largest


@pytest.mark.parametrize("damping", ["none", "mass_damping", "stiffness_damping"])
def test_damping_slows_a_vibration_as_it_should(damping):
    """Of the first mode of a free bar: exp(-α t/4), exp(-β ω² t/2)."""
    soft = Material(density=RHO, youngs_modulus=E, poissons_ratio=0.0)
    omega = math.pi / 0.04 * math.sqrt(E / RHO)
    periods, expected = 3, 0.5
    time = periods * 2.0 * math.pi / omega
    values = {"mass_damping": 4.0 / time, "stiffness_damping": 2.0 / (omega**2 * time)}
    keys = {} if damping == "none" else {damping: -math.log(expected) * values[damping]}
    structure = block((0.04, 0.01, 0.01), (8, 1, 1), soft, **keys, **CALM)
    mode = np.cos(math.pi * structure.mesh.node[:, 0] / 0.04)
    structure.state.velocity[:, 0] = mode
    steps = math.ceil(time / structure.stable_dt())
    for _ in range(steps):
        structure.step(time / steps)
    share = structure.state.velocity[:, 0] @ mode / (mode @ mode)
    assert share == pytest.approx(1.0 if damping == "none" else expected, rel=0.02)


@INTEGRATIONS
def test_energy_is_kept_at_second_order(integration):
    drifts = []
    for dt in (6e-7, 3e-7):
        structure = block((0.04, 0.02, 0.02), (4, 2, 2), integration=integration, **CALM)
        structure.state.velocity[:, 0] = 10.0 * np.sin(
            math.pi * structure.state.position[:, 0] / 0.04
        )
        start = structure.totals().kinetic
        for _ in range(round(6e-5 / dt)):
            structure.step(dt)
        end = structure.totals()
        drifts.append(abs(end.kinetic + end.internal - start) / start)
    assert drifts[0] < 0.02 and drifts[0] / drifts[1] > 3.0


@INTEGRATIONS
@pytest.mark.parametrize("size", [(0.03, 0.03, 0.03), (0.09, 0.03, 0.01)])
@pytest.mark.parametrize(("share", "grows"), [(0.98, False), (1.05, True)])
def test_the_step_is_stable_below_twice_over_the_greatest_frequency(
    size, share, grows, integration
):
    structure = block(size, (3, 3, 3), integration=integration, **CALM)
    dt = 2.0 / greatest_frequency(structure)
    assert 0.4 < structure.stable_dt() / 0.9 / dt <= 1.0  # the proven bound is below it
    structure.state.velocity[:] = 1e-6 * np.random.default_rng(1).normal(size=(64, 3))
    start = np.abs(structure.state.velocity).max()
    largest = 0.0
    try:
        for _ in range(300):
            structure.step(share * dt)
            largest = np.abs(structure.state.velocity).max()
    except StepError:  # it has turned elements inside out
        largest = math.inf
    assert (largest > 1e3 * start) == grows and (grows or largest < 10.0 * start)


@INTEGRATIONS
def test_patterns_without_strain_are_held(integration):
    """Modes that one quadrature point does not see swing, and do not grow."""
    node = block((0.01, 0.01, 0.01), (1, 1, 1)).mesh.node
    x, y, z = (2.0 * node / 0.01 - 1.0).T
    for pattern in (x * y, y * z, z * x, x * y * z):
        structure = block((0.01, 0.01, 0.01), (1, 1, 1), integration=integration, **CALM)
        structure.state.velocity[:, 0] = 0.01 * pattern
        largest = 0.0
        for _ in range(400):
            structure.step(4e-7)
            displacement = np.abs(structure.state.position - structure.mesh.node).max()
            largest = max(largest, displacement)
        assert largest < 0.01 * 400 * 4e-7 / 10.0
        assert np.abs(structure.state.velocity).max() < 0.0101


def test_a_bar_under_pressure_rings_about_its_static_length():
    """u = p L/E; a wave up and down the bar takes 4L/√(E/ρ)."""
    length, pressure = 0.1, 1e6
    ends = Faces(lowest=(length, 0.0, 0.0), highest=(length, 0.01, 0.01))
    structure = block(
        (length, 0.01, 0.01),
        (20, 2, 2),
        fixed=(Fixed(lowest=(0.0, 0.0, 0.0), highest=(0.0, 0.01, 0.01), directions=("x",)),),
        pressures=(Pressure(faces=ends, pressure=-pressure),),
        **CALM,
    )
    period = 4.0 * length / math.sqrt(E / RHO)
    dt = structure.stable_dt()
    steps = round(4.0 * period / dt)
    end = np.flatnonzero(structure.mesh.node[:, 0] == length)
    displacement = np.empty(steps)
    for k in range(steps):
        structure.step(dt)
        displacement[k] = structure.state.position[end, 0].mean() - length
    assert displacement.mean() == pytest.approx(pressure * length / E, rel=0.02)
    crossings = np.flatnonzero(np.diff(np.sign(displacement - displacement.mean())) > 0) * dt
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
    structure = FePlate(FePlateParams(parts=(part,), rigid_walls=(wall,)))
    start = structure.totals().momentum[2]
    for _ in range(400):
        structure.step(structure.stable_dt())
        assert structure.state.position[:, 2].min() > -1e-12
    end = structure.totals().momentum[2]
    assert end > 0.5 * abs(start)  # it has sprung back
    assert structure.state.wall_impulse.sum() == pytest.approx(end - start, rel=1e-9)


def test_elements_erode_at_their_failure_strain_and_their_mass_stays():
    brittle = Material(
        density=RHO,
        youngs_modulus=E,
        poissons_ratio=NU,
        johnson_cook=JohnsonCook(a=1e8),
        failure_strain=0.05,
    )
    clamp = Fixed(lowest=(0.0, 0.0, 0.0), highest=(0.0, 0.01, 0.01))
    structure = block((0.05, 0.01, 0.01), (10, 2, 2), brittle, fixed=(clamp,))
    structure.state.velocity[structure.mesh.node[:, 0] > 0.026] = (80.0, 0.0, 0.0)
    mass = structure.totals().mass
    for _ in range(600):
        structure.step(structure.stable_dt())
    is_eroded = structure.places.active(structure.state) == 0.0
    strain = structure.places.of(structure.state, STRAIN)
    assert 0 < is_eroded.sum() < 20 and (strain[~is_eroded] < 0.05).all()
    assert structure.totals().mass == mass
    faces = structure.give(frozenset({"face_activity.active"}))["face_activity.active"]
    assert 0.0 < faces.mean() < 1.0
    assert len(structure.view()["cells"]) > 0


def test_an_element_that_is_turned_inside_out_is_named():
    structure = block((0.01, 0.01, 0.01), (2, 2, 2), **CALM)
    structure.state.velocity[13] = (0.0, 0.0, 1e6)
    with pytest.raises(
        StepError, match=r"element \d+, at .* it has -?[\d.e-]+ of that .* inside out"
    ):
        for _ in range(50):
            structure.step(1e-9)


def test_mass_that_is_added_to_nodes_slows_them():
    structure = block((0.01, 0.01, 0.01), (1, 1, 1))
    mass = structure.built.mass[0]
    structure.bind({"node_load.added_mass": np.full(8, mass)}, frozenset({"node_load"}))
    structure.take({"node_load.force": np.full((8, 3), 2.0)})
    structure.step(1e-7)
    np.testing.assert_allclose(structure.state.velocity, 1e-7 * 2.0 / (2.0 * mass), rtol=1e-9)
    assert structure.totals().mass == pytest.approx(2e-6 * RHO)


@INTEGRATIONS
def test_threads_change_no_bit(integration):
    part = Part(
        lowest=(0.0, 0.0, 0.0), highest=(0.01, 0.01, 0.03), elements=(12, 12, 36), material="steel"
    )
    wall = RigidWall(point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0))
    params = FePlateParams(parts=(part,), rigid_walls=(wall,), integration=integration)
    ends = []
    for threads in (1, 2):
        structure = FePlate(params, Resources(threads=threads))
        structure.state.velocity[:, 2] = -300.0
        for _ in range(20):
            structure.step(structure.stable_dt())
        ends.append(structure.save())
    for key, array in ends[0].items():
        np.testing.assert_array_equal(array, ends[1][key], err_msg=key)


@pytest.mark.parametrize("pulse", [True, False])
def test_a_pressure_that_ends_before_it_begins_is_refused(pulse):
    table = {"lowest": (0.0,) * 3, "highest": (1.0,) * 3}
    with pytest.raises(ValueError, match=r"pressures.end must be after begin, 0.2 s; found 0.1 s"):
        Pressure(faces=Faces(**table), pressure=1.0, begin=0.2, end=0.1, pulse=pulse)
    assert Pressure(faces=Faces(**table), pressure=1.0, begin=0.1, end=0.2, pulse=pulse).at(0.15)
