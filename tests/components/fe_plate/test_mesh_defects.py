"""Files of meshes that would lose or spoil elements are refused, or say what is left out."""

import meshio
import numpy as np
import pytest

from quintet.components.fe_plate.component import FePlate
from quintet.components.fe_plate.heat.component import FeHeat
from quintet.components.fe_plate.heat.params import ConductingPart, FeHeatParams
from quintet.components.fe_plate.meshes.files import read
from quintet.components.fe_plate.meshes.params import Part
from quintet.components.fe_plate.meshes.selections import NodeSet
from quintet.components.fe_plate.params import FePlateParams
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import read as read_params

CUBE = np.array(
    [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)], float
)
ONE = np.arange(8)[None]
CORNERS = "1, 2, 3, 4, 5, 6, 7, 8"


def write(tmp_path, node, cells, name="block.vtk", **keys):
    meshio.Mesh(node, cells, **keys).write(tmp_path / name)
    return str(tmp_path / name)


def part_of_file(file, **keys):
    return Part(shape="mesh", file=file, material="steel", **keys)


def count(file, **keys):
    return part_of_file(file, **keys).count


@pytest.mark.parametrize(
    ("kind", "nodes"),
    [("tetra", 4), ("wedge", 6), ("pyramid", 5), ("tetra10", 10), ("hexahedron20", 20)],
)
def test_a_mesh_of_mixed_solids_is_refused(tmp_path, kind, nodes):
    node = np.concatenate([CUBE, np.random.default_rng(1).random((nodes, 3)) + 2.0])
    cells = [("hexahedron", ONE), (kind, 8 + np.arange(nodes)[None])]
    file = write(tmp_path, node, cells)
    with pytest.raises(SceneError, match=f"found 1 {kind} beside 1 hexahedron"):
        count(file)
    part = ConductingPart(shape="mesh", file=file, conductivity=1.0)
    with pytest.raises(SceneError, match=f"found 1 {kind} beside 1 hexahedron"):
        FeHeat(FeHeatParams(parts=(part,), steady=True))


def test_solids_of_second_order_alone_are_refused_with_their_number(tmp_path):
    node = np.random.default_rng(1).random((20, 3))
    file = write(tmp_path, node, [("hexahedron20", np.arange(20)[None])])
    with pytest.raises(SceneError, match="found 1 hexahedron20"):
        count(file)


def test_shells_and_beams_beside_solids_are_refused(tmp_path):
    node = np.concatenate([CUBE, CUBE + 2.0])
    cells = [("hexahedron", ONE), ("quad", [[1, 2, 9, 10]]), ("line", [[8, 9]])]
    with pytest.raises(SceneError, match="found 1 line, 1 quad with nodes"):
        count(write(tmp_path, node, cells))


def test_faces_that_mark_solids_are_left_out_with_a_note(tmp_path):
    file = write(tmp_path, CUBE, [("hexahedron", ONE), ("quad", ONE[:, :4])])
    structure = FePlate(FePlateParams(parts=(part_of_file(file),)))
    assert any("1 quad lie on faces of its solids" in note for note in structure.notes())


def test_all_blocks_of_solids_are_read(tmp_path):
    node = np.concatenate([CUBE, CUBE + np.array([5.0, 0.0, 0.0]), CUBE - 5.0])
    cells = [("hexahedron", ONE), ("hexahedron", ONE + 8), ("hexahedron", ONE + 16)]
    mesh = part_of_file(write(tmp_path, node, cells, "block.inp")).placed()
    assert len(mesh.corner) == 3
    assert any("3 pieces" in note for note in mesh.notes)


def two_cubes(tmp_path):
    node = np.concatenate([CUBE, CUBE + np.array([1.0, 0.0, 1e-6])])
    sets = {"middle": np.array([1, 2, 5, 6]), "end": np.array([9, 10])}
    return write(tmp_path, node, [("hexahedron", [*ONE, *(ONE + 8)])], "two.inp", point_sets=sets)


