"""The hash of a run: of all that its results depend on, but for the machine and the time.

It covers the scene as it runs, with seeds; the files that it names; code beside it; and the
versions of the packages, with the source code of quintet and of kinds from other packages.
"""

import ast
import hashlib
import json
from collections.abc import Iterator, Mapping
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from quintet.coupler.files.run_files import RECORDING
from quintet.coupler.run.results import machine
from quintet.coupler.scene.scene import Scene, kinds_of
from quintet.interfaces.installed import installed

DIGITS = 16  # of a hash, hexadecimal
TEXTS = ("title", "about", "minutes")  # keys of a scene on which no result depends
ORDERED = ("components", "groups")  # tables in whose order components step
SOURCES = ("interfaces", "components", "coupler")
WITH_FILES = ("components", "links", "expect")  # tables that may name files
NAMES = ("kind", "name", "component")  # their keys that name none
LONGEST = 1000  # characters of the name of a file


def run_hash(scene: Scene) -> str:
    """Hash of a run of a scene, in hexadecimal digits."""
    table = {key: value for key, value in scene.resolved.items() if key not in TEXTS}
    content = {
        "scene": {
            key: list(value.items()) if key in ORDERED and isinstance(value, dict) else value
            for key, value in table.items()
        },
        "files": {name: _file_hash(path) for name, path in sorted(named_files(scene))},
        "versions": versions(),
        "kinds": kind_versions(tuple(kinds_of(scene.resolved["components"]))),
    }
    text = json.dumps(_plain(content), sort_keys=True, default=str)
    return hashlib.blake2b(text.encode(), digest_size=DIGITS // 2).hexdigest()


def _plain(value: Any) -> Any:
    """Write whole numbers as such: 2.0 and 2 are the same setting."""
    if isinstance(value, float) and value.is_integer():
        return int(value)
    if isinstance(value, Mapping):
        return {key: _plain(entry) for key, entry in value.items()}
    return [_plain(entry) for entry in value] if isinstance(value, (list, tuple)) else value


@cache
def versions() -> dict[str, str]:
    """Versions of the packages, and a hash of quintet's own source code."""
    return {**machine()["versions"], "sources": _sources()}


def _sources() -> str:
    digest = hashlib.blake2b(digest_size=8)
    for name in SOURCES:
        root = Path(str(files(f"quintet.{name}")))
        for path in sorted(root.rglob("*.py")):
            digest.update(f"{name}/{path.relative_to(root)}\0".encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()


@cache
def kind_versions(kinds: tuple[str, ...]) -> dict[str, str]:
    """Package and version of each kind that another package brings."""
    owners = {point.name: point.dist for point in installed("quintet.components")}
    packages = {kind: owners.get(kind) for kind in kinds}
    return {
        kind: f"{package.name} {package.version}"
        for kind, package in packages.items()
        if package is not None and package.name != "quintet"
    }


def named_files(scene: Scene) -> Iterator[tuple[str, Path]]:
    """Files that a scene names, and the code of its own, each as the scene calls it."""
    tables = {key: scene.resolved.get(key) for key in WITH_FILES}
    for text in set(_texts(tables)):
        if 0 < len(text) <= LONGEST and "\0" not in text:
            path = scene.folder / text
            for place in (path, path / RECORDING):
                if place.is_file():
                    yield text, place
    if scene.beginning is not None:
        yield "begin_from", scene.beginning.path
    modules = {kind.split(":")[0] for kind in kinds_of(scene.resolved["components"]) if ":" in kind}
    for module in modules:
        for place in map(Path, scene.import_folders):
            code = list(code_files(place, module.split(".")[0], set()))
            yield from ((f"{module}/{path.relative_to(place)}", path) for path in code)
            if code:
                break


def code_files(folder: Path, module: str, seen: set[str]) -> Iterator[Path]:
    """Files of a module or package in a folder, and of what it imports from there."""
    if module in seen:
        return
    seen.add(module)
    package, file = folder / module, folder / f"{module}.py"
    for path in sorted(package.rglob("*.py")) if package.is_dir() else [file]:
        if path.is_file():
            yield path
            for name in _imports(path):
                yield from code_files(folder, name, seen)


def _imports(path: Path) -> Iterator[str]:
    try:
        nodes = ast.walk(ast.parse(path.read_bytes()))
    except (SyntaxError, ValueError):
        return
    for node in nodes:
        names = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
        if isinstance(node, ast.ImportFrom) and node.module and not node.level:
            names = [node.module]
        yield from (name.split(".")[0] for name in names)


def _texts(value: Any) -> Iterator[str]:
    """All texts in a table that may be names of files."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, Mapping):
        for key, entry in value.items():
            if key not in NAMES:
                yield from _texts(entry)
    elif isinstance(value, list):
        for entry in value:
            yield from _texts(entry)


def _file_hash(path: Path) -> str:
    state = path.stat()
    return _content_hash(path, state.st_mtime_ns, state.st_size)


@cache
def _content_hash(path: Path, *_: int) -> str:
    """Hash of what is in a file that was changed last at a time, and has a size."""
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "blake2b").hexdigest()[:DIGITS]
