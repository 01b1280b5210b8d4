"""A scene that names materials is the scene with their constants, on every path to a run."""

import json
import tomllib

import jsonschema
import pytest

from quintet.coupler.cli import main
from quintet.coupler.reference.schema import scene_schema
from quintet.coupler.scene.overrides import put_set
from quintet.coupler.scene.read import load, load_variants
from quintet.interfaces.errors import SceneError
from quintet.interfaces.materials.library import library

SCENE = """
name = "rebound"
end = 1e-4
transport = "memory"
[components.spheres]
kind = "dem_bodies"
gravity = [0.0, 0.0, 0.0]
planes = [{ point = [0.0, 0.0, 0.0], normal = [0.0, 0.0, 1.0], material = "bead" }]
materials = { bead = "glass", slick = { material = "glass", friction = 0.0 } }
[[components.spheres.bodies]]
shape = "sphere"
centre = [0.0, 0.0, 0.0101]
radius = 0.01
density = 2500.0
velocity = [0.0, 0.0, -10.0]
material = "slick"
[[study]]
label = "soft"
settings = { "components.spheres.materials.bead.youngs_modulus" = "48 GPa" }
[[study]]
label = "alumina"
settings = { "components.spheres.materials.bead" = "alumina" }
"""
NYLON = {"youngs_modulus": "3 GPa", "poissons_ratio": 0.4, "restitution": 0.5, "friction": 0.2}


@pytest.fixture
def scene(tmp_path):
    file = tmp_path / "rebound.toml"
    file.write_text(SCENE)
    return file


def materials(scene, *settings):
    checked_scene = load(str(scene), settings=settings)
    assert "materials" not in checked_scene.resolved
    return checked_scene.resolved["components"]["spheres"]["materials"]


def test_names_are_replaced_by_constants(scene):
    glass = {key: library()["glass"][key] for key in NYLON}
    assert materials(scene) == {"bead": glass, "slick": {**glass, "friction": 0.0}}


def test_a_key_of_a_named_material_can_be_set(scene):
    path = "components.spheres.materials.bead"
    assert materials(scene, f"{path}.friction=0.3")["bead"]["friction"] == 0.3
    assert materials(scene, f"{path}=alumina")["bead"]["youngs_modulus"] == 380e9


def test_variants_may_set_them_too(scene):
    _, variants = load_variants(str(scene))
    assert len(variants.study) == 2


def test_materials_of_the_scene_stand_in_a_table_or_in_a_file_beside_it(scene):
    nylon = "\n".join(f"{key} = {json.dumps(value)}" for key, value in NYLON.items())
    setting = "components.spheres.materials.bead=nylon"
    scene.write_text(f"{SCENE}\n[materials.nylon]\n{nylon}")
    in_table = materials(scene, setting)["bead"]
    assert in_table == {**NYLON, "youngs_modulus": 3e9}
    scene.write_text(f'materials = "mine.toml"\n{SCENE}')
    (scene.parent / "mine.toml").write_text(f"[nylon]\n{nylon}")
    assert materials(scene, setting)["bead"] == in_table


def test_a_key_of_a_named_gas_can_be_set():
    table = {"components": {"air": {"kind": "meshless_gas", "gas": "argon"}}}
    assert put_set(table, "components.air.gas.gamma=1.4") == []
    assert table["components"]["air"]["gas"] == {"material": "argon", "gamma": 1.4}


WRONG = {
    'materials="none.toml"': "materials: file 'none.toml' must lie beside the scene",
    f'materials="{"x" * 300}.toml"': "must lie beside the scene; in its folder there is none.",
    "materials=3": "materials must be tables by name; found 3. Write [materials.NAME].",
    "materials={nylon={youngs=1.0}}": "materials.nylon.youngs is not known. Did you mean youngs_",
    "components.spheres.materials.bead=glas": "material glas is not known. Did you mean glass?",
    "components.spheres.materials.bead=steel": "constants for this table: copper, 42CrMo4, rubber,",
    "components.spheres.materials.bead=limestone": "bead.restitution is needed. Add restitution",
}


@pytest.mark.parametrize("setting", WRONG)
def test_mistakes_are_named_with_their_place(scene, setting):
    with pytest.raises(SceneError) as error_info:
        load(str(scene), settings=[setting])
    assert WRONG[setting] in str(error_info.value)


def test_a_file_of_materials_lies_below_the_folder_of_the_scene(scene, tmp_path):
    (tmp_path / "below").mkdir()
    scene = scene.rename(tmp_path / "below/rebound.toml")
    (tmp_path / "out.toml").write_text("")
    for name in ("../out.toml", str(tmp_path / "out.toml")):
        with pytest.raises(SceneError, match=r"out.toml' must lie beside the scene; in its fold"):
            load(str(scene), settings=[f'materials="{name}"'])


def test_a_broken_file_of_materials_is_named(scene):
    (scene.parent / "mine.toml").write_text("[nylon\n")
    with pytest.raises(SceneError, match=r"mine.toml: a file of materials must be valid TOML: "):
        load(str(scene), settings=['materials="mine.toml"'])


def test_a_run_of_a_scene_with_names_leaves_their_constants(scene, tmp_path):
    with pytest.raises(SystemExit) as exit_info:
        main(["run", str(scene), "--out", str(tmp_path / "run")])
    assert exit_info.value.code == 0
    table = tomllib.loads((tmp_path / "run/scene.toml").read_text())
    bead = table["components"]["spheres"]["materials"]["bead"]
    assert bead["youngs_modulus"] == 70e9


def test_a_named_liquid_fills_density_and_viscosity():
    water = load("standing_wave", settings=["components.water.material=sea-water"], imports=False)
    keys, sea = water.resolved["components"]["water"], library()["sea-water"]
    assert keys["density"] == 1000.0  # of the scene, which goes before the material
    viscosity = tomllib.loads(water.path.read_text())["components"]["water"]["viscosity"]
    assert keys["viscosity"] == {"kinematic": sea["kinematic_viscosity"], **viscosity}


def test_editors_accept_names_in_the_place_of_tables():
    schema = scene_schema()
    scene = tomllib.loads(SCENE)
    scene["components"]["argon"] = {"kind": "meshless_gas", "gas": "argon"}
    jsonschema.validate(scene, schema)


@pytest.mark.parametrize("name", ["", *sorted(library())])
def test_the_command_prints_every_material(name, capsys):
    with pytest.raises(SystemExit) as exit_info:
        main(["materials", *([name] if name else [])])
    assert exit_info.value.code == 0
    output = capsys.readouterr().out
    assert all(material_name in output for material_name in ([name] if name else library()))
    assert not name or "[1]" in output
    with pytest.raises(SystemExit):
        main(["materials", *([name] if name else []), "--json"])
    data = json.loads(capsys.readouterr().out)
    for material in data.values():
        assert all(row["source"] and row["unit"] for row in material["constants"].values())


def test_the_command_refuses_an_unknown_name(capsys):
    with pytest.raises(SystemExit) as exit_info:
        main(["materials", "steel-4430"])
    assert exit_info.value.code == 2
    message = capsys.readouterr().err
    assert "Did you mean steel-4340?" in message
    assert "The library has" in message
