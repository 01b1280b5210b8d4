"""The steel bar with its mesh in files of other codes: the same bits as with the built-in mesh.

The bits depend on the places of the nodes to their last digit, on the order of nodes, elements and
corners, and on `integration`, which "auto" chooses by the layers of the mesh without knowing its
planes of symmetry. LS-DYNA's free format holds all digits, its columns of 16 do not.
"""

import tomllib
from pathlib import Path

import meshio
import numpy as np
import pytest

import quintet
from quintet.components.fe_plate.meshes.mesh import mesh
from quintet.components.fe_plate.meshes.params import Part
from quintet.coupler.report.diff import compare, sentence

SCENE = Path(__file__).parents[2] / "scenarios" / "taylor_bar" / "scene.toml"
SPEED = -287.0  # m/s
BAR = {
    "shape": "cylinder",
    "base": (0.0, 0.0, 0.0),
    "top": (0.0, 0.0, 0.0324),
    "radius": 0.0032,
    "elements": (2, 2, 20),
    "quarter": True,
}
BRACKETS = str.maketrans("()", "[]")
SETTINGS = {
    "end": 4e-6,
    "window": 1e-6,
    "output.interval": 0,
    "output.pictures": [],
    "output.fields": ["bar.faces.position", "bar.faces.velocity"],
    "expect": [],
    "components.bar.integration": "reduced",
}


def scene(folder, name, shape):
    """Write the scene of the bar, without its expectations, beside its mesh."""
    text = SCENE.read_text().partition("[[expect]]")[0]
    head, _, tail = text.partition('shape = "cylinder"')
    body = f"{shape}\n[output]" + tail.partition("[output]")[2]
    file = folder / f"{name}.toml"
    file.write_text(head + body)
    assert tomllib.loads(file.read_text())["components"]["bar"]["parts"]
    return file


def built_in(folder):
    lines = [f"{key} = {toml(value)}" for key, value in BAR.items()]
    return scene(folder, "built_in", "\n".join(lines))


def toml(value):
    if isinstance(value, bool):
        return str(value).lower()
    return f'"{value}"' if isinstance(value, str) else str(value).translate(BRACKETS)


def cells(bar_mesh):
    return [("hexahedron", bar_mesh.corner)]


def keywords(bar_mesh, form):
    """Text of an LS-DYNA file with a mesh that moves downwards, its lines in a form."""
    text = ["*KEYWORD", "*NODE"]
    text += [form(k + 1, *place) for k, place in enumerate(bar_mesh.node.tolist())]
    text += ["*ELEMENT_SOLID"]
    for k, corner in enumerate(bar_mesh.corner.tolist()):
        text += [",".join(map(str, (k + 1, 1, *(node + 1 for node in corner))))]
    text += ["*PART", "bar", "1,1,1", "*INITIAL_VELOCITY", "0", f"0,0,{SPEED}", "*END", ""]
    return "\n".join(text)


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """Folder with a scene for each format, and a function that runs one."""
    folder = tmp_path_factory.mktemp("bars")
    bar_mesh = mesh([Part(material="42CrMo4", **BAR)])
    for name in ("bar.inp", "bar.msh", "bar.vtk"):
        meshio.Mesh(bar_mesh.node, cells(bar_mesh)).write(folder / name)
    free = keywords(bar_mesh, lambda number, *place: ",".join([str(number), *map(repr, place)]))
    (folder / "bar.k").write_text(free)
    columns = "{:8d}{:16.9e}{:16.9e}{:16.9e}".format
    (folder / "columns.key").write_text(keywords(bar_mesh, columns))
    folders = {}

    def run(name):
        if name not in folders:
            file = built_in(folder) if name == "built_in" else of_file(folder, name)
            folders[name] = quintet.run(file, settings=SETTINGS, out=folder / f"run_{name}").folder
        return folders[name]

    return run


def of_file(folder, name):
    return scene(folder, name.replace(".", "_"), f'shape = "mesh"\nfile = "{name}"')


@pytest.mark.parametrize("name", ["bar.k", "bar.inp", "bar.msh", "bar.vtk"])
def test_a_mesh_from_a_file_gives_the_bits_of_the_built_in_one(runs, name):
    difference = compare(runs("built_in"), runs(name))
    assert difference is None, sentence(difference)


def test_velocities_of_the_file_give_the_same_bits(runs, tmp_path):
    folder = runs("bar.k").parent
    text = (folder / "bar_k.toml").read_text()
    lines = [line for line in text.splitlines() if not line.startswith("velocity")]
    (folder / "moving.toml").write_text("\n".join(lines))
    moved = quintet.run(folder / "moving.toml", settings=SETTINGS, out=tmp_path / "run")
    difference = compare(runs("built_in"), moved.folder)
    assert difference is None, sentence(difference)


def test_rounded_coordinates_change_bits_but_not_the_motion(runs):
    assert compare(runs("built_in"), runs("columns.key")) is not None
    exact, rounded = (
        quintet.load(runs(name)).fields["bar.faces.position"].values
        for name in ("built_in", "columns.key")
    )
    assert 0.0 < np.abs(exact - rounded).max() < 1e-9 * 0.0324  # ten digits were written
