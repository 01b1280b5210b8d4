"""Floors inside components, circles of imports, where kernels lie, and names of locals."""

import ast
import re
from collections import defaultdict
from functools import cache

import pytest
from test_layers import FILES, ROOT, TESTS, imported, nodes, where

COMPONENTS = sorted(path.parent for path in (ROOT / "components").rglob("component.py"))
ROWS = re.findall(r"^\| `(\w+)(?:\.py)?` \|", (ROOT / "components/README.md").read_text(), re.M)
FLOOR = {name: n for n, name in enumerate(ROWS)}  # files of a component, the lowest first
# Folders whose parts must not import each other in a circle: components and crowded wings.
STOREYS = [
    *(where(folder) for folder in COMPONENTS),
    *(f"components/shared{part}" for part in ("", "/domain", "/geometry", "/search")),
    *(
        f"coupler/{part}"
        for part in ("chaos", "coupling", "launch", "report", "run", "scene", "study")
    ),
    *("interfaces", "interfaces/lines", "interfaces/serving"),
]

ABOVE_COMPONENT = {"analysis", "opencl"}  # sub-folders and files that drive the whole solver
VAGUE = {"one", "found", "given", "made", "kept", "own"}


def dotted(path):
    return where(path).removesuffix(".py").removesuffix("/__init__").replace("/", ".")


MODULES = {dotted(path): path for path in FILES}


def imports_of(path):
    """Modules of the product that a file imports, also where only types are checked."""
    names = set()
    for target in imported(path):
        name, module = ".".join(target), ".".join(target[:-1])
        names |= {name if name in MODULES else module} & MODULES.keys()
    return names - {dotted(path)}


@cache
def imports():
    """Modules that each module imports; read when a test asks, as every worker loads this file."""
    return {name: imports_of(path) for name, path in MODULES.items()}


def in_circles(graph):
    """Nodes that can be reached from themselves."""
    reached = {}
    for start in graph:
        stack, visited = list(graph[start]), set()
        while stack:
            if (node := stack.pop()) not in visited:
                visited.add(node)
                stack.extend(graph.get(node, ()))
        reached[start] = visited
    return {node for node in graph if node in reached[node]}


def not_in(places, known):
    """Places that lie in none of the folders or files that are known."""
    return sorted(p for p in places if not any(p == k or p.startswith(f"{k}/") for k in known))


def test_no_file_imports_itself_in_a_circle():
    """Imports for types are counted, as the reader follows them too."""
    circles = {name.replace(".", "/") for name in in_circles(imports())}
    assert sorted(circles) == []


def part_of(name, storey):
    return (name.removeprefix(storey).strip(".") or "__init__").split(".")[0]


@pytest.mark.parametrize("folder", STOREYS)
def test_parts_of_a_folder_form_no_circle(folder):
    storey, graph = folder.replace("/", "."), defaultdict(set)
    inside = {name for name in imports() if name == storey or name.startswith(f"{storey}.")}
    for name in inside:
        parts = {part_of(target, storey) for target in imports()[name] & inside}
        graph[part_of(name, storey)] |= parts - {part_of(name, storey)}
    assert in_circles(dict(graph)) == set()


def test_imports_run_downwards_inside_components():
    """As the table in components/README.md orders the files, the lowest first."""
    upward = []
    for folder in COMPONENTS:
        storey = where(folder).replace("/", ".")
        for name in (n for n in imports() if n == storey or n.startswith(f"{storey}.")):
            part = part_of(name, storey)
            level = FLOOR.get(part, FLOOR["conform" if part in ABOVE_COMPONENT else "view"])
            for target in imports()[name]:
                if target == storey or target.startswith(f"{storey}."):
                    above = part_of(target, storey)
                    if above in FLOOR and above != part and FLOOR[above] > level:
                        upward.append(f"{where(folder)}/{part}: {above}")
    assert sorted(set(upward)) == []


def test_every_component_has_the_same_files():
    parts = {folder: {path.stem for path in folder.iterdir()} for folder in COMPONENTS}
    lacking = {folder.name: set(ROWS) - names for folder, names in parts.items()}
    assert {folder: names for folder, names in lacking.items() if names} == {}


def test_compiled_functions_lie_in_kernels_laws_and_shared():
    compiled = set()
    for path in FILES:
        parts = {*path.relative_to(ROOT).parts[:-1], path.stem}
        if "components" in parts and not parts & {"kernels", "laws", "shared"}:
            decorators = [d for node in nodes(path) for d in getattr(node, "decorator_list", ())]
            if any("jit" in ast.unparse(decorator) for decorator in decorators):
                compiled.add(dotted(path).replace(".", "/"))
    assert sorted(compiled) == []


def vague_names(path):
    """Yield locals and arguments of a file that do not say what they hold."""
    for node in nodes(path):
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            name = node.id
        elif isinstance(node, ast.arg):
            name = node.arg
        else:
            name = getattr(node, "name", None) if isinstance(node, ast.MatchAs) else None
        if name in VAGUE:
            yield f"{where(path)}:{node.lineno}: {name}"


def test_locals_are_named_after_what_they_hold():
    vague = [line for path in FILES + TESTS for line in vague_names(path)]
    assert vague == []


@pytest.mark.parametrize("folder", COMPONENTS, ids=where)
def test_the_story_of_a_step_is_short_and_asks_little_what_is_on(folder):
    """At most 20 methods and 3 comparisons with None: optional physics is in `features.py`."""
    tree = list(ast.walk(ast.parse((folder / "component.py").read_text())))
    assert sum(isinstance(node, ast.FunctionDef) for node in tree) <= 20
    compared = [node.comparators[0] for node in tree if isinstance(node, ast.Compare)]
    assert sum(isinstance(c, ast.Constant) and c.value is None for c in compared) <= 3
