"""Meshes of structures, and gauges in them."""

import dataclasses
import math

import meshio
import numpy as np
import pytest

from quintet.components.fe_plate.component import FePlate
from quintet.components.fe_plate.meshes.params import Cutout, Part
from quintet.components.fe_plate.meshes.selections import Elements, Faces, Fixed, NodeSet
from quintet.components.fe_plate.params import FePlateParams, Gauges, Pressure, RigidWall
from quintet.components.fe_plate.state import STRAIN
from quintet.components.fe_plate.view import von_mises
from quintet.components.shared.materials.params import (
    JohnsonCook,
    JohnsonCookDamage,
    Material,
)
from quintet.interfaces.errors import SceneError
from quintet.interfaces.faces import CLAMPED, SYMMETRY, WALL

ELASTIC = Material(density=2700.0, youngs_modulus=7e10, poissons_ratio=0.3)


def bar(axis="z", quarter=False, elements=(3, 3, 8), **keys):
    base = (0.1, 0.2, 0.3)
    top = tuple(x + 0.05 * (along == axis) for x, along in zip(base, "xyz", strict=True))
    part = Part(
        shape="cylinder",
        base=base,
        top=top,
        radius=0.01,
        elements=elements,
        quarter=quarter,
        material=ELASTIC,
    )
    return FePlate(FePlateParams(parts=(part,), **keys))


@pytest.mark.parametrize("axis", ["x", "y", "z"])
@pytest.mark.parametrize("quarter", [False, True])
def test_a_cylinder_has_its_volume_and_its_elements(axis, quarter):
    share = 0.25 if quarter else 1.0
    structure = bar(axis, quarter)
    assert structure.items() == structure.params.parts[0].count == share * 4 * 3 * 9 * 8
    rim = 12 * 2  # corners of the circle
    area = 0.5 * rim * math.sin(2.0 * math.pi / rim) * 0.01**2
    assert structure.built.volume.sum() == pytest.approx(share * area * 0.05, rel=1e-12)
    assert structure.built.volume.min() > 0.4 * structure.built.volume.max()
    used = np.unique(structure.mesh.corner)
    assert len(used) == len(structure.mesh.node)  # none twice, none alone
    middle = 0.5 * (structure.mesh.node.min(axis=0) + structure.mesh.node.max(axis=0))
    along = "xyz".index(axis)
    assert middle[along] == pytest.approx((0.1, 0.2, 0.3)[along] + 0.025)


def test_a_cutout_leaves_out_elements_and_the_nodes_that_no_other_has():
    box = {"lowest": (0.0, 0.0, 0.0), "highest": (0.04, 0.03, 0.01), "elements": (4, 3, 1)}
    cut = Cutout(lowest=(0.01, 0.01, -1.0), highest=(0.03, 0.02, 1.0))
    structure = FePlate(FePlateParams(parts=(Part(**box, cutout=cut, material=ELASTIC),)))
    assert structure.items() == structure.params.parts[0].count == 4 * 3 - 2
    assert structure.built.volume.sum() == pytest.approx(10 * 0.01**3, rel=1e-12)
    assert len(structure.mesh.node) == 5 * 4 * 2 and len(structure.faces) == 2 * 10 + 14 + 6
    wider = Cutout(lowest=(0.0, 0.0, 0.0), highest=(0.04, 0.03, 0.01))
    with pytest.raises(ValueError, match="it leaves none"):
        Part(**box, cutout=wider, material=ELASTIC)


def test_a_uniform_pressure_on_a_cylinder_pushes_it_nowhere():
    everywhere = Faces(lowest=(-1.0, -1.0, -1.0), highest=(1.0, 1.0, 1.0))
    structure = bar(pressures=(Pressure(faces=everywhere, pressure=1e6),))
    structure.step(1e-9)
    push = np.abs(structure.state.load).sum()
    assert np.abs(structure.state.load.sum(axis=0)).max() < 1e-12 * push


