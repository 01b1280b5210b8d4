"""Tetrahedra with ten nodes: patch test, modes, step, plastic flow, loads."""

import dataclasses

import numpy as np
import pytest
from tetrahedra import box, curved, regular, write_mesh

from quintet.components.fe_plate.component import FePlate
from quintet.components.fe_plate.heat.params import ConductingPart
from quintet.components.fe_plate.meshes.params import Part
from quintet.components.fe_plate.meshes.selections import Faces, Fixed
from quintet.components.fe_plate.params import FePlateParams, Pressure
from quintet.components.fe_plate.state import ACTIVE, DEVIATOR, PRESSURE, STRAIN, at_points
from quintet.components.shared.materials.params import JohnsonCook, Material
from quintet.interfaces.errors import SceneError

E, NU, RHO = 7e10, 0.3, 2700.0
CALM = {"viscosity_linear": 0.0, "viscosity_quadratic": 0.0}
EVERYWHERE = Faces(lowest=(-9.0,) * 3, highest=(9.0,) * 3)
ELASTIC = Material(density=RHO, youngs_modulus=E, poissons_ratio=NU)
PERFECT = Material(
    density=RHO, youngs_modulus=E, poissons_ratio=NU, johnson_cook=JohnsonCook(a=1e8)
)


def structure(folder, mesh, material=ELASTIC, velocity=None, **keys):
    file = write_mesh(folder / "mesh.vtk", *mesh)
    part = Part(shape="mesh", file=file, material=material, velocity=velocity)
    return FePlate(FePlateParams(parts=(part,), **CALM | keys))


def move_to(plate, places, dt=1e-12):
    """Move all nodes to some places within a step, and write the forces there."""
    plate.state.forces[:] = 0.0
    plate.state.velocity[:] = (places - plate.state.position) / dt
    plate.step(dt)


def stiffness(plate, free=None, displacement=1e-9, dt=1e-12):
    """Matrix K [N/m] of all nodes along some of their axes, found column by column."""
    state, size = plate.save(), plate.state.position.size
    free = np.arange(size) if free is None else free
    columns = np.empty((size, len(free)))
    for column, number in enumerate(free):
        plate.load(state)
        plate.state.forces[:] = 0.0
        plate.state.velocity[:] = 0.0
        plate.state.velocity.ravel()[number] = displacement / dt
        plate.step(dt)
        columns[:, column] = -plate.state.internal.ravel() / displacement
    plate.load(state)
    square = columns[free]
    assert np.abs(square - square.T).max() < 1e-6 * np.abs(square).max()
    columns[free] = 0.5 * (square + square.T)
    return columns


def squares(plate):
    """ω² [1/s2] of all modes."""
    root = np.repeat(np.sqrt(plate.model.inverse_mass), 3)
    return np.linalg.eigvalsh(root[:, None] * stiffness(plate) * root)


@pytest.fixture(scope="module")
def element(tmp_path_factory):
    return structure(tmp_path_factory.mktemp("one"), regular(0.01))


def test_an_element_has_its_volume_and_positive_masses_at_its_nodes(element):
    volume = 0.01**3 / np.sqrt(72.0)
    assert element.built.volume.sum() == pytest.approx(volume, rel=1e-12)
    assert element.built.mass[:4] == pytest.approx(RHO * volume / 36.0, rel=1e-12)
    assert element.built.mass[4:] == pytest.approx(RHO * volume * 4.0 / 27.0, rel=1e-12)


def test_no_mode_but_rigid_motion_is_without_energy(element):
    spectrum = squares(element)
    assert (np.abs(spectrum[:6]) < 1e-6 * spectrum[-1]).all() and spectrum[6] > 1e-3 * spectrum[-1]


