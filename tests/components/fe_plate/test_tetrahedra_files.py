"""Tetrahedra from files: the order of nodes of each format, four nodes raised to ten, refusals."""

from importlib.resources import files

import numpy as np
import pytest
from tetrahedra import box, regular, write_mesh

from quintet.components.fe_plate.component import FePlate
from quintet.components.fe_plate.heat.params import ConductingPart
from quintet.components.fe_plate.meshes.files import read
from quintet.components.fe_plate.meshes.params import Part
from quintet.components.fe_plate.meshes.selections import Faces, Fixed, NodeSet
from quintet.components.fe_plate.meshes.tetrahedra import (
    EDGES,
    POOR,
    jacobians,
    point_volumes,
    radius_ratio,
)
from quintet.components.fe_plate.params import FePlateParams
from quintet.components.fe_plate.plan import plan
from quintet.components.shared.materials.params import Material
from quintet.interfaces.errors import SceneError

CANTILEVER = files("quintet.scenarios") / "cantilever"
ELASTIC = Material(density=2700.0, youngs_modulus=7e10, poissons_ratio=0.3)
# A tetrahedron whose midside nodes are each elsewhere: no two orders give the same element.
CORNERS = np.array([(0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (0.5, 1.5, 0.0), (0.5, 0.5, 1.0)])
BENT = 0.01 * np.array([(0, 1, -2), (3, 1, 0), (-2, 0, 1), (0, -3, 1), (2, 2, 1), (1, 3, 2)])
PLACES = np.concatenate([CORNERS, CORNERS[EDGES].mean(axis=1) + BENT])
GMSH = [0, 1, 2, 3, 4, 5, 6, 7, 9, 8]  # Gmsh's last two stand in the middles of 23 and 13


def node_lines(places):
    rows = enumerate(places.tolist(), 1)
    return "".join(f"{k}, {x!r}, {y!r}, {z!r}\n" for k, (x, y, z) in rows)


def gmsh(places):
    nodes = "".join(f"{k} {x!r} {y!r} {z!r}\n" for k, (x, y, z) in enumerate(places.tolist(), 1))
    numbers = " ".join(str(1 + k) for k in GMSH)
    return (
        f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(places)}\n{nodes}$EndNodes\n"
        f"$Elements\n1\n1 11 2 1 1 {numbers}\n$EndElements\n"
    )


def abaqus(places, kind="C3D10", numbers=range(1, 11)):
    nodes = node_lines(places)
    corners = ", ".join(str(k) for k in numbers)
    return f"*NODE\n{nodes}*ELEMENT, TYPE={kind}\n1, {corners}\n"


def nastran(places):
    nodes = "".join(
        f"GRID    {k:8d}{'':8}{x:8.4f}{y:8.4f}{z:8.4f}\n"
        for k, (x, y, z) in enumerate(places.tolist(), 1)
    )
    first, last = ("".join(f"{k:8d}" for k in numbers) for numbers in (range(1, 7), range(7, 11)))
    return f"BEGIN BULK\n{nodes}CTETRA  {1:8d}{1:8d}{first}+\n+       {last}\nENDDATA\n"


def ls_dyna(places):
    nodes = node_lines(places)
    numbers = "".join(f"{k:8d}" for k in range(1, 11))
    return f"*KEYWORD\n*NODE\n{nodes}*ELEMENT_SOLID\n{1:8d}{1:8d}\n{numbers}\n*END\n"


def volume(places):
    """∫ det J of an element by Gauss's rule in a cube that is collapsed to it."""
    points, weights = np.polynomial.legendre.leggauss(4)
    u, v, w = (0.5 * (1.0 + x.ravel()) for x in np.meshgrid(points, points, points))
    first = np.array([(1 - u), u * (1 - v), u * v * (1 - w), u * v * w]).T
    weight = np.einsum("i,j,k->ijk", weights, weights, weights).ravel() / 8.0 * u * u * v
    return float(jacobians(places, np.arange(10)[None], first)[0] @ weight)


FORMATS = {"a.msh": gmsh, "a.inp": abaqus, "a.bdf": nastran, "a.k": ls_dyna}


