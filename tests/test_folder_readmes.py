"""Texts in the folders name files and functions that exist, and their examples run."""

import ast
import re
import shlex
import tomllib
from dataclasses import fields
from functools import cache
from pathlib import Path

import pytest
from test_layers import FLOORS

from quintet.coupler import cli
from quintet.coupler.conform.check import try_all
from quintet.coupler.conform.trial import Trial
from quintet.coupler.coupling.iteration.settings import IterationSettings
from quintet.coupler.coupling.link import Binding, Demands, Transfer
from quintet.coupler.measures.expectation import Expectation
from quintet.coupler.report.show import results
from quintet.coupler.run.run_scene import run_scene
from quintet.coupler.scene.read import load
from quintet.coupler.scene.scan_table import ScanTable
from quintet.coupler.scene.scene import GroupSettings, OutputSettings, SceneFile
from quintet.coupler.scene.stability_table import LimitTable
from quintet.coupler.scene.study_table import RefinementTable
from quintet.interfaces.component import Component, Field, Port, Resources
from quintet.interfaces.manifest import BenchCase, ConformCase, Manifest, Plan, find
from quintet.interfaces.params import read

ROOT = Path(__file__).resolve().parents[1]
FOLDERS = ("interfaces", "components", "coupler", "scenarios")
TEXTS = [ROOT / "README.md", *(ROOT / folder / "README.md" for folder in FOLDERS)]
TEXTS += sorted(ROOT.glob("coupler/*/README.md")) + sorted(ROOT.glob("components/*/**/*.md"))
TEXTS += sorted(ROOT.glob("scenarios/*/README.md"))
TEXTS += sorted(ROOT.glob(".github/*.md")) + sorted(ROOT.glob(".docs/*.md"))
TABLES = re.compile(r"<!-- describe .+?<!-- described -->", re.DOTALL)
FENCE = re.compile(r"^```(\w*)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
FILE = re.compile(r"(?:[\w.-]+/)+[\w-]+\.(?:py|toml|md|csv|png)")
NAMED = re.compile(r"((?:\w+/)+\w+\.py):([A-Za-z_]\w*(?:\.\w+)?)")


def where(path):
    return str(path.relative_to(ROOT))


def blocks(text, kind):
    return [inside for language, inside in FENCE.findall(text) if language == kind]


def quoted(path):
    """Return the texts between backquotes outside blocks of code."""
    return re.findall(r"`([^`\n]+)`", FENCE.sub("", path.read_text()))


@pytest.mark.parametrize("path", TEXTS, ids=where)
def test_links_lead_to_files(path):
    for link, part in re.findall(r"\]\(([^)#]*)#?([^)]*)\)", FENCE.sub("", path.read_text())):
        if not link.startswith("https://"):
            assert (path.parent / link).exists(), link
            assert not part or part in anchors(path.parent / link if link else path), part


def test_lines_of_prose_are_short():
    running = {path: TABLES.sub("", FENCE.sub("", path.read_text())) for path in TEXTS}
    prose = [(path, line) for path, text in running.items() for line in text.split("\n")]
    exempt = ("|", "(`quintet ")  # rows of tables, and commands that stand as they are pasted
    long = [(where(p), line) for p, line in prose if len(line) > 160]
    assert [(place, line) for place, line in long if not line.startswith(exempt)] == []


@cache
def anchors(path):
    """Parts of a text that links may lead to: its headings, as they are written in addresses."""
    heads = re.findall(r"^#+ (.+)$", FENCE.sub("", path.read_text()), re.MULTILINE)
    return {re.sub(r"[^\w -]", "", head.lower()).replace(" ", "-") for head in heads}


@cache
def defined(path):
    """Names that a module defines, also those within its classes."""
    names = set()
    for node in ast.parse((ROOT / path).read_text()).body:
        owner = getattr(node, "name", "")
        names |= set(bound(node))
        if isinstance(node, ast.ClassDef):
            names |= {f"{owner}.{name}" for inner in node.body for name in bound(inner)}
    return names


def bound(node):
    """Yield the names that a statement binds."""
    if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
        yield node.name
    targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
    for target in targets:
        yield from (
            child.id for child in ast.walk(target or ast.Pass()) if isinstance(child, ast.Name)
        )


@pytest.mark.parametrize("path", TEXTS, ids=where)
def test_files_and_functions_that_are_named_are_there(path):
    for text in quoted(path):
        for file, name in NAMED.findall(text):
            assert name in defined(file), text
        if FILE.fullmatch(text) and text.split("/")[0] in (p.name for p in ROOT.iterdir()):
            assert (ROOT / text).exists(), text


@pytest.mark.parametrize("path", TEXTS, ids=where)
def test_commands_are_those_of_the_command_line(path):
    for line in "".join(blocks(path.read_text(), "sh")).replace("\\\n", "").splitlines():
        for command in line.split("&&"):
            words = shlex.split(command, comments=True)
            names = [Path(word).name for word in words]
            if "quintet" in names and "pip" not in names:
                arguments = words[names.index("quintet") + 1 :]
                arguments = arguments[: arguments.index(">")] if ">" in arguments else arguments
                cli.parser().parse_args([word for word in arguments if word != "&"])


@pytest.mark.parametrize("path", TEXTS, ids=where)
def test_examples_of_scenes_can_be_read(path):
    for block in blocks(path.read_text(), "toml"):
        tomllib.loads(block)


CONTRACT = [Field, Port, Resources, Manifest, Plan, BenchCase, ConformCase]
SCENE = [SceneFile, OutputSettings, GroupSettings, IterationSettings, Expectation]
SCENE += [RefinementTable, LimitTable, ScanTable]
DESCRIBED = {
    "interfaces/README.md": CONTRACT,
    "coupler/README.md": [Transfer, Demands, Binding],
    "scenarios/README.md": SCENE,
}


@pytest.mark.parametrize(
    ("readme", "kind"), [(readme, kind) for readme, kinds in DESCRIBED.items() for kind in kinds]
)
def test_every_part_of_contract_links_and_scenes_is_told(readme, kind):
    text = (ROOT / readme).read_text()
    names = [field.name.rstrip("_") for field in fields(kind)]
    assert [name for name in names if not is_described(text, name)] == []


def test_every_call_of_the_contract_is_told():
    text = (ROOT / "interfaces/README.md").read_text()
    calls = [name for name in vars(Component) if not name.startswith("_")]
    # The text has these two as words.
    assert [name for name in calls if not is_described(text, name)] == ["takes", "gives"]


def is_described(text, name):
    """Whether a text has a name between backquotes, or as a key of an example in TOML."""
    return re.search(rf"[`\[]{name}[(`\].]|^\[*{name}(?: =|\])", text, re.MULTILINE)


FILES = re.compile(r"`([\w/]+\.(?:py|toml))`:\n\n```\w+\n(.*?)^```$", re.MULTILINE | re.DOTALL)


@pytest.fixture
def installed(tmp_path, monkeypatch):
    """Unpack the files of a text, and offer the entry points that they declare."""

    def unpack(readme):
        for name, inside in FILES.findall((ROOT / readme).read_text()):
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / name).write_text(inside)
        project = tomllib.loads((tmp_path / "pyproject.toml").read_text())["project"]
        metadata = tmp_path / f"{project['name']}-{project['version']}.dist-info"
        metadata.mkdir()
        (metadata / "METADATA").write_text(
            f"Name: {project['name']}\nVersion: {project['version']}\n"
        )
        lines = []
        for group, points in project["entry-points"].items():
            lines += [f"[{group}]", *(f"{key} = {value}" for key, value in points.items())]
        (metadata / "entry_points.txt").write_text("\n".join(lines))
        monkeypatch.syspath_prepend(tmp_path)
        return tmp_path

    return unpack