@pytest.mark.parametrize(("bent", "rest"), [(0.0, 1e-9), (0.01, 3e-4)])
def test_the_patch_test_is_passed_to_rounding(bent, rest, tmp_path):
    """A linear displacement strains all points alike; inner nodes feel no force.

    Of curved elements ∇N dV is of third order, which four points do not sum exactly: midside nodes
    2 % of an edge away leave 1e-4 of the forces at the surface.
    """
    node, corner = box((2, 2, 2), shaken=0.15)
    plate = structure(tmp_path, (curved(node, corner, bent), corner))
    node = plate.mesh.node
    strain = 1e-4 * np.array([[1.0, 0.4, -0.3], [0.4, -0.5, 0.7], [-0.3, 0.7, 0.2]])
    move_to(plate, node + node @ strain)
    lame, shear = E * NU / (1.0 + NU) / (1.0 - 2.0 * NU), 0.5 * E / (1.0 + NU)
    expected = 2.0 * shear * (strain - np.trace(strain) / 3.0 * np.eye(3))
    points = plate.places.point
    for row, axes in enumerate(((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))):
        stress = at_points(plate.state.points, DEVIATOR + row, points)
        np.testing.assert_allclose(stress, expected[axes], rtol=0.0, atol=3e-4 * 2.0 * shear * 1e-4)
        assert np.ptp(stress) < 1e-9 * shear * 1e-4
    pressure = at_points(plate.state.points, PRESSURE, points)
    assert pressure == pytest.approx(-(lame + 2 / 3 * shear) * np.trace(strain), rel=1e-3)
    inner = ((node > 1e-9) & (node < 1.0 - 1e-9)).all(axis=1)
    assert inner.sum() > 20
    push = np.abs(plate.state.internal).max()
    assert np.abs(plate.state.internal[inner]).max() < rest * push


def rotations(steps, total_angle=2.0):
    """Rotations about an oblique axis, up to an angle [rad]."""
    axis = np.array([1.0, 2.0, 2.0]) / 3.0
    cross = -np.cross(np.eye(3), axis)
    for angle in np.linspace(0.0, total_angle, steps + 1)[1:]:
        yield np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * cross @ cross


def test_a_large_rotation_strains_nothing(tmp_path):
    node, corner = box((2, 1, 1), shaken=0.1)
    plate = structure(tmp_path, (node, corner))
    for rotation in rotations(20):  # of 115 degrees in all
        move_to(plate, node @ rotation.T)
    assert np.abs(plate.state.points[:, : PRESSURE + 1]).max() < 1e-12 * E


def test_a_large_rotation_turns_the_stress(tmp_path):
    """By Jaumann's rate: the error is of first order in the angle of a step, 2 mrad."""
    node, corner = box((2, 1, 1), shaken=0.1)
    plate = structure(tmp_path, (node, corner))
    strained = node @ (np.eye(3) + 1e-4 * np.diag([1.0, -0.5, 0.3]))
    move_to(plate, strained)
    before = plate.state.internal.copy()
    for rotation in rotations(1000):
        move_to(plate, strained @ rotation.T)
    assert np.abs(plate.state.internal - before @ rotation.T).max() < 4e-3 * np.abs(before).max()


def test_a_uniform_pressure_on_all_faces_is_borne_by_a_uniform_stress(tmp_path):
    """No node is left with a force."""
    node, corner = box((2, 2, 2), shaken=0.15)
    load = Pressure(faces=EVERYWHERE, pressure=1e6)
    plate = structure(tmp_path, (node, corner), pressures=(load,))
    bulk = E / 3.0 / (1.0 - 2.0 * NU)
    move_to(plate, node * (1.0 + 1e6 / bulk) ** (-1.0 / 3.0))
    plate.state.velocity[:] = 0.0
    plate.step(1e-15)
    push = np.abs(plate.state.load).max()
    assert np.abs(plate.state.load.sum(axis=0)).max() < 1e-12 * np.abs(plate.state.load).sum()
    assert np.abs(plate.state.internal + plate.state.load).max() < 1e-6 * push
    corners = np.unique(corner[:, :4])
    assert np.abs(plate.state.load[corners]).max() < 1e-9 * push  # flat faces load middles alone


def test_the_proven_step_is_below_the_stable_one_and_not_by_far(element, tmp_path):
    """Shares of 2/ω_max: 0.59 of a regular tetrahedron, 0.56 of six in a cube, 0.35 of shaken."""
    shares = {}
    shares["regular"] = element.bound * np.sqrt(squares(element)[-1]) / 2.0
    for name, shaken in (("cube", 0.0), ("shaken", 0.25)):
        plate = structure(tmp_path, box((2, 2, 2), (0.02,) * 3, shaken))
        shares[name] = plate.bound * np.sqrt(squares(plate)[-1]) / 2.0
    assert shares["regular"] == pytest.approx(0.59, abs=0.01)
    assert shares["cube"] == pytest.approx(0.56, abs=0.01)
    assert 0.3 < shares["shaken"] < 0.65


