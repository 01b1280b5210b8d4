"""``quintet describe`` and the folders' texts give each key's meaning and unit."""

import json
import re
import tomllib
from pathlib import Path

import pytest

from quintet.coupler.cli import main
from quintet.coupler.coupling.links import known_links
from quintet.coupler.reference.describe import PLACE, filled
from quintet.coupler.reference.sections import link_keys, reference_of, sections, subjects
from quintet.coupler.scene.scene import SceneFile
from quintet.coupler.scene.tables import SceneTables
from quintet.interfaces.component import Component
from quintet.interfaces.keys import documented, keys
from quintet.interfaces.manifest import find, known_kinds
from quintet.interfaces.params import Positive, parameters
from quintet.interfaces.units import UNITS

ROOT = Path(__file__).resolve().parents[3]
SUBJECTS = ["scene", *sorted(known_kinds()), *(f"link {link}" for link in sorted(known_links()))]
SEVERAL = re.compile(r"of the (field|parameter)\b|`unit`")  # the scene says which


def every_class():
    """Yield the parameter classes of scenes, links and components, with nested classes."""
    outer = [SceneFile, SceneTables, *map(link_keys, known_links())]
    queue = [*outer, *(find(kind).params for kind in known_kinds())]
    while queue:
        yield (params_class := queue.pop())
        queue += [key.inner for key in keys(params_class) if key.inner is not None]


CLASSES = sorted(set(every_class()), key=lambda params: (params.__module__, params.__qualname__))


@pytest.mark.parametrize("params", CLASSES, ids=lambda params: params.__qualname__)
def test_every_key_has_a_meaning_and_every_number_a_unit(params):
    entries = keys(params)
    assert [key.name for key in entries if not key.meaning] == []
    assert [key.name for key in entries if key.numeric and not key.unit] == []
    assert [key.name for key in entries if key.unit and not key.numeric] == []
    other_units = (
        {key.unit for key in entries} - UNITS - {"", "min", "Hz", "m2/s", "N s/m", "J/(kg K)"}
    )
    assert [unit for unit in other_units if not SEVERAL.match(unit)] == []
    names = {key.name for key in entries}
    assert {name.rstrip("_") for name in documented(params)} <= names  # none that is gone


@pytest.mark.parametrize("params", CLASSES, ids=lambda params: params.__qualname__)
def test_defaults_are_told_as_a_scene_would_give_them(params):
    for key in keys(params):
        if key.default not in ("", "none"):
            (info,) = (
                field
                for name, field in params.__pydantic_fields__.items()
                if key.name in (name, field.alias)
            )
            value = tomllib.loads(f"x = {key.default}")["x"]
            default = info.get_default(call_default_factory=True)
            assert json.dumps(value) == json.dumps(default)
        assert key.needed != bool(key.default) or key.inner is not None


def test_all_that_can_be_described_is_listed():
    assert [name for name, _ in subjects()] == SUBJECTS


FOLDERS = ("interfaces", "components", "coupler", "scenarios")
TEXTS = [path for folder in FOLDERS for path in sorted((ROOT / folder).rglob("README.md"))]
TEXTS = [path for path in TEXTS if PLACE.search(path.read_text())]


