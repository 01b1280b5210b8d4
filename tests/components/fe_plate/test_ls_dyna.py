"""Meshes in LS-DYNA keyword files: formats, parts, sets, velocities, and what is refused."""

import numpy as np
import pytest

from quintet.components.fe_plate.component import FePlate
from quintet.components.fe_plate.meshes.files import read
from quintet.components.fe_plate.meshes.params import Part
from quintet.components.fe_plate.meshes.selections import Elements, Fixed
from quintet.components.fe_plate.params import FePlateParams, Gauges
from quintet.components.shared.materials.params import Material
from quintet.interfaces.errors import SceneError

ELASTIC = Material(density=2700.0, youngs_modulus=7e10, poissons_ratio=0.3)
# Two cubes of 10 mm side by side that share no node; nodes are not numbered in a row.
CUBE = [(x, y, z) for z in (0, 10) for x, y in ((0, 0), (10, 0), (10, 10), (0, 10))]
PLACES = [(float(x + shift), float(y), float(z)) for shift in (0, 20) for x, y, z in CUBE]
NODES = [101 + 2 * k for k in range(16)]
FIRST, SECOND = NODES[:8], NODES[8:]


def nodes(form="{:8d}{:16.8f}{:16.8f}{:16.8f}", **changed):
    return "".join(form.format(n, *p) + "\n" for n, p in zip(NODES, PLACES, strict=True))


def solids(width=8, two_lines=False):
    text = ""
    for number, part, corners in ((7, 3, FIRST), (9, 4, SECOND)):
        head = "".join(f"{n:{width}d}" for n in (number, part))
        text += head + ("\n" if two_lines else "")
        text += "".join(f"{n:{width}d}" for n in corners) + "\n"
    return text


BOTH = (
    f"*KEYWORD\n$ a comment\n*NODE\n{nodes()}*ELEMENT_SOLID\n{solids()}"
    "*PART\nBar\n         3         1         1\nFoot, new\n         4         1         1\n"
)


def write_file(tmp_path, text, name="two.k"):
    (tmp_path / name).write_text(text)
    return str(tmp_path / name)


def plate_of(file, *, parts=(), velocity=None, scale=1e-3, time_scale=1.0, **keys):
    part = Part(
        shape="mesh", file=file, scale=scale, material=ELASTIC, parts=parts, velocity=velocity,
        time_scale=time_scale,
    )  # fmt: skip
    return FePlate(FePlateParams(parts=(part,), **keys))


FREE = "".join(f"{n}, {x!r},{y!r} , {z!r}\n" for n, (x, y, z) in zip(NODES, PLACES, strict=True))
LONG = "{:20d}{:20.13e}{:20.13e}{:20.13e}"
TEN = "{:10d}{:16.8f}{:16.8f}{:16.8f}"
FORMS = {
    "fixed": BOTH,
    "two lines": f"*keyword\n*node\n{nodes()}*element_solid\n{solids(two_lines=True)}*end\nrest",
    "two lines as LS-PrePost writes": (
        f"*KEYWORD\n*NODE\n{nodes()}*ELEMENT_SOLID (ten nodes format)\n{solids(two_lines=True)}"
    ),
    "free": f"*KEYWORD\n*NODE\n{FREE}*ELEMENT_SOLID\n"
    + "".join(f"{e},{p},{','.join(map(str, c))}\n" for e, p, c in ((7, 3, FIRST), (9, 4, SECOND))),
    "long": f"*KEYWORD long=y\n*NODE\n{nodes(LONG)}*ELEMENT_SOLID\n{solids(20)}",
    "one long": f"*KEYWORD\n*NODE +\n{nodes(LONG)}*ELEMENT_SOLID\n{solids()}",
    "one standard": f"*KEYWORD long=y\n*NODE -\n{nodes()}*ELEMENT_SOLID\n{solids(20)}",
    "ten": f"*KEYWORD i10=y\n*NODE\n{nodes(TEN)}*ELEMENT_SOLID%\n{solids(10)}",
}


@pytest.mark.parametrize("text", FORMS.values(), ids=FORMS)
def test_every_format_gives_the_same_mesh(tmp_path, text):
    mesh = read(write_file(tmp_path, text))
    assert mesh.node.tolist() == [list(place) for place in PLACES]
    assert mesh.corner.tolist() == [list(range(8)), list(range(8, 16))]