def test_nodes_at_one_place_are_refused_joined_or_left_as_the_scene_says(tmp_path):
    file = two_cubes(tmp_path)
    with pytest.raises(SceneError, match="found 4 such nodes"):
        count(file)
    joined, apart = read(file, "join"), read(file, "keep")
    assert len(joined.node) == 12 and len(apart.node) == 16
    assert len(np.unique(joined.corner)) == 12
    assert len(joined.sets["middle"]) == 4 and len(joined.sets["end"]) == 2
    assert any("2 pieces" in note for note in apart.notes) and not joined.notes


def test_parts_that_touch_are_refused(tmp_path):
    low = {"lowest": (0.0, 0.0, 0.0), "highest": (1.0, 1.0, 1.0), "elements": (2, 2, 2)}
    high = low | {"lowest": (1.0, 0.0, 0.0), "highest": (2.0, 1.0, 1.0)}
    parts = tuple(Part(**box, material="steel") for box in (low, high))
    with pytest.raises(SceneError, match=r"parts must not touch.*9 of their nodes"):
        FePlate(FePlateParams(parts=parts))


def test_elements_that_are_collapsed_or_turned_at_a_corner_are_refused(tmp_path):
    wedge = np.array([[0, 1, 2, 2, 4, 5, 6, 6]])
    with pytest.raises(SceneError, match="1 of 1 are collapsed"):
        count(write(tmp_path, CUBE, [("hexahedron", wedge)]))
    bent = CUBE.copy()
    bent[6] = (0.2, 0.2, 0.9)  # its volume is still above 0
    with pytest.raises(SceneError, match=r"Jacobian above 0 at each corner; .* 1 of 1"):
        count(write(tmp_path, bent, [("hexahedron", ONE)], "bent.vtk"))


def test_badly_shaped_elements_are_noted(tmp_path):
    sheared = CUBE + CUBE[:, 2:] * (10.0, 0.0, 0.0)
    mesh = part_of_file(write(tmp_path, sheared, [("hexahedron", ONE)])).placed()
    assert any("1 of 1 elements are badly shaped" in note for note in mesh.notes)


def test_coordinates_that_are_not_finite_are_refused(tmp_path):
    node = CUBE.copy()
    node[3, 1] = np.nan
    with pytest.raises(SceneError, match="those of 1 nodes are not"):
        count(write(tmp_path, node, [("hexahedron", ONE)]))


def test_a_mesh_in_millimetres_is_asked_for_its_unit(tmp_path):
    file = write(tmp_path, 20.0 * CUBE, [("hexahedron", ONE)])
    (note,) = part_of_file(file).placed().notes
    assert "20 x 20 x 20 m. Is that meant?" in note
    (note,) = part_of_file(file, scale=1e-3).placed().notes
    assert note.endswith("1 elements, 8 nodes, 0.02 x 0.02 x 0.02 m.")


# Entity 1 is bounded by surfaces 7, 8 and 9, which the file does not have.
GMSH = """$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
1
3 5 "bar"
$EndPhysicalNames
$Entities
0 0 0 1
1 0 0 0 1 1 1 1 5 3 7 8 9
$EndEntities
$Nodes
1 8 1 8
3 1 0 8
1
2
3
4
5
6
7
8
0 0 0
1 0 0
1 1 0
0 1 0
0 0 1
1 0 1
1 1 1
0 1 1
$EndNodes
$Elements
1 1 1 1
3 1 5 1
1 1 2 3 4 5 6 7 8
$EndElements
"""


def test_parts_of_gmsh_are_its_physical_groups(tmp_path):
    (tmp_path / "bar.msh").write_text(GMSH)
    all_parts, bar = (read(str(tmp_path / "bar.msh"), "refuse", parts) for parts in ((), ("bar",)))
    for mesh in (all_parts, bar):
        assert mesh.node.tolist() == CUBE.tolist()
        assert {key: rows.tolist() for key, rows in mesh.groups.items()} == {"bar": [0]}


def test_sets_that_lose_members_are_noted(tmp_path):
    node = np.concatenate([CUBE, [(9.0, 9.0, 9.0)]])
    sets = {"end": np.array([0, 1, 8])}
    file = write(tmp_path, node, [("hexahedron", ONE)], "block.inp", point_sets=sets)
    assert any("1 nodes of its set end" in note for note in read(file).notes)


