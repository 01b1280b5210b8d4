"""Who may import whom; how long a file may be; what the package holds."""

import ast
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
MAY_IMPORT = {
    "interfaces": {"interfaces"},
    "components": {"interfaces"},  # and its own folder and shared, see below
    "coupler": {"interfaces", "coupler"},
    "scenarios": {"interfaces", "coupler"},
}
# Floors of the two folders, the ground first. A wing may import wings of lower floors and anything
# of its own; wings of one floor do not import each other.
FLOORS = {
    "interfaces": [
        {"errors", "waited", "installed"},
        {"libraries"},
        {"units", "params", "recordings"},
        {"component", "keys"},
        {"ports", "manifest", "rotation", "sums", "faces", "quantities", "materials"},
        {"lines"},
        {"serving"},
    ],
    "coupler": [
        {"files"},
        {"coupling"},
        {"measures"},
        {"scene"},
        {"launch", "report", "reference", "chaos"},
        {"run"},
        {"study", "bench", "conform", "debug"},
        {"cli", "python"},
    ],
}
LINES = 400
FILES = [p for folder in MAY_IMPORT for p in sorted((ROOT / folder).rglob("*.py"))]
TESTS = [p for p in sorted((ROOT / "tests").rglob("*.py")) if "typing" not in p.parts]
SOLVERS = {p.name for p in (ROOT / "components").iterdir() if (p / "__init__.py").exists()}


def where(path):
    return str(path.relative_to(ROOT))


@cache
def nodes(path):
    return list(ast.walk(ast.parse(path.read_text())))


def imported(path):
    """Yield the parts after the project name of every import of the project in a file."""
    for node in nodes(path):
        if isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}:{node.lineno}: write the import in full"
            names = [f"{node.module}.{alias.name}" for alias in node.names]
        elif isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        else:
            continue
        for name in names:
            head, *parts = name.split(".")
            assert head not in MAY_IMPORT, f"{path}:{node.lineno}: quintet.{name}, not {name}"
            if head == "quintet":
                yield parts


def forbidden_imports(path):
    """Yield the imports of a file that its folder does not allow."""
    folder, *inner = path.relative_to(ROOT).parts
    allowed = (
        {("components", inner[0]), ("components", "shared")} if folder == "components" else set()
    )
    for target in imported(path):
        if target[0] not in MAY_IMPORT[folder] and tuple(target[:2]) not in allowed:
            yield f"{where(path)}: {'.'.join(target)}"


def test_imports_follow_the_layers():
    assert [line for path in FILES for line in forbidden_imports(path)] == []


def wing_of(parts):
    """First folder or module of a wing's path; `__init__` is the whole folder's own."""
    return parts[0].removesuffix(".py")


@pytest.mark.parametrize("folder", FLOORS)
def test_every_wing_has_its_floor(folder):
    floors = FLOORS[folder]
    wings = {wing_of(p.relative_to(ROOT / folder).parts) for p in FILES if folder in p.parts}
    assert wings <= {"__init__"}.union(*floors)
    assert sum(map(len, floors)) == len(set().union(*floors))


def upward_imports(path):
    """Yield the imports of a file from a wing that does not lie below its own."""
    folder, *inner = path.relative_to(ROOT).parts
    if folder not in FLOORS or inner == ["__init__.py"]:
        return
    level = {wing: n for n, floor in enumerate(FLOORS[folder]) for wing in floor}
    own_wing = wing_of(inner)
    for target in imported(path):
        if len(target) > 1 and target[0] == folder and target[1] != own_wing:
            if level[target[1]] >= level[own_wing]:
                yield f"{where(path)}: {own_wing} must not import {'.'.join(target)}"


def test_imports_run_downwards_between_the_wings():
    assert [line for path in FILES for line in upward_imports(path)] == []


def late_imports(path):
    """Yield the lines of imports within functions that no comment explains."""
    lines = path.read_text().splitlines()
    late = {
        node.lineno
        for function in nodes(path)
        if isinstance(function, ast.FunctionDef)
        for node in ast.walk(function)
        if isinstance(node, (ast.Import, ast.ImportFrom))
    }
    for line in sorted(late):
        first = line
        while first - 1 in late or not lines[first - 2].strip():
            first -= 1  # one comment explains imports that follow each other
        if not lines[first - 2].lstrip().startswith("#") and "  # " not in lines[line - 1]:
            yield line


def test_late_imports_have_a_comment_with_their_reason():
    assert [f"{where(path)}:{line}" for path in FILES for line in late_imports(path)] == []


def test_neither_contract_nor_coupler_knows_a_solver_by_name():
    solvers = SOLVERS - {"shared", "stand_ins"}
    places = [
        f"{where(path)}:{node.lineno}"
        for path in FILES
        if path.relative_to(ROOT).parts[0] in ("interfaces", "coupler")
        for node in nodes(path)
        if isinstance(node, ast.Constant) and str(node.value) in solvers
    ]
    assert places == []


def test_files_are_small():
    files = FILES + TESTS
    assert [where(path) for path in files if len(path.read_text().splitlines()) > LINES] == []


def test_every_folder_of_code_and_every_scene_is_a_package():
    """A package is found by its ``__init__.py``; without one it would be left out of the wheel."""
    scenes = (ROOT / "scenarios").rglob("*.toml")
    folders = {path.parent for path in (*FILES, *scenes)} - {ROOT / "scenarios"}
    assert [where(f) for f in sorted(folders) if not (f / "__init__.py").exists()] == []


def test_the_package_is_made_of_the_top_folders():
    links = {path.name: path.resolve() for path in (ROOT / ".package/quintet").iterdir()}
    folders = ("components", "coupler", "interfaces", "scenarios")
    assert {name: links[name] for name in folders} == {name: ROOT / name for name in folders}
    assert links["__init__.py"] == ROOT / "coupler/python/__init__.py"


def test_tests_have_names_of_their_own():
    # Two files of one name cannot both be imported where no folder is a package.
    names = [path.name for path in TESTS if path.name != "conftest.py"]
    assert len(names) == len(set(names))
    assert not [path for path in TESTS if path.name == "__init__.py"]