def test_numbers_of_fortran_are_read(tmp_path):
    text = BOTH.replace(f"{10.0:16.8f}", f"{'1.0D+1':>16}", 1).replace(
        f"{10.0:16.8f}", f"{'1.0+1':>16}", 1
    )
    assert read(write_file(tmp_path, text)).node.tolist() == [list(place) for place in PLACES]


def test_files_include_others_below_their_folder(tmp_path):
    (tmp_path / "below").mkdir()
    write_file(tmp_path, f"*NODE\n{nodes()}*INCLUDE\nsolids.key\n", "below/nodes.k")
    write_file(tmp_path, f"*ELEMENT_SOLID\n{solids()}", "below/solids.key")
    file = write_file(tmp_path, "*KEYWORD\n*INCLUDE\nbelow/nodes.k\n*END\n")
    assert len(read(file).corner) == 2
    recursive = write_file(tmp_path, "*KEYWORD\n*INCLUDE\nagain.k\n", "again.k")
    with pytest.raises(SceneError, match=r"again.k, line 3: a file must not include itself"):
        read(recursive)
    outside = write_file(tmp_path, "*KEYWORD\n*INCLUDE\n../../two.k\n", "below/outside.k")
    with pytest.raises(SceneError, match=r"outside.k, line 3: \*INCLUDE must name a file in the"):
        read(outside)


SETS = (
    "*SET_NODE_LIST_TITLE\nleft, face\n         5\n"
    + "".join(f"{n:10d}" for n in FIRST[:4])
    + "\n*SET_NODE_LIST_GENERATE\n         6\n       100       104       130       131\n"
    "*SET_PART_LIST_TITLE\nboth\n         1\n         3         4\n"
    "*SET_SOLID\n         2\n         9\n"
)


def test_sets_and_parts_have_names_and_numbers(tmp_path):
    mesh = read(write_file(tmp_path, BOTH + SETS))
    assert mesh.sets["left, face"].tolist() == mesh.sets["5"].tolist() == [0, 1, 2, 3]
    assert mesh.sets["6"].tolist() == [0, 1, 15]  # 101, 103, and 131
    groups = {key: rows.tolist() for key, rows in mesh.groups.items()}
    assert groups["Bar"] == groups["part 3"] == [0]
    assert groups["Foot, new"] == groups["solid set 2"] == [1]
    assert groups["both"] == groups["part set 1"] == [0, 1]


def test_a_scene_chooses_nodes_and_elements_by_sets_of_the_file(tmp_path):
    plate = plate_of(
        write_file(tmp_path, BOTH + SETS),
        fixed=(Fixed(node_set="left, face"),),
        gauges=Gauges(element_set_gauges=(Elements(element_set="Foot, new"),)),
    )
    assert (plate.model.free == 0).all(axis=1).nonzero()[0].tolist() == [0, 1, 2, 3]
    assert [elements.rows.tolist() for elements in plate.measured.element_sets] == [[1]]


def test_a_title_of_two_parts_is_no_name(tmp_path):
    text = BOTH.replace("Foot, new", "Bar")
    mesh = read(write_file(tmp_path, text))
    assert "Bar" not in mesh.groups and mesh.groups["part 3"].tolist() == [0]
    assert any("titles of several parts or sets are no names: Bar" in note for note in mesh.notes)


@pytest.mark.parametrize("part", [4, "4", "part 4", "Foot, new"])
def test_parts_are_chosen_by_number_or_title(tmp_path, part):
    mesh = read(write_file(tmp_path, BOTH + SETS), "refuse", (part,))
    assert mesh.node.tolist() == [list(place) for place in PLACES[8:]]
    assert mesh.groups["both"].tolist() == [0] and mesh.groups["part 3"].tolist() == []
    assert any("1 elements of other parts are left out" in note for note in mesh.notes)


def test_a_part_that_the_file_lacks_is_refused(tmp_path):
    with pytest.raises(SceneError, match=r"part Baar.*Bar"):
        read(write_file(tmp_path, BOTH), "refuse", ("Baar",))