def write_file(folder, name, text):
    (folder / name).write_text(text)
    return str(folder / name)


@pytest.mark.parametrize("name", FORMATS)
def test_each_format_numbers_the_nodes_in_its_own_order(name, tmp_path):
    mesh = read(write_file(tmp_path, name, FORMATS[name](PLACES)))
    np.testing.assert_allclose(mesh.node[mesh.corner[0]], PLACES, atol=5e-5)
    mesh_volume = point_volumes(mesh.node, mesh.corner).sum()
    assert mesh_volume == pytest.approx(volume(PLACES), rel=1e-3) and abs(mesh_volume - 0.5) > 0.02


def test_a_straight_element_has_its_volume(tmp_path):
    straight = np.concatenate([CORNERS, CORNERS[EDGES].mean(axis=1)])
    for name, to_text in FORMATS.items():
        mesh = read(write_file(tmp_path, name, to_text(straight)))
        assert point_volumes(mesh.node, mesh.corner).sum() == pytest.approx(0.5, rel=1e-12)


def test_nodes_out_of_order_are_refused(tmp_path):
    file = write_file(tmp_path, "a.inp", abaqus(PLACES, numbers=[1 + k for k in GMSH]))
    with pytest.raises(
        SceneError,
        match=r"midside node must .* found node 9 of element 0 .*order",
    ):
        Part(shape="mesh", file=file, material=ELASTIC).placed()


def test_elements_inside_out_collapsed_or_too_curved_are_refused(tmp_path):
    turned = PLACES * np.array([1.0, 1.0, -1.0])
    with pytest.raises(
        SceneError, match=r"Jacobian above 0 at its corners; found -3.*Reverse the order"
    ):
        Part(
            shape="mesh", file=write_file(tmp_path, "a.inp", abaqus(turned)), material=ELASTIC
        ).placed()
    file = write_file(tmp_path, "b.inp", abaqus(PLACES, numbers=[*range(1, 10), 9]))
    with pytest.raises(SceneError, match=r"must have 10 different nodes; 1 of 1 have not"):
        Part(shape="mesh", file=file, material=ELASTIC).placed()
    curved = PLACES.copy()
    curved[4:7, 2] += (0.45, 0.4, 0.38)  # the face 012 bulges to the corner 3
    file = write_file(tmp_path, "c.inp", abaqus(curved))
    with pytest.raises(SceneError, match="so curved it is; found -"):
        Part(shape="mesh", file=file, material=ELASTIC).placed()


def test_a_flat_element_is_noted(tmp_path):
    flat = np.concatenate([CORNERS, CORNERS[EDGES].mean(axis=1)]) * np.array([1.0, 1.0, 0.02])
    file = write_file(tmp_path, "a.inp", abaqus(flat))
    notes = Part(shape="mesh", file=file, material=ELASTIC).placed().notes
    assert any("1 of 1 elements are badly shaped" in note for note in notes)


def test_four_nodes_are_raised_to_ten_with_a_note(tmp_path):
    node, corner = box((2, 1, 1))
    used = np.unique(corner[:, :4])
    clamp = used[node[used, 0] < 1e-9]
    file = write_mesh(
        tmp_path / "a.inp", node[: used.max() + 1], corner[:, :4], "tetra",
        point_sets={"clamp": clamp},
    )  # fmt: skip
    mesh = read(file)
    assert len(mesh.node) == len(node) and mesh.corner.shape == corner.shape
    np.testing.assert_allclose(
        mesh.node[mesh.corner[:, 4:]], mesh.node[mesh.corner[:, EDGES]].mean(axis=2)
    )
    new = len(node) - used.max() - 1
    assert any(f"12 tetrahedra of four nodes got {new} more" in note for note in mesh.notes)
    assert len(mesh.sets["clamp"]) == (node[:, 0] < 1e-9).sum() == 9
    plate = FePlate(FePlateParams(parts=(Part(shape="mesh", file=file, material=ELASTIC),)))
    assert plate.built.volume.sum() == pytest.approx(1.0, rel=1e-12)