def test_gauges_give_what_nodes_elements_and_parts_have():
    still = Part(
        lowest=(0.0, 0.0, 0.0), highest=(1.0, 1.0, 1.0), elements=(2, 2, 2), material="steel"
    )
    moving = Part(
        lowest=(3.0, 0.0, 0.0),
        highest=(4.0, 1.0, 1.0),
        elements=(3, 1, 1),
        material=ELASTIC,
        velocity=(7.0, 0.0, 0.0),
    )
    gauges = Gauges(
        node_gauges=((4.0, 0.9, 0.9),), element_gauges=((0.3, 0.2, 0.9),), part_gauge=True
    )
    structure = FePlate(FePlateParams(parts=(still, moving), gauges=gauges))
    keys = {f"{port.name}.{field.name}" for port in structure.gives for field in port.fields}
    outputs = structure.give(frozenset(keys))
    assert keys == set(outputs)
    np.testing.assert_array_equal(outputs["node_gauge.position"], [[4.0, 1.0, 1.0]])
    np.testing.assert_array_equal(outputs["node_gauge.velocity"], [[7.0, 0.0, 0.0]])
    assert outputs["element_gauge.temperature"] == pytest.approx([298.0])
    assert outputs["part_gauge.velocity"] == pytest.approx(np.array([[0.0] * 3, [7.0, 0.0, 0.0]]))
    assert outputs["part_gauge.kinetic"] == pytest.approx([0.0, 0.5 * 2700.0 * 49.0])
    for _ in range(30):
        structure.step(structure.stable_dt())
    totals, outputs = structure.totals(), structure.give(frozenset(keys))
    assert outputs["part_gauge.kinetic"].sum() == pytest.approx(totals.kinetic, rel=1e-12)
    assert outputs["part_gauge.internal"].sum() == pytest.approx(totals.internal, abs=1e-9)


def test_gauges_of_sets_give_what_their_nodes_and_elements_have():
    part = Part(
        lowest=(0.0, 0.0, 0.0),
        highest=(4.0, 1.0, 1.0),
        elements=(4, 1, 1),
        material=ELASTIC,
        velocity=(0.0, 3.0, 0.0),
    )
    end = {"lowest": (3.0, 0.0, 0.0), "highest": (4.0, 1.0, 1.0)}
    gauges = Gauges(
        node_set_gauges=("end",),
        element_set_gauges=(
            Elements(node_set="end"),
            Elements(lowest=(0.0,) * 3, highest=(9.0,) * 3),
        ),
        part_gauge=True,
    )
    params = FePlateParams(parts=(part,), node_sets=(NodeSet(name="end", **end),), gauges=gauges)
    structure = FePlate(params)
    structure.state.velocity[structure.mesh.node[:, 0] > 2.5] = (5.0, 0.0, 0.0)
    for _ in range(5):
        structure.step(structure.stable_dt())
    keys = {f"{port.name}.{field.name}" for port in structure.gives for field in port.fields}
    outputs = structure.give(frozenset(keys))
    assert keys == set(outputs)
    nodes = structure.mesh.node[:, 0] > 2.5
    np.testing.assert_allclose(
        outputs["node_set_gauge.velocity"],
        [structure.state.velocity[nodes].mean(axis=0)],
        rtol=1e-12,
    )
    assert outputs["node_set_gauge.position"][0, 0] > 3.5
    for name in ("velocity", "kinetic", "internal", "eroded"):
        values = outputs[f"element_set_gauge.{name}"]
        assert values[1] == pytest.approx(outputs[f"part_gauge.{name}"][0], rel=1e-12)
    assert 0.0 < outputs["element_set_gauge.kinetic"][0] < outputs["element_set_gauge.kinetic"][1]
    stress = von_mises(structure.places, structure.state)
    assert outputs["element_set_gauge.von_mises"] == pytest.approx([stress[3], stress.mean()])
    unknown = dataclasses.replace(gauges, element_set_gauges=(Elements(element_set="rim"),))
    with pytest.raises(SceneError, match=r"element_set_gauges.0: element_set rim is not known"):
        FePlate(dataclasses.replace(params, gauges=unknown))