def test_parts_are_of_a_mesh_alone():
    with pytest.raises(ValueError, match=r"parts is for a mesh from a file; found \['Bar'\]"):
        Part(
            lowest=(0.0,) * 3, highest=(1.0,) * 3, elements=(1, 1, 1), material=ELASTIC,
            parts=("Bar",),
        )  # fmt: skip


def test_other_elements_are_refused_unless_parts_are_chosen(tmp_path):
    beams = "*ELEMENT_BEAM\n       1       5     101     103\n"
    file = write_file(tmp_path, BOTH + beams)
    with pytest.raises(
        SceneError, match=r"no other elements than solids.*keywords: 1 \*ELEMENT_BEAM"
    ):
        read(file)
    assert len(read(file, "refuse", (3,)).corner) == 1
    shell = "*ELEMENT_SHELL\n       1       5     101     103     105     107\n"
    notes = read(write_file(tmp_path, BOTH + shell, "shell.k")).notes
    assert any("1 quad lie on faces of its solids. They name nodes" in note for note in notes)
    apart = shell.replace("     107", "     201") + "*NODE\n     201    5.0 5.0 5.0\n"
    apart = apart.replace("    5.0 5.0 5.0", f"{5.0:16.3f}{5.0:16.3f}{5.0:16.3f}")
    with pytest.raises(SceneError, match="must have no shells or beams"):
        read(write_file(tmp_path, BOTH + apart, "apart.k"))


def test_what_is_not_read_is_listed_with_its_count(tmp_path):
    text = BOTH.replace(f"{101:8d}", f"{101:8d}", 1)
    head = f"{101:8d}" + f"{0.0:16.8f}" * 3
    text = text.replace(head, head + f"{7:8d}{0:8d}", 1)
    text += "*MAT_ELASTIC\n1,2\n*BOUNDARY_SPC_NODE\n1\n*MAT_ELASTIC\n2,2\n*PART_CONTACT\nx\n1\n"
    notes = " ".join(read(write_file(tmp_path, text)).notes)
    assert "not read: 1 *BOUNDARY_SPC_NODE, 2 *MAT_ELASTIC, 1 *PART_CONTACT." in notes
    assert "1 nodes have constraints TC or RC" in notes


def initial_velocity(tmp_path, text, **keys):
    return plate_of(write_file(tmp_path, BOTH + SETS + text), **keys).state.velocity


def test_all_nodes_move_but_those_of_a_second_set(tmp_path):
    text = f"*INITIAL_VELOCITY\n         0         5\n{2.0:10.1f}\n{3.0:10.1f}\n"
    text += f"*INITIAL_VELOCITY_NODE\n{101:10d}{0.0:10.1f}{4.0:10.1f}\n"
    velocity = initial_velocity(tmp_path, text, time_scale=1e-3)  # mm and ms
    assert velocity[8:].tolist() == [[2.0, 0.0, 0.0]] * 8
    assert velocity[1:4].tolist() == [[3.0, 0.0, 0.0]] * 3
    assert velocity[0].tolist() == [0.0, 4.0, 0.0]


@pytest.mark.parametrize(
    ("selection", "rows"),
    [("4,2", range(8, 16)), ("1,1", range(16)), ("5,3", range(4)), ("0,2", range(16))],
)
def test_generated_velocities_are_of_parts_or_sets(tmp_path, selection, rows):
    text = f"*INITIAL_VELOCITY_GENERATION\n{selection},,1.,,\n0.,\n"
    velocity = initial_velocity(tmp_path, text, scale=1.0)
    assert np.flatnonzero(velocity.any(axis=1)).tolist() == list(rows)
    assert velocity[rows[0]].tolist() == [1.0, 0.0, 0.0]


def test_generated_velocities_turn_about_an_axis(tmp_path):
    text = "*INITIAL_VELOCITY_GENERATION\n3,2,2.,1.,,\n10.,0.,0.,0.,0.,5.\n"
    velocity = initial_velocity(tmp_path, text, scale=1.0)
    places = np.array(PLACES[:8])
    expected = [(1.0 - 2.0 * y, 2.0 * (x - 10.0), 0.0) for x, y, _ in places]
    assert velocity[:8].tolist() == [list(v) for v in expected]
    assert not velocity[8:].any()