TET4 = "       1       1       1       2       3       4       4       4       4       4\n"
OLD = "       1       1       1       2       3       3       4       4       4       4\n"
TEN = "       1       1\n" + "".join(f"{k:8d}" for k in (1, 2, 3, *[4] * 7)) + "\n"


@pytest.mark.parametrize("line", [TET4, OLD, TEN])
@pytest.mark.parametrize("keyword", ["*ELEMENT_SOLID", "*ELEMENT_SOLID_TET4TOTET10"])
def test_four_nodes_of_ls_dyna_are_raised_and_have_velocities(line, keyword, tmp_path):
    nodes = node_lines(CORNERS)
    text = f"*KEYWORD\n*NODE\n{nodes}{keyword}\n{line}*INITIAL_VELOCITY_NODE\n1,0.,0.,4.\n*END\n"
    mesh = read(write_file(tmp_path, "a.k", text))
    assert mesh.corner.shape == (1, 10)
    np.testing.assert_allclose(mesh.velocity[mesh.corner[0], 2], [4, 0, 0, 0, 2, 0, 2, 2, 0, 0])
    assert point_volumes(mesh.node, mesh.corner).sum() == pytest.approx(0.5, rel=1e-12)


def test_sets_of_faces_name_their_nodes():
    """As the physical surfaces of Gmsh do."""
    mesh = read(str(CANTILEVER / "coarse.msh"))
    assert set(mesh.sets) == {"clamp", "end"} and set(mesh.groups) == {"beam"}
    for name, place in (("clamp", 0.0), ("end", 0.1)):
        nodes = np.flatnonzero(np.isclose(mesh.node[:, 0], place))
        assert np.array_equal(mesh.sets[name], nodes) and len(nodes) == 13
    assert any("its set clamp of faces or edges names the 13 nodes" in n for n in mesh.notes)


def first_order_mesh(folder):
    """The cantilever's mesh with elements of the first order."""
    lines, lower_order, remaining = [], {"8": (1, 2), "9": (2, 3), "11": (4, 4), "15": (15, 1)}, 0
    nodes = 0
    text = (CANTILEVER / "coarse.msh").read_text()
    before, after = text.split("$Elements\n")
    head, *rows = after.splitlines()
    for row in rows:
        words = row.split()
        if remaining:
            lines.append(" ".join(words[: 1 + nodes]))
            remaining -= 1
        elif row.startswith("$"):
            lines.append(row)
        else:
            kind, nodes = lower_order[words[2]]
            lines.append(f"{words[0]} {words[1]} {kind} {words[3]}")
            remaining = int(words[3])
    return write_file(folder, "four.msh", before + "\n".join(["$Elements", head, *lines, ""]))


def test_sets_of_faces_of_four_nodes_have_their_midside_nodes(tmp_path):
    mesh, second_order = read(first_order_mesh(tmp_path)), read(str(CANTILEVER / "coarse.msh"))
    assert len(mesh.node) == len(second_order.node)
    for name, place in (("clamp", 0.0), ("end", 0.1)):
        nodes = np.flatnonzero(np.isclose(mesh.node[:, 0], place))
        assert np.array_equal(mesh.sets[name], nodes) and len(nodes) == 13 == len(
            second_order.sets[name]
        )


@pytest.mark.parametrize("order", [1, 2])
def test_chosen_parts_keep_the_sets_of_faces_on_them(order, tmp_path):
    file = first_order_mesh(tmp_path) if order == 1 else str(CANTILEVER / "coarse.msh")
    mesh = read(file, parts=("beam",))
    assert {name: len(nodes) for name, nodes in mesh.sets.items()} == {"clamp": 13, "end": 13}


def test_physical_names_of_gmsh_2_are_sets(tmp_path):
    names = '$PhysicalNames\n2\n2 1 "clamp"\n3 1 "beam"\n$EndPhysicalNames\n$Nodes'
    text = gmsh(PLACES).replace("$Nodes", names, 1)
    text = text.replace("$Elements\n1\n", "$Elements\n2\n2 9 2 1 1 1 2 3 5 6 7\n")
    mesh = read(write_file(tmp_path, "a.msh", text))
    assert mesh.groups["beam"].tolist() == [0]
    np.testing.assert_allclose(
        np.sort(mesh.node[mesh.sets["clamp"]], axis=0),
        np.sort(PLACES[[0, 1, 2, 4, 5, 6]], axis=0),
    )