@pytest.mark.parametrize("path", TEXTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_tables_in_texts_are_as_quintet_describe_writes_them(path):
    rewritten = filled(path.read_text(), path.name)
    assert path.read_text() == rewritten, f"quintet describe --write {path.relative_to(ROOT)}"


def test_every_subject_stands_in_a_text():
    subjects = [place[1] for path in TEXTS for place in PLACE.findall(path.read_text())]
    assert sorted(subjects) == sorted(SUBJECTS)


def describe(capsys, *arguments):
    with pytest.raises(SystemExit) as exit_info:
        main(["describe", *arguments])
    screen = capsys.readouterr()
    return exit_info.value.code, screen.out, screen.err


@pytest.mark.parametrize("subject", SUBJECTS)
def test_describe_prints_every_key(capsys, subject):
    status, out, _ = describe(capsys, *subject.split())
    assert status == 0
    sections = reference_of(*subject.split()).sections
    rows = [(key, line) for section in sections for key in section.keys
            for line in out.splitlines() if line.split(" ")[0] == key.name]  # fmt: skip
    assert {key.name for key, _ in rows} == {
        key.name for section in reference_of(*subject.split()).sections for key in section.keys
    }
    for section in reference_of(*subject.split()).sections:
        assert all(f"    {key.meaning}" in out.splitlines() for key in section.keys)


def test_describe_prints_one_table_alone(capsys):
    status, out, _ = describe(capsys, "scene", "output")
    assert status == 0 and out.startswith("[output]\nWhat a run leaves.\n")
    assert "[[expect]]" not in out


def test_describe_prints_one_key_alone(capsys):
    status, out, _ = describe(capsys, "sph_fluid", "boundary.roughness")
    assert status == 0
    assert out.splitlines()[:2] == ["[boundary]", "roughness  m  number, > 0  0.0005"]
    assert len(out.splitlines()) == 3


def test_describe_gives_data_for_programs(capsys):
    _, out, _ = describe(capsys, "scene", "output", "--json")
    (part,) = json.loads(out)
    assert part["table"] == "[output]"
    _, out, _ = describe(capsys, "scene", "output.record", "--json")
    assert [key["key"] for table in json.loads(out) for key in table["keys"]] == ["record"]
    _, out, _ = describe(capsys, "--json")
    assert {"subject": "scene", "title": "the keys of a scene file"} in json.loads(out)
    _, out, _ = describe(capsys, "link", "fsi", "--json")
    (table,) = json.loads(out)
    contact = next(entry for entry in table["keys"] if entry["key"] == "contact")
    assert contact["type"] == '"walls" or "potential"' and contact["default"] == '"walls"'


class Mass(Component):
    """A mass on a spring."""

    @parameters
    class Params:
        """What a scene says of it.

        Parameters
        ----------
        stiffness : N/m
            Of the spring.
        """

        stiffness: Positive


def test_a_class_is_described(capsys):
    status, out, _ = describe(capsys, f"{__name__}:Mass")
    assert status == 0
    assert re.search(r"^stiffness +N/m +number, > 0 +needed\n    Of the spring\.$", out, re.M)


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["sph_fliud"], "describe sph_fliud is not known. Did you mean sph_fluid?"),
        (["link", "fis"], "describe link fis is not known. Did you mean fsi?"),
        (["link"], "describe link needs a kind of link. Name one, as in describe link fsi."),
        (["scene", "ouput"], "describe scene: ouput is not known. Did you mean output?"),
        (["scene", "ouput", "--json"], "describe scene: ouput is not known. Did you mean output?"),
        (["--write", "/nowhere/a.md"], "--write /nowhere/a.md: it cannot be read"),
        (["--json", "--write", "{text}"], "Remove SUBJECT and --json."),
        (["scene", "output", "more"], "one subject at a time; found scene output more."),
        (["nowhere:Mass"], "describe nowhere:Mass: it cannot be imported"),
        (["--write", "{text}"], "there is no place for tables."),
    ],
)
def test_what_cannot_be_described_is_told(capsys, tmp_path, words, sentence):
    (tmp_path / "text.md").write_text("# A text\n")
    status, out, err = describe(capsys, *[word.format(text=tmp_path / "text.md") for word in words])
    assert (status, out) == (2, "") and sentence in err


def test_the_same_class_is_told_once():
    heads = [section.head for section in reference_of("scene").sections]
    assert len(heads) == len(set(heads)) and "[groups.NAME.iteration]" not in heads
    group = next(
        section for section in reference_of("scene").sections if section.head == "[groups.NAME]"
    )
    assert group.keys[-1].meaning.endswith("Keys as in `[iteration]`.")
    assert len(list(sections(SceneFile))) == 5


def test_a_kind_is_described_with_its_ports(capsys):
    _, out, _ = describe(capsys, "sph_solid")
    assert "gives glued_load (force [N, impulse])\n" in out, "of the glued ones of its cases"
    assert "takes glued (velocity [m/s, impulse])\n" in out


def test_a_kind_that_may_own_several_ranks_says_so(capsys):
    assert "several MPI ranks" in describe(capsys, "particle_lattice")[1]
    assert "several MPI ranks" not in describe(capsys, "fe_heat")[1]
