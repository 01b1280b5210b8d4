"""The README's examples run; its links and scenes exist."""

import re
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

import quintet

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / "README.md").read_text()
RUNNING = (ROOT / "scenarios/README.md").read_text()


def blocks(text: str, kind: str) -> list[str]:
    return re.findall(rf"^```{kind}\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def test_the_component_it_shows_is_part_of_that_beside_its_scene():
    (excerpt,) = blocks(README, "python")
    code = (ROOT / "scenarios/two_springs/springs.py").read_text().splitlines()
    assert [line for line in excerpt.splitlines() if line not in code] == []


def test_the_scene_it_shows_can_run(tmp_path):
    (scene,) = blocks(README, "toml")
    (tmp_path / "splash.toml").write_text(scene)
    quintet.check(str(tmp_path / "splash.toml"))  # raises SceneError where it cannot


def test_the_python_example_runs(tmp_path, monkeypatch, capsys):
    (example,) = (
        block for block in blocks(RUNNING, "python") if block.startswith("import quintet\n")
    )
    monkeypatch.chdir(tmp_path)
    exec(example)
    assert capsys.readouterr().out.endswith("done (251, 1, 3) m 0.5\n")


def test_the_picture_and_the_files_it_links_are_there():
    for link in re.findall(r"\]\(([^)#]+)[^)]*\)", README):
        assert (ROOT / link).exists(), link


def test_every_scene_has_a_row_that_names_the_kind_of_its_reference():
    table = RUNNING.split("## Errors and times")[1].split("\n## ")[0]
    rows = [line.split("|")[1:-1] for line in table.splitlines() if line.startswith("| ")][1:]
    kinds = {kind.strip() for row in rows for kind in row[2].split(",")}
    assert kinds == {"exact", "experiment", "other code", "own finest run"}
    scenes = {name for row in rows for name in re.findall(r"quintet run (\w+)", row[0])}
    assert scenes == {path.parent.name for path in (ROOT / "scenarios").glob("*/scene.toml")}


def test_the_scenes_it_runs_exist():
    scenes = set(re.findall(r"quintet (?:run|check|join) ([a-z]\w*)(?![\w.])", README + RUNNING))
    assert scenes and all((ROOT / "scenarios" / name / "scene.toml").exists() for name in scenes)


@pytest.mark.parametrize("name", ["CONTRIBUTING.md", "CHANGELOG.md"])
def test_what_texts_for_developers_link_is_there(name):
    text = ROOT / ".github" / name
    for link in re.findall(r"\]\(([^)#]+)\)", text.read_text()):
        assert link.startswith("https://") or (text.parent / link).exists(), link


def test_constraints_name_a_version_of_every_package_that_is_needed():
    lines = (ROOT / ".github/constraints.txt").read_text().splitlines()[1:]
    constrained = {canonicalize_name(Requirement(line).name) for line in lines}
    assert all(str(Requirement(line).specifier).startswith("==") for line in lines)
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    groups = [project["dependencies"], *project["optional-dependencies"].values()]
    required = [Requirement(requirement).name for group in groups for requirement in group]
    assert set(map(canonicalize_name, required)) - {project["name"]} <= constrained