@pytest.mark.parametrize(("share", "grows"), [(0.97, False), (1.05, True)])
def test_the_stable_step_is_where_the_greatest_frequency_puts_it(share, grows, element):
    dt = share * 2.0 / np.sqrt(squares(element)[-1])
    state = element.save()
    element.state.velocity[:] = 1e-3 * np.random.default_rng(3).standard_normal((10, 3))
    start = element.totals().kinetic
    largest = 0.0
    for _ in range(200):
        element.step(dt)
        largest = max(largest, element.totals().kinetic)
        if largest > 1e3 * start:
            break
    element.load(state)
    assert (largest > 100.0 * start) == grows


def test_energy_is_kept_with_plastic_flow_and_large_strains(tmp_path):
    plate = structure(
        tmp_path, box((2, 2, 4), (0.01, 0.01, 0.02), 0.1), PERFECT, courant=0.9,
        fixed=(Fixed(lowest=(0.0,) * 3, highest=(0.01, 0.01, 0.0)),),
    )  # fmt: skip
    plate.state.velocity[:, 2] = -80.0 * plate.mesh.node[:, 2] / 0.02
    first = plate.totals()
    for _ in range(600):
        plate.step(plate.stable_dt())
    last = plate.totals()
    assert plate.places.of(plate.state, STRAIN).max() > 0.05
    energy_gain = last.kinetic + last.internal - first.kinetic
    assert abs(energy_gain) < 0.01 * first.kinetic


def test_plastic_flow_keeps_the_volume_of_elements_and_hardly_of_points(tmp_path):
    """Pressures of the four points differ by a fifth once an element has yielded."""
    spread = []
    for material in (ELASTIC, PERFECT):
        plate = structure(tmp_path, regular(0.01), material)
        sheared = np.eye(3)
        sheared[0, 1] = 0.01
        node = plate.mesh.node
        move_to(plate, node @ sheared.T)
        pushed = np.random.default_rng(4).uniform(-1e-6, 1e-6, node.shape)
        move_to(plate, node @ sheared.T + pushed)
        assert (plate.state.points[0, STRAIN, :4] > 0.0).all() == (material is PERFECT)
        spread.append(np.ptp(plate.state.points[0, PRESSURE, :4]))
    assert spread[1] == pytest.approx(0.2 * spread[0], rel=0.02)


def test_elements_erode_whole(tmp_path):
    brittle = dataclasses.replace(PERFECT, failure_strain=0.02)
    fixed = (Fixed(lowest=(0.0,) * 3, highest=(0.01, 0.01, 0.0)),)
    mesh = box((2, 2, 2), (0.01,) * 3, 0.1)
    plate = structure(tmp_path, mesh, brittle, (0.0, 0.0, 60.0), fixed=fixed)
    cell_count = len(plate.view()["cells"])
    for _ in range(150):
        plate.step(plate.stable_dt())
    active = plate.places.active(plate.state)
    assert 0.0 < active.mean() < 1.0
    points = at_points(plate.state.points, ACTIVE, plate.places.point[active == 0.0])
    plate.step(plate.stable_dt())
    points = at_points(plate.state.points, ACTIVE, plate.places.point[active == 0.0])
    assert (points == 0.0).all()  # a point that fails takes the others of its element with it
    assert len(plate.view()["cells"]) != cell_count and plate.view()["cells"].shape[1] == 3


def test_faces_hand_on_motion_and_forces_to_partners(tmp_path):
    """Points hang on flat triangles: linear motion is exact, forces and moments are kept."""
    plate = structure(tmp_path, box((2, 1, 1)))
    points = np.random.default_rng(5).uniform(0.05, 0.95, (40, 3)) * (2.0, 1.0, 0.0) / (2, 1, 1)
    answer = plate.sample({"node_glue.points": points})
    node, weight = answer["node_glue.node"].astype(int), answer["node_glue.weight"]
    x = plate.start[node]
    np.testing.assert_allclose(np.einsum("nc,nck->nk", weight, x), points, atol=1e-12)
    assert np.abs(answer["node_glue.gap"]).max() < 1e-12
    force = np.random.default_rng(6).standard_normal((40, 3))
    nodal = np.zeros_like(plate.start)
    np.add.at(nodal, node, weight[:, :, None] * force[:, None, :])
    np.testing.assert_allclose(nodal.sum(axis=0), force.sum(axis=0), atol=1e-12)
    moment = np.cross(plate.start, nodal).sum(axis=0)
    np.testing.assert_allclose(moment, np.cross(points, force).sum(axis=0), atol=1e-12)
    thickness = plate.describe()["contact_surface.thickness"]  # half the heights of tetrahedra
    assert set(np.round(thickness, 12)) == {0.25, 0.5}