def test_a_set_that_a_file_names_already_is_refused(tmp_path):
    file = write(
        tmp_path, CUBE, [("hexahedron", ONE)], "a.inp", point_sets={"end": np.array([0, 1])}
    )
    duplicate = NodeSet(name="end", lowest=(0.0,) * 3, highest=(0.0, 1.0, 1.0))
    part = part_of_file(file)
    with pytest.raises(SceneError, match=r"node_sets\.0: names must differ; end"):
        FePlate(FePlateParams(parts=(part,), node_sets=(duplicate,)))


def test_files_without_cells_are_refused(tmp_path):
    with pytest.raises(SceneError, match="elements of kind hexahedron, tetra10 or tetra; found"):
        count(write(tmp_path, CUBE, [("vertex", np.arange(8)[:, None])]))


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("*NODE\n1, 9., 9., 9.\n", "one block .NODE; found 2"),
        ("*NSET, NSET=end\nleft, right\n", "sets of nodes by numbers"),
        ("*NSET, NSET=left\n1\n*NSET, NSET=left\n2\n", "found 2 of .NSET left"),
        ("*INCLUDE, INPUT=other.inp\n", "no .INCLUDE"),
        (
            "*INSTANCE, NAME=a, PART=b\n0., 0., 1.\n",
            "instances without a translation or rotation; found one with it",
        ),
        ("*ELSET, ELSET=bar\nleft, right\n", "sets of elements by numbers; found names in bar"),
        ("*ELGEN, ELSET=bar\n1, 3, 4, 1\n", "written out; found .ELGEN"),
        ("*SYSTEM\n1., 0., 0.\n", "in the coordinates of the file; found .SYSTEM"),
        ("*NODE, SYSTEM=c\n9, 9., 9., 9.\n", "rectangular coordinates; found SYSTEM=C"),
        (f"*ELEMENT, TYPE=C3D8, ELSET=bar\n2, {CORNERS}\n", "in each .ELEMENT, or in none"),
        (2 * f"*ELEMENT, TYPE=C3D8, ELSET=bar\n2, {CORNERS}\n", "found 2 of .ELEMENT bar"),
        (f"*ELSET, ELSET=bar\n1\n*ELEMENT, TYPE=C3D8\n2, {CORNERS}\n", "ELSET bar above some"),
    ],
)
@pytest.mark.parametrize("name", ["block.inp", "block.INP"])
def test_abaqus_files_that_the_reader_would_misread_are_refused(tmp_path, name, text, reason):
    file = write(tmp_path, CUBE, [("hexahedron", ONE)], name)
    with open(file, "a") as end:
        end.write(text)
    with pytest.raises(SceneError, match=reason):
        count(file)


@pytest.mark.parametrize(
    ("system", "text", "reason"),
    [("5", "", "found 8 in others, as 5"), ("0", "INCLUDE 'more.bdf'\n", "line 10: .* INCLUDE")],
)
def test_nastran_files_that_the_reader_would_misread_are_refused(tmp_path, system, text, reason):
    places = [",".join(map(str, row)) for row in CUBE.tolist()]
    nodes = [f"GRID,{k},{system},{place}\n" for k, place in enumerate(places, 1)]
    element = "CHEXA,1,1,1,2,3,4,5,6,+\n+,7,8\n"
    file = tmp_path / "block.bdf"
    file.write_text("BEGIN BULK\n" + "".join(nodes) + text + element + "ENDDATA\n")
    with pytest.raises(SceneError, match=reason):
        count(str(file))


@pytest.mark.parametrize(
    ("key", "table", "new_keys"),
    [
        ("cylinder", {"radius": 0.1, "length": 1.0, "elements": [1, 1, 1]}, "base, top, radius"),
        ("mesh", {"file": "block.inp"}, "file, scale"),
    ],
)
def test_old_keys_of_shapes_are_refused_with_the_new_ones(key, table, new_keys):
    part = {key: table, "material": "steel"}
    _, (mistake,) = read_params(FePlateParams, {"parts": [part]}, "bar")
    assert f'parts.0.{key} is now shape = "{key}", with {new_keys}' in mistake