def test_a_set_of_corners_alone_is_noted(tmp_path):
    node, corner = box((2, 1, 1))
    clamp = np.flatnonzero(node[:, 0] < 1e-9)
    corners = np.intersect1d(clamp, corner[:, :4])
    file = write_mesh(tmp_path / "a.inp", node, corner, point_sets={"c": corners, "all": clamp})
    notes = [note for note in read(file).notes if "lacks" in note]
    assert len(notes) == 1 and "its set c has all corners of 2 outer faces" in notes[0]
    assert "lacks 5 nodes in the middles" in notes[0]


def test_the_flattest_elements_have_a_small_radius_ratio():
    """Four corners near a circle: the radius of the sphere around is lost in rounding."""
    for seed in range(50):
        rng = np.random.default_rng(seed)
        angle = np.sort(rng.uniform(0.0, 2.0 * np.pi, 4))
        corners = np.stack([np.cos(angle), np.sin(angle), 1e-9 * rng.uniform(-1, 1, 4)], axis=1)
        volumes = np.abs(np.linalg.det(corners[1:] - corners[0]))
        assert 0.0 <= radius_ratio(corners[None], np.array([volumes]))[0] < POOR


def test_a_check_refuses_tetrahedra_beside_hexahedra():
    parts = [
        Part(
            lowest=(x, 0.0, 0.0), highest=(x + 1.0, 1.0, 1.0), elements=(8, 8, 8),
            tetrahedra=x > 0.0, material=ELASTIC,
        )
        for x in (0.0, 3.0)
    ]  # fmt: skip
    with pytest.raises(SceneError, match=r"hexahedra in parts.0 and tetrahedra in parts.1"):
        plan(FePlateParams(parts=tuple(parts)))


def test_what_an_empty_set_needs_is_said():
    part = Part(lowest=(0.0,) * 3, highest=(1.0,) * 3, elements=(8, 8, 8), material=ELASTIC)
    sets = (NodeSet(name="edge", lowest=(0.0,) * 3, highest=(0.0, 0.0, 1.0)),)
    faces = (Faces(node_set="edge"),)
    with pytest.raises(SceneError, match=r"none does. Correct the set edge.$"):
        FePlate(FePlateParams(parts=(part,), node_sets=sets, coupled_faces=faces))


def test_selections_take_whole_faces_of_six_nodes(tmp_path):
    """Four triangles each: 8 of the end; half of a face is none."""
    file = write_mesh(tmp_path / "a.vtk", *box((2, 1, 1)))
    part = Part(shape="mesh", file=file, material=ELASTIC)

    def faces(low, high):
        selection = Faces(lowest=low, highest=high)
        return len(FePlate(FePlateParams(parts=(part,), coupled_faces=(selection,))).faces)

    assert faces((0.0, 0.0, 0.0), (0.0, 1.0, 1.0)) == 8
    all_faces = faces((0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
    assert all_faces == 4 * 2 * 10
    assert faces((0.0, 0.0, 0.0), (0.0, 1.0, 1.0)) == faces((0.0, 0.0, 0.0), (0.24, 1.0, 1.0))


def test_heat_through_tetrahedra_is_refused(tmp_path):
    file = write_mesh(tmp_path / "a.vtk", *regular())
    part = ConductingPart(shape="mesh", file=file, conductivity=1.0)
    with pytest.raises(SceneError, match=r"a.vtk must have 8-node solids.*found tetrahedra"):
        part.placed()


def test_a_clamp_by_a_box_holds_midside_nodes_too(tmp_path):
    file = write_mesh(tmp_path / "a.vtk", *box((2, 1, 1)))
    part = Part(shape="mesh", file=file, material=ELASTIC)
    fixed = (Fixed(lowest=(0.0, 0.0, 0.0), highest=(0.0, 1.0, 1.0)),)
    plate = FePlate(FePlateParams(parts=(part,), fixed=fixed))
    assert (plate.model.free == 0).all(axis=1).sum() == 9
    assert len(plate.walls()["points"]) == 4
