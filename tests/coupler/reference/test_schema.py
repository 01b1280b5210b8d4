"""The JSON schema takes every scene that comes with quintet, and refuses what ``check`` refuses."""

import json
import re
import tomllib
from copy import deepcopy

import jsonschema
import pytest

from quintet.coupler.cli import main
from quintet.coupler.reference.schema import scene_schema
from quintet.coupler.scene.overrides import put
from quintet.coupler.scene.read import library, load, parse
from quintet.interfaces.quantities import PATTERN

SCENES = library()


@pytest.fixture(scope="module")
def validator():
    schema = scene_schema()
    jsonschema.Draft7Validator.check_schema(schema)
    return jsonschema.Draft7Validator(schema)


def mistakes(validator, table):
    return [error.message for error in validator.iter_errors(table)]


@pytest.mark.parametrize("name", SCENES)
def test_every_scene_is_valid(validator, name):
    table = parse(SCENES[name])
    assert mistakes(validator, table) == []
    for preset in table.get("presets", {}):
        assert mistakes(validator, load(name, preset).resolved) == []


MUTANTS = {
    "unknown key": ("windws", 1.0),
    "needed": ("end", None),
    "range": ("end", -1.0),
    "word": ("scheme", "seriel"),
    "key of a kind": ("components.water.spacin", 0.1),
    "range of a kind": ("components.water.spacing", 0.0),
    "word within a table": ("components.water.boundary.method", "mdb"),
    "key within a list": ("components.cube.bodies.0.sise", [1.0, 1.0, 1.0]),
    "length": ("components.cube.gravity", [0.0, 0.0]),
    "text for a number": ("components.cube.gravity", [0.0, 0.0, "down"]),
    "needed of a kind": ("components.water.sound_speed", None),
    "kind": ("components.water.kind", "sph_fliud"),
    "no kind": ("components.water.kind", None),
    "threads": ("components.water.threads", 0),
    "link": ("links.0.kind", "fis"),
    "key of a link": ("links.0.contcat", "walls"),
    "word of a link": ("links.0.contact", "wall"),
    "expectation": ("expect.0.mesure", "max"),
    "output": ("output.interva", 1.0),
    "stand-in": ("stand_ins", {"cube": {"prescribed": {"body": []}}}),
}


@pytest.mark.parametrize("mutant", MUTANTS)
def test_what_is_wrong_by_itself_is_refused(validator, mutant):
    path, value = MUTANTS[mutant]
    table = deepcopy(parse(SCENES["floating_cube"]))
    if value is None:
        *heads, last = path.split(".")
        node = table
        for head in heads:
            node = node[head]
        del node[last]
    else:
        assert put(table, path, value) == []
    assert mistakes(validator, table)


def test_every_key_is_described_and_tells_its_unit():
    def properties(schema):
        if isinstance(schema, dict):
            if isinstance(members := schema.get("properties"), dict) and "if" not in schema:
                yield from members.items()
            for name, child in schema.items():
                if name != "if":
                    yield from properties(child)
        elif isinstance(schema, list):
            for child in schema:
                yield from properties(child)

    schema = scene_schema()
    del schema["properties"]["stand_ins"]["additionalProperties"]["properties"]  # named by kinds
    members = list(properties(schema))
    assert len(members) > 200
    assert [name for name, child in members if not child.get("description")] == []
    spacing = schema["definitions"]["component.sph_fluid"]["properties"]["spacing"]
    assert spacing == {
        "description": "Between particles. Unit: m.",
        "unit": "m",
        "anyOf": [
            {"exclusiveMinimum": 0, "type": "number"},
            {"type": "string", "pattern": PATTERN},  # a text with a unit
        ],
    }


def test_references_are_addresses_that_lead_to_definitions():
    text = json.dumps(schema := scene_schema())
    names = set(re.findall(r'"\$ref": "#/definitions/(.*?)"', text))
    assert names == schema["definitions"].keys()
    assert all(re.fullmatch(r"[A-Za-z0-9_.:-]+", name) for name in names)  # no blanks: RFC 3986


def test_the_command_prints_it_and_knows_the_classes_of_a_scene(capsys):
    with pytest.raises(SystemExit) as exit_info:
        main(["schema", "two_springs"])
    assert exit_info.value.code == 0
    validator = jsonschema.Draft7Validator(json.loads(capsys.readouterr().out))
    text = SCENES["two_springs"].read_text()
    assert mistakes(validator, tomllib.loads(text)) == []
    assert mistakes(validator, tomllib.loads(text.replace("stiffness =", "stifness =", 1)))