def test_the_scene_may_replace_velocities_of_the_file(tmp_path):
    file = write_file(tmp_path, BOTH + "*INITIAL_VELOCITY\n0\n1.,\n")
    plate = plate_of(file, scale=1.0)
    assert plate.state.velocity.tolist() == [[1.0, 0.0, 0.0]] * 16
    assert any("velocities of 16 nodes are the file's, up to 1 m/s" in n for n in plate.notes())
    plate = plate_of(file, velocity=(0.0, 0.0, 0.0))
    assert not plate.state.velocity.any()
    assert any("velocities of 16 nodes are not used, for the scene" in n for n in plate.notes())


def bad(old, new, text=BOTH):
    assert old in text
    return text.replace(old, new, 1)


LINE = f"{7:8d}{3:8d}" + "".join(f"{n:8d}" for n in FIRST)
TET = f"{7:8d}{3:8d}" + "".join(f"{n:8d}" for n in [*FIRST[:3], *[FIRST[5]] * 5])
ODD = f"{7:8d}{3:8d}" + "".join(f"{n:8d}" for n in [FIRST[0], *FIRST[:3], *[FIRST[3]] * 4])
WEDGE = f"{7:8d}{3:8d}" + "".join(f"{n:8d}" for n in [*FIRST[:4], *[FIRST[4]] * 2, *[FIRST[5]] * 2])
TEN_NODES = f"{7:8d}{3:8d}\n" + "".join(f"{n:8d}" for n in NODES[:10])
DEFECTS = {
    "no keyword": ("solid\n", "line 1: data must stand below a keyword; found solid"),
    "no number": (bad(f"{10.0:16.8f}", f"{'ten':>16}"), "line 5: X must be a finite n.*found ten"),
    "not finite": (bad(f"{10.0:16.8f}", f"{'nan':>16}"), "line 5: X must be a finite.*found nan"),
    "too large": (bad(f"{10.0:16.8f}", f"{'1+999':>16}"), "line 5: X must be a fin.*found 1.999"),
    "underscore": (bad(f"{10.0:16.8f}", f"{'1_0':>16}"), "line 5: X must be a fin.*found 1_0"),
    "whole underscore": (bad(f"{7:8d}{3:8d}", f"{'1_1':>8}{3:8d}"), "line 21: EID .*found 1_1"),
    "65 bits": (
        BOTH + f"*NODE\n{2**63},0.,0.,0.\n",
        "line 29: NID must be a whole number of 64 bits; found 9223372036854775808",
    ),
    "parameter": (bad(f"{7:8d}{3:8d}", f"{7:8d}{'&part':>8}"), "line 21: PID must be a whole"),
    "tabulator": (
        bad(f"{7:8d}{3:8d}", "\t7\t3"),
        "line 21: .* fixed columns; found a tab character",
    ),
    "node twice": (bad(f"{103:8d}", f"{101:8d}"), "line 5: nodes must have .*found two 101, the"),
    "solid twice": (bad(f"{9:8d}{4:8d}", f"{7:8d}{4:8d}"), "line 22: solids must have .*two 7"),
    "no such node": (bad(f"{3:8d}{101:8d}", f"{3:8d}{99:8d}"), "line 21: .*nodes of the file; fo"),
    "odd tetrahedron": (bad(LINE, ODD), "line 21: solid 7 must have 8 .*in another order"),
    "wedge": (bad(LINE, WEDGE), "line 21: solid 7 must have 8 .*found a wedge"),
    "no nodes": (bad(LINE, "") + f"*ELEMENT_SOLID\n{5:8d}{3:8d}\n", "line 29: a solid must have n"),
    "other solid": (BOTH.replace("_SOLID", "_SOLID_ORTHO"), r"line 20: solids must be \*ELEM"),
    "title alone": (BOTH + "*PART\nalone\n", r"line 29: a title of \*PART must have a card"),
    "set member": (BOTH + "*SET_NODE\n1\n100,101\n", "line 29: a set must list nodes .*found 100"),
    "set twice": (BOTH + "*SET_NODE\n1\n*SET_NODE_LIST\n1\n", "line 31: sets of .*two 1, the firs"),
    "set number": (BOTH + "*SET_NODE\n", "line 28: a set must have a number; found none"),
    "long": (BOTH.replace("*KEYWORD", "*KEYWORD LONG=K"), "line 1: .*has long=y.*found .*LONG=K"),
    "transform": (BOTH + "*INCLUDE_TRANSFORM\na.k\n", r"line 28: .*found \*INCLUDE_TRANSFORM"),
    "velocity of none": (
        BOTH + "*INITIAL_VELOCITY\n8\n1.,\n",
        "line 29: a velocity must be of a set of nodes of the file; found 8",
    ),
    "half a velocity": (BOTH + "*INITIAL_VELOCITY\n0\n", "line 29: a card of velocities must foll"),
    "velocity in a box": (BOTH + "*INITIAL_VELOCITY\n0,0,4\n1.,\n", "line 29: BOXID .*found 4"),
    "velocity of a node": (BOTH + "*INITIAL_VELOCITY_NODE\n9,1.\n", "line 29: NID must be a node"),
    "styp": (BOTH + "*INITIAL_VELOCITY_GENERATION\n3,5\n0.,\n", "line 29: STYP must be 1, 2 or 3"),
    "velocity of no part": (
        BOTH + "*INITIAL_VELOCITY_GENERATION\n5,2,,1.\n0.,\n",
        "line 29: a velocity must be of a part of the file; found 5, which is none",
    ),
    "velocity of no part of a set": (
        BOTH + "*SET_PART\n1\n3,5\n*INITIAL_VELOCITY_GENERATION\n1,1,,1.\n0.,\n",
        "line 29: a set must list parts of the file; found 5, which is none",
    ),
    "velocity of an empty range": (
        BOTH + "*SET_PART_LIST_GENERATE\n1\n5,9\n*INITIAL_VELOCITY_GENERATION\n1,1,,1.\n0.,\n",
        "line 32: a velocity must be of parts of the file; found part set 1, which lists none",
    ),
    "later": (
        BOTH + "*INITIAL_VELOCITY_GENERATION\n3,2\n,,,,,,1\n",
        "line 30: PHASE of initial velocities is not read and must be 0; found 1",
    ),
    "no axis": (
        BOTH + "*INITIAL_VELOCITY_GENERATION\n3,2,5.\n0.,\n",
        r"line 30: the axis of a rotation .*found \[0.0, 0.0, 0.0\]",
    ),
    "one card": (BOTH + "*INITIAL_VELOCITY_GENERATION\n3,2\n", "line 28: .*two cards for each"),
    "two ways": (
        BOTH + "*INITIAL_VELOCITY_GENERATION\n3,2\n0.,\n*INITIAL_VELOCITY\n0\n1.,\n",
        "line 28: .*must stand without other keywords of velocities",
    ),
}