def test_sets_of_elements_are_read_from_a_file(tmp_path):
    node, corner = _hexahedra()
    cells = [("triangle", corner[:1, :3]), ("hexahedron", corner)]
    sets = {"right": [np.zeros(0, int), np.array([1])]}
    meshio.Mesh(node, cells, cell_sets=sets).write(tmp_path / "block.inp")
    part = Part(shape="mesh", file=str(tmp_path / "block.inp"), scale=1e-3, material=ELASTIC)
    gauges = Gauges(element_set_gauges=(Elements(element_set="right"),))
    structure = FePlate(FePlateParams(parts=(part,), gauges=gauges))
    assert [elements.rows.tolist() for elements in structure.measured.element_sets] == [[1]]


def _hexahedra():
    """A block of 2 x 1 x 1 elements in mm, with a stray node and a triangle."""
    x, y, z = np.meshgrid([0.0, 10.0, 20.0], [0.0, 10.0], [0.0, 10.0], indexing="ij")
    node = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    number = np.arange(12).reshape(3, 2, 2)
    ring = ((0, 0), (1, 0), (1, 1), (0, 1))
    corner = [[number[i + a, b, k] for k in (0, 1) for a, b in ring] for i in (0, 1)]
    return np.concatenate([[[99.0, 0.0, 0.0]], node]), np.array(corner) + 1


@pytest.mark.parametrize("name", ["block.inp", "block.vtk", "block.msh"])
def test_a_mesh_is_read_from_a_file(tmp_path, name):
    node, corner = _hexahedra()
    left = np.flatnonzero(node[:, 0] == 0.0)
    file = tmp_path / name
    sets = {"left": left} if name.endswith("inp") else {}
    cells = [("triangle", corner[:1, :3]), ("hexahedron", corner)]
    meshio.Mesh(node, cells, point_sets=sets).write(file)
    origin = (0.0, 0.0, 1.0)
    part = Part(shape="mesh", file=str(file), scale=1e-3, origin=origin, material=ELASTIC)
    clamp = (
        Fixed(node_set="left") if sets else Fixed(lowest=(0.0, 0.0, 0.0), highest=(0.0, 1.0, 2.0))
    )
    params = FePlateParams(parts=(part,), fixed=(clamp,))
    structure = FePlate(params)
    assert structure.items() == params.parts[0].count == 2
    assert structure.built.volume == pytest.approx([1e-6, 1e-6])
    assert len(structure.mesh.node) == 12 and (structure.model.free == 0.0).sum() == 3 * 4
    assert structure.mesh.node[:, 2].min() == 1.0
    assert structure.stable_dt() < params.parts[0].expected_step * 1.1


def test_elements_that_are_inside_out_are_named(tmp_path):
    node, corner = _hexahedra()
    corner[1] = corner[1][[4, 5, 6, 7, 0, 1, 2, 3]]
    meshio.Mesh(node, [("hexahedron", corner)]).write(tmp_path / "block.vtk")
    part = Part(shape="mesh", file=str(tmp_path / "block.vtk"), material=ELASTIC)
    with pytest.raises(SceneError, match=r"element 1 .* at .* found -1e\+03 m3: it is inside out"):
        FePlate(FePlateParams(parts=(part,)))


def test_files_without_solids_are_refused(tmp_path):
    node, corner = _hexahedra()
    meshio.Mesh(node, [("triangle", corner[:, :3])]).write(tmp_path / "flat.vtk")
    part = Part(shape="mesh", file=str(tmp_path / "flat.vtk"), material=ELASTIC)
    with pytest.raises(SceneError, match=r"elements of kind hexahedron, .*; found 2 triangle"):
        FePlate(FePlateParams(parts=(part,)))
    (tmp_path / "none.vtk").write_text("nothing")
    part = Part(shape="mesh", file=str(tmp_path / "none.vtk"), material=ELASTIC)
    with pytest.raises(SceneError, match="must be a mesh that meshio reads"):
        FePlate(FePlateParams(parts=(part,)))


