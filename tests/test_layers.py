"""Who may import whom; how long a file may be; what the package holds."""

import ast
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
MAY_IMPORT = {
    "interfaces": {"interfaces"},
    "components": {"interfaces"},  # and its own folder and shared, see below
    "coupler": {"interfaces", "coupler"},
    "scenarios": {"interfaces", "coupler"},
}
LINES = 400
FILES = [p for folder in MAY_IMPORT for p in sorted((ROOT / folder).rglob("*.py"))]
TESTS = sorted((ROOT / "tests").rglob("*.py"))
SOLVERS = {p.name for p in (ROOT / "components").iterdir() if (p / "__init__.py").exists()}


def where(path):
    return str(path.relative_to(ROOT))


def imported(path):
    """Yield the parts after the project name of every import of the project in a file."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}:{node.lineno}: write the import in full"
            names = [node.module or ""]
        elif isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        else:
            continue
        for name in names:
            head, *rest = name.split(".")
            assert head not in MAY_IMPORT, f"{path}:{node.lineno}: quintet.{name}, not {name}"
            if head == "quintet":
                yield rest


@pytest.mark.parametrize("path", FILES, ids=where)
def test_imports_follow_the_layers(path):
    folder, *inner = path.relative_to(ROOT).parts
    own = {("components", inner[0]), ("components", "shared")} if folder == "components" else set()
    for target in imported(path):
        assert target[0] in MAY_IMPORT[folder] or tuple(target[:2]) in own, ".".join(target)


@pytest.mark.parametrize("path", FILES, ids=where)
def test_neither_contract_nor_coupler_knows_a_solver_by_name(path):
    if path.relative_to(ROOT).parts[0] in ("interfaces", "coupler"):
        nodes = ast.walk(ast.parse(path.read_text()))
        texts = {str(node.value) for node in nodes if isinstance(node, ast.Constant)}
        assert not texts & (SOLVERS - {"shared", "stand_ins"})


@pytest.mark.parametrize("path", FILES + TESTS, ids=where)
def test_files_are_small(path):
    assert len(path.read_text().splitlines()) <= LINES


def test_every_folder_is_packaged():
    setup = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]
    folders = {p.parent.relative_to(ROOT) for p in FILES if p.name == "__init__.py"}
    assert set(setup["packages"]) == {"quintet." + ".".join(f.parts) for f in folders}


def test_every_scene_is_packaged():
    setup = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]
    folders = {p.parent.relative_to(ROOT) for p in (ROOT / "scenarios").rglob("*.toml")}
    scenes = {name for name in setup["packages"] if name.startswith("quintet.scenarios.")}
    assert scenes == {"quintet." + ".".join(f.parts) for f in folders}


def test_tests_have_names_of_their_own():
    # Two files of one name cannot both be imported where no folder is a package.
    names = [path.name for path in TESTS if path.name != "conftest.py"]
    assert len(names) == len(set(names))
    assert not [path for path in TESTS if path.name == "__init__.py"]