def test_one_point_is_refused(tmp_path):
    with pytest.raises(SceneError, match=r"four quadrature points.*found \"reduced\""):
        structure(tmp_path, regular(), integration="reduced")


def test_the_bricks_of_a_box_are_cut_into_six():
    size = {"lowest": (0.0,) * 3, "highest": (0.03, 0.02, 0.02), "elements": (3, 2, 2)}
    part = Part(**size, tetrahedra=True, material=ELASTIC)
    plate = FePlate(FePlateParams(parts=(part,)))
    assert plate.items() == part.count == 6 * 12 and len(plate.mesh.node) == 7 * 5 * 5
    assert plate.built.volume == pytest.approx(1e-6 / 6.0, rel=1e-12)
    assert len(plate.faces) == 4 * 2 * 32  # triangles: two faces with six nodes on each side
    assert part.expected_step == pytest.approx(plate.bound, rel=0.1)
    with pytest.raises(ValueError, match="tetrahedra = true is for a box; found a cylinder"):
        Part(
            shape="cylinder", base=(0.0,) * 3, top=(0.0, 0.0, 1.0), radius=1.0, elements=(2, 2, 2),
            tetrahedra=True, material=ELASTIC,
        )  # fmt: skip
    flat = dataclasses.replace(part, highest=(0.03, 1.0, 0.02), elements=(3, 1, 2))
    with pytest.raises(ValueError, match=r"parts.0: in two dimensions there are no tetrahedra"):
        FePlateParams(parts=(flat,), dimensions=2)
    with pytest.raises(ValueError, match="heat is conducted through hexahedra alone"):
        ConductingPart(**size, tetrahedra=True, conductivity=1.0)


def frequencies(elements, size, directions, count):
    """Lowest frequencies [Hz] of a beam clamped at x = 0, whose nodes are held along some axes."""
    part = Part(
        lowest=(0.0,) * 3, highest=size, elements=(elements, 1, 1), tetrahedra=True,
        material=dataclasses.replace(ELASTIC, poissons_ratio=0.0),
    )  # fmt: skip
    clamp = Fixed(lowest=(0.0,) * 3, highest=(0.0, *size[1:]))
    fixed = (clamp, Fixed(lowest=(0.0,) * 3, highest=size, directions=directions))
    plate = FePlate(FePlateParams(parts=(part,), fixed=fixed, **CALM))
    free = np.flatnonzero(plate.model.free.ravel() > 0)
    root = np.repeat(np.sqrt(plate.model.inverse_mass), 3)[free]
    inner = stiffness(plate, free)[free]
    return np.sqrt(np.linalg.eigvalsh(root[:, None] * inner * root)[:count]) / (2.0 * np.pi)


def test_a_cantilever_has_its_first_two_frequencies():
    """Timoshenko, shear coefficient 5/6: 817.17 and 4934.1 Hz; 6 x 10 elements, one layer."""
    lowest = frequencies(10, (0.1, 0.01, 0.01), ("y",), 2)
    assert lowest == pytest.approx([817.17, 4934.1], rel=3e-3)


def test_frequencies_converge_with_second_order():
    """Of a rod that stretches, c/4L: lumped masses limit the order of quadratic elements to 2."""
    errors = []
    for elements in (2, 4, 8):
        (frequency,) = frequencies(elements, (0.1, 0.1 / elements, 0.1 / elements), ("y", "z"), 1)
        errors.append(frequency * 0.4 / np.sqrt(E / RHO) - 1.0)
    orders = np.log2(np.array(errors)[:-1] / errors[1:])
    assert orders == pytest.approx(2.0, abs=0.3)
    assert abs(errors[-1]) < 2e-3


def test_hexahedra_and_tetrahedra_in_one_component_are_refused(tmp_path):
    file = write_mesh(tmp_path / "mesh.vtk", *regular())
    tetrahedron = Part(shape="mesh", file=file, origin=(9.0, 0.0, 0.0), material=ELASTIC)
    cube = Part(lowest=(0.0,) * 3, highest=(1.0,) * 3, elements=(1, 1, 1), material=ELASTIC)
    with pytest.raises(SceneError, match=r"hexahedra in parts.0 and tetrahedra in parts.1. Make"):
        FePlate(FePlateParams(parts=(cube, tetrahedron)))