def test_what_holds_a_structure_is_shown():
    """A rigid wall before its foot, a clamped end seen from outside, and a plane of symmetry."""
    part = Part(
        lowest=(0.0, 0.0, 0.0), highest=(1.0, 2.0, 3.0), elements=(2, 2, 2), material=ELASTIC
    )
    foot = Fixed(lowest=(0.0, 0.0, 0.0), highest=(1.0, 2.0, 0.0))
    axis = Fixed(lowest=(0.0, 0.0, 0.0), highest=(1.0, 0.0, 9.0), directions=("y",))
    wall = RigidWall(point=(0.0, 0.0, -1.0), normal=(0.0, 0.0, 3.0))
    free = FePlateParams(parts=(part,))
    params = dataclasses.replace(free, fixed=(foot, axis), rigid_walls=(wall,))
    walls = FePlate(params).walls()
    np.testing.assert_array_equal(walls["support"], [WALL, CLAMPED, SYMMETRY])
    corners = walls["points"][walls["cells"].astype(int)]
    assert (corners[0][:, 2] == -1.0).all() and (corners[1][:, 2] == 0.0).all()
    assert (corners[2][:, 1] == 0.0).all()
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 1])
    assert normals[0, 2] > 0.0 > normals[1, 2] and normals[2, 1] < 0.0
    assert FePlate(free).walls() == {}
    flat = dataclasses.replace(part, highest=(1.0, 1.0, 3.0), elements=(2, 1, 2))
    plane = dataclasses.replace(free, parts=(flat,), dimensions=2, fixed=(foot,))
    (corners,) = FePlate(plane).walls()["points"].reshape(-1, 4, 3)
    assert (corners[:, 2] == 0.0).all()
    assert np.cross(corners[1] - corners[0], corners[2] - corners[1])[2] < 0.0


def test_nodes_are_chosen_by_the_name_of_their_set():
    sets = (NodeSet(name="foot", lowest=(0.0, 0.0, 0.3), highest=(1.0, 1.0, 0.3)),)
    structure = bar(node_sets=sets, fixed=(Fixed(node_set="foot", directions=("z",)),))
    foot = structure.mesh.node[:, 2] == 0.3
    np.testing.assert_array_equal(structure.model.free[:, 2] == 0.0, foot)
    faces = bar(node_sets=sets, coupled_faces=(Faces(node_set="foot"),))
    assert len(faces.surface) == foot.sum()
    with pytest.raises(
        SceneError, match=r"fixed.0: node_set foor is not known\. Did you mean foot"
    ):
        bar(node_sets=sets, fixed=(Fixed(node_set="foor"),))


def test_elements_erode_by_what_the_scene_names():
    brittle = Material(
        density=2700.0,
        youngs_modulus=7e10,
        poissons_ratio=0.3,
        johnson_cook=JohnsonCook(a=1e8),
        failure_strain=0.05,
        damage=JohnsonCookDamage(d1=0.02),
        spall_stress=3e8,
    )
    part = Part(
        lowest=(0.0, 0.0, 0.0), highest=(0.05, 0.01, 0.01), elements=(10, 2, 2), material=brittle
    )
    strains = {}
    for by in ((), ("plastic_strain",), ("damage",)):
        clamp = Fixed(lowest=(0.0, 0.0, 0.0), highest=(0.0, 0.01, 0.01))
        structure = FePlate(FePlateParams(parts=(part,), fixed=(clamp,), erosion=by))
        structure.state.velocity[structure.mesh.node[:, 0] > 0.026] = (80.0, 0.0, 0.0)
        for _ in range(400):
            structure.step(structure.stable_dt())
        is_active = structure.places.active(structure.state) > 0.0
        strains[by] = structure.places.of(structure.state, STRAIN)[is_active].max()
        assert is_active.all() == (not by)
    assert strains[()] > 0.05 > strains[("plastic_strain",)] > 0.02 > strains[("damage",)]
