"""A scene with texts with units is the scene with their numbers, wherever they stand."""

import json
import subprocess
import sys
import tomllib
from pathlib import Path

import jsonschema
import pytest

from quintet.coupler.cli import main
from quintet.coupler.reference.schema import scene_schema
from quintet.coupler.scene.overrides import assignments
from quintet.coupler.scene.quantity_texts import units_of_keys
from quintet.coupler.scene.read import library, load, load_variants
from quintet.interfaces import libraries
from quintet.interfaces.errors import SceneError

SCENE = "dam_break_column"
TEXTS = {
    "end": ("0.67 s", 0.67),
    "window": ("1 ms", 1e-3),
    "minutes": ("90 s", 1.5),
    "output.interval": ("50 ms", 0.05),
    "output.region": (
        [["0 m", 0.3, "-20 mm"], [1.6, "61 cm", 0.5]],
        [[0, 0.3, -0.02], [1.6, 0.61, 0.5]],
    ),
    "components.water.density": ("1 g/cm3", 1000.0),
    "components.water.gravity": ([0, 0, "-981 cm/s2"], [0, 0, -9.81]),
    "components.water.boundary.walls.highest": (["1.6 m", 0.61, "750 mm"], [1.6, 0.61, 0.75]),
    "components.column.bodies.0.lowest": (["90 cm", 0.24, 0.0], [0.9, 0.24, 0.0]),
    "expect.0.from_level": ("5 N", 5.0),
    "expect.0.moving_mean": ("8 ms", 0.008),
    "expect.0.within": ("0.57 kN ms", 0.57),
}  # fmt: skip
TOY = """
name = "toy"
end = "4 ms"
window = "2 ms"
transport = "memory"
[components.a]
kind = "prescribed"
[[components.a.bodies]]
shape = "sphere"
centre = ["10 mm", 0, 0]
radius = "5 mm"
mass = "20 g"
[presets.long]
end = "6 ms"
"""


@pytest.fixture
def toy(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "toy.toml").write_text(TOY)
    return "toy.toml"


def status(*arguments):
    with pytest.raises(SystemExit) as exit_info:
        main([str(argument) for argument in arguments])
    return exit_info.value.code


@pytest.mark.parametrize("path", TEXTS)
def test_a_text_set_on_a_scene_is_its_number(path):
    text, number = TEXTS[path]
    with_text = load(SCENE, settings=assignments({path: text})).resolved
    assert with_text == load(SCENE, settings=assignments({path: number})).resolved


def test_a_kind_of_link_that_is_no_text_is_refused():
    with pytest.raises(SceneError, match=r"links.0.kind \[0.4, 0.0\] is not known"):
        load("two_springs", settings=["links.0.kind=[0.4, 0.0]"])


def test_a_word_of_the_command_line_needs_no_quotes():
    assert load(SCENE, settings=["window=1 ms"]).resolved["window"] == 1e-3


def test_the_scene_that_a_run_leaves_has_numbers(toy):
    assert status("run", toy, "--preset", "long", "--out", "out") == 0
    with open("out/scene.toml", "rb") as file:
        table = tomllib.load(file)
    assert (table["end"], table["window"]) == (0.006, 0.002)
    body = table["components"]["a"]["bodies"][0]
    assert (body["centre"], body["radius"], body["mass"]) == ([0.01, 0, 0], 0.005, 0.02)


def test_a_sweep_over_texts_is_the_sweep_over_their_numbers(toy, capsys):
    arguments = ("sweep", toy, "--out", "out", "--over")
    assert status(*arguments, "window=1 ms,2 ms", "--json", "texts.json") == 0
    assert status(*arguments, "window=1e-3,2e-3", "--json", "numbers.json") == 0
    texts, numbers = (json.loads(Path(f"{name}.json").read_text()) for name in ("texts", "numbers"))
    assert texts["over"] == numbers["over"] == {"window": [0.001, 0.002]}
    for key in ("run", "label", "settings", "status", "items"):  # not the command, nor whether kept
        assert [row[key] for row in texts["rows"]] == [row[key] for row in numbers["rows"]], key
    assert all(row["kept"] for row in numbers["rows"])


def test_the_range_of_a_limit_is_in_the_unit_of_its_parameter(toy):
    limit = '[[stability]]\nparameter = "window"\nfrom = "1 ms"\nto = "3 ms"\nend = "100 ms"\n'
    limit += "bounds = [{component = 'a', field = 'motion.position', high = 1.0}]\n"
    with open(toy, "a") as file:
        file.write(limit)
    (variant,) = load_variants(toy)[1].stability
    assert (variant.table.from_, variant.table.to, variant.end) == (0.001, 0.003, 0.1)


def test_mistakes_in_units_are_told_together(toy):
    wrong_settings = ["window=2 kg", "components.a.bodies.0.radius=5 foot_long"]
    with pytest.raises(SceneError) as error_info:
        load(toy, settings=wrong_settings)
    window, radius = error_info.value.mistakes
    assert window == (
        "toy.toml: scene.window must be in s, or in a unit of the same dimension, as in "
        "\"5 ms\"; found '2 kg'. Correct its unit."
    )
    assert radius.startswith(
        "toy.toml: components.a.bodies.0.radius: the unit of '5 foot_long' is not known."
    )


def test_without_the_library_the_error_says_what_to_install(toy, monkeypatch):
    monkeypatch.setattr(libraries, "is_installed", lambda _: False)
    with pytest.raises(SceneError, match=r"needs the library pint.*'quintet\[units\]'"):
        load(toy)


def test_a_scene_of_numbers_imports_no_library_of_units():
    code = (
        "import sys; from quintet.coupler.scene.read import load; "
        f"load({SCENE!r}); assert 'pint' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_the_schema_takes_texts_where_a_key_has_a_unit(toy):
    validator = jsonschema.Draft7Validator(scene_schema())
    table = tomllib.loads(TOY)
    assert list(validator.iter_errors(table)) == []
    for text in ("ms 2", "2", "auto "):
        assert list(validator.iter_errors({**table, "window": text}))
    assert library()


def test_a_number_that_ends_in_an_underscore_is_refused(capsys):
    with pytest.raises(SystemExit) as exit_info:
        main(["run", "two_springs", "--set", "window='2_kg'"])
    assert exit_info.value.code == 2
    message = capsys.readouterr().err
    assert "scene.window should be a valid number or 'auto'; found '2_kg'. Correct it." in message


def test_units_of_keys_are_those_of_the_parameters():
    paths = ("window", "components.water.density", "components.water.gravity", "scheme", "unknown")
    units = units_of_keys(load(SCENE), paths)
    assert units == {
        "window": "s", "components.water.density": "kg/m3", "components.water.gravity": "m/s2",
    }  # fmt: skip