def test_the_example_of_a_solver_is_installed_measured_and_runs(installed):
    folder = installed("interfaces/README.md")
    manifest = find("mooring")
    (case,) = manifest.cases()
    assert not read(manifest.params, case.params, case.name)[1]
    (case,) = manifest.conform_cases()
    findings = [
        finding for _, finding in try_all(Trial(manifest, case, folder)) if finding is not None
    ]
    assert [finding.said for finding in findings if finding.status == "failed"] == []
    assert run_scene(load(str(folder / "scene.toml")), folder / "run")[1] == 0
    assert results(folder / "run")["ledger"]["links"][0]["momentum_residual"] < 1e-13


def test_the_example_of_a_link_is_installed_and_conserves_momentum(installed):
    folder = installed("coupler/README.md")
    scene = load(str(folder / "scene.toml"))
    assert run_scene(scene, folder / "run")[1] == 0
    (link,) = results(folder / "run")["ledger"]["links"]
    assert max(link["momentum_residual"], link["angular_residual"]) < 1e-13
    assert link["energy_residual"] < 1e-6


def test_the_floors_of_the_coupler_are_told_as_they_are():
    table = (ROOT / "coupler/README.md").read_text().partition("A run, from")[0]
    rows = re.findall(r"^\| \d \| (`coupler.+?) \|", table, re.MULTILINE)  # the top one first
    assert [set(re.findall(r"`coupler/(\w+)", row)) for row in rows[::-1]] == FLOORS["coupler"]