@pytest.mark.parametrize(("line", "kind"), [(TET, "tetra"), (TEN_NODES, "tetra10")])
def test_tetrahedra_beside_hexahedra_are_refused_unless_parts_are_chosen(line, kind, tmp_path):
    file = write_file(tmp_path, bad(LINE, line))
    with pytest.raises(SceneError, match=f"no other solids than hex.*found 1 {kind} beside 1 hexa"):
        read(file)
    assert read(file, parts=("Foot, new",)).corner.shape == (1, 8)
    assert read(file, parts=("Bar",)).corner.shape == (1, 10)


@pytest.mark.parametrize(("text", "reason"), DEFECTS.values(), ids=DEFECTS)
def test_defects_are_named_with_their_line(tmp_path, text, reason):
    with pytest.raises(SceneError, match=f"file two.k, {reason}"):
        read(write_file(tmp_path, text))


def test_degenerate_solids_of_parts_that_are_not_chosen_are_left_out(tmp_path):
    mesh = read(write_file(tmp_path, bad(LINE, TET)), "refuse", (4,))
    assert len(mesh.corner) == 1


def test_a_file_without_solids_is_refused(tmp_path):
    with pytest.raises(SceneError, match=r"must have elements of kind hexahedron, .*; found none"):
        read(write_file(tmp_path, f"*KEYWORD\n*NODE\n{nodes()}"))
