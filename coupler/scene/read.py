"""Reading a scene: TOML, a preset, what the command line sets; every mistake at once."""

import tomllib
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import fields
from functools import partial
from importlib.resources import files
from pathlib import Path
from typing import Any

from quintet.coupler.coupling.exchange import Link
from quintet.coupler.coupling.links import known_links, maker
from quintet.coupler.measures.expectation import Expectation, check
from quintet.coupler.scene import variants
from quintet.coupler.scene.groups import lay_out, refused, unknown_outputs
from quintet.coupler.scene.overrides import put_preset, put_set, put_swap
from quintet.coupler.scene.scene import (
    NAME,
    ComponentKeys,
    ComponentPlan,
    Scene,
    SceneFile,
    import_folders,
    wrong_name,
)
from quintet.coupler.scene.stability_table import Scope
from quintet.coupler.scene.tables import SceneTables
from quintet.interfaces.errors import LineError, QuintetError, SceneError
from quintet.interfaces.lines.endpoint import Security, check_endpoint
from quintet.interfaces.manifest import Manifest, find, known_kinds, look_in
from quintet.interfaces.params import read, unknown

TABLES = tuple(one.name for one in fields(SceneTables))


def library() -> dict[str, Path]:
    """Scenes that come with quintet: name and file."""
    root = Path(str(files("quintet.scenarios")))
    return {path.parent.name: path for path in sorted(root.glob("*/scene.toml"))}


def locate(scene: str) -> Path:
    """File of a scene given by name or by path."""
    if scene.endswith(".toml") or "/" in scene:
        path = Path(scene)
        path = path / "scene.toml" if path.is_dir() else path
        if not path.is_file():
            raise SceneError(f"scene {scene}: there is no such file. Give a name or a path.")
        return path
    known = library()
    if scene not in known:
        raise SceneError(unknown(f"scene {scene}", scene, known))
    return known[scene]


def load(
    scene: str,
    preset: str = "",
    settings: Iterable[str] = (),
    swaps: Iterable[str] = (),
    transport: str = "",
) -> Scene:
    """Read a scene and check all of it; nothing is started.

    Parameters
    ----------
    scene : str
        A name from ``quintet list`` or the path of a TOML file.
    settings : iterable of ``path=value``
        Set on top of the preset; values are TOML.
    swaps : iterable of ``NAME=KIND``
        Components to be replaced by another kind.

    Raises
    ------
    SceneError
        With every mistake found.
    """
    path = locate(scene)
    table = parse(path)
    mistakes = put_preset(table, preset) if preset else []
    for swap in swaps:
        mistakes += put_swap(table, swap)
    for setting in settings:
        mistakes += put_set(table, setting)
    if transport:
        table["transport"] = transport
    if mistakes:
        raise SceneError([f"{path.name}: {mistake}" for mistake in mistakes])
    made = _check(path, table, preset)
    asked = {"preset": preset, "settings": list(settings), "swaps": list(swaps)}
    made.asked = {"scene": str(path.resolve()), "transport": transport, **asked}
    return made


def parse(path: Path) -> dict[str, Any]:
    """Read a TOML file as it stands."""
    try:
        with open(path, "rb") as file:
            return tomllib.load(file)
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise SceneError(f"{path.name}: a scene must be valid TOML: {error}.") from error


def _check(path: Path, table: dict[str, Any], preset: str) -> Scene:
    look_in(import_folders(path, table.get("components")))
    own = {key: value for key, value in table.items() if key not in TABLES}
    file, mistakes = read(SceneFile, own, "scene")
    mistakes = [_also_tables(mistake) for mistake in mistakes]
    components = _components(table.get("components"), path.parent, mistakes)
    wrong = set(table.get("components") or ()) - set(components)  # told of already
    links = _links(_tables(table, "links", mistakes), components, wrong, mistakes)
    expect = _expect(_tables(table, "expect", mistakes), components, wrong, path.parent, mistakes)
    coupling = None
    if file is not None:
        if not wrong:
            coupling = lay_out(file, table.get("groups", {}), components, mistakes)
        if coupling and not mistakes:
            components = {name: components[name] for name in coupling.components()}
            mistakes += refused(coupling, components, links)
            mistakes += unknown_outputs(file, components)
        if file.window != "auto" and file.window > file.end:
            mistakes.append(
                f"scene.window must not exceed scene.end ({file.end:g} s); found {file.window:g} s."
                " Shorten it."
            )
        mistakes += _reachable(file) + wrong_name(file.name)
    series = [_tables(table, key, mistakes) for key in variants.TABLES]
    scope, check = None, None
    if file is not None and not mistakes:
        gives = {name: one.gives for name, one in components.items()}
        scope = Scope(file.end, gives, len(links), [one.name for one in expect])
        check = partial(_check, path, preset=preset)
    make_variant = variants.variant_maker(table, check)
    study, stability, wrong_variants = variants.read_variants(
        series[0], series[1], make_variant, scope
    )
    mistakes += wrong_variants
    if mistakes or file is None or coupling is None:
        raise SceneError([f"{path.name}: {mistake}" for mistake in dict.fromkeys(mistakes)])
    resolved = {k: v for k, v in table.items() if k not in ("presets", *variants.TABLES)}
    made = Scene(file, path, preset, components, links, coupling, expect, resolved, file.transport)
    made.study, made.stability = study, stability
    return made


def _also_tables(mistake: str) -> str:
    """Where a top-level name is unknown, the tables are known names too."""
    head, known, _ = mistake.partition(" is not known.")
    name = head.removeprefix("scene.")
    if known and "." not in name:
        return unknown(head, name, [*SceneFile.__dataclass_fields__, *TABLES])
    return mistake


def _reachable(file: SceneFile) -> list[str]:
    """Check the endpoint of the coupler and its certificate files."""
    if len(file.tls) not in (0, 3):
        return [
            "scene.tls must be three files: authority, certificate, key; found "
            f"{len(file.tls)}. Name all three."
        ]
    wrong = [
        f"scene.tls: {name} is not there. Make the file, or correct its path."
        for name in file.tls
        if not Path(name).is_file()
    ]
    if file.endpoint:
        try:
            check_endpoint(file.endpoint, Security(*file.tls) if file.tls else None)
        except LineError as error:
            wrong.append(f"scene.{error}")
    return wrong


def _tables(table: dict[str, Any], key: str, mistakes: list[str]) -> list[dict[str, Any]]:
    """Return what must be a list of tables, or nothing."""
    found = table.get(key, [])
    if isinstance(found, list) and all(isinstance(one, dict) for one in found):
        return found
    mistakes.append(f"{key} must be a list of tables; found {found!r}. Write [[{key}]].")
    return []


def _components(table: Any, folder: Path, mistakes: list[str]) -> dict[str, ComponentPlan]:
    if not isinstance(table, dict) or not table:
        mistakes.append("components: a scene needs at least one. Add [components.NAME].")
        return {}
    found = {}
    for name, given in table.items():
        if not NAME.fullmatch(name) or name == "coupler":
            mistakes.append(
                f"components: a name must be letters, digits, _ or -, and not coupler; found "
                f"{name!r}. Rename it."
            )
        elif not isinstance(given, dict):
            mistakes.append(f"components.{name} must be a table; found {given!r}. Give it a kind.")
        elif one := _component(name, dict(given), folder, mistakes):
            found[name] = one
    return found


def _component(
    name: str, given: dict[str, Any], folder: Path, mistakes: list[str]
) -> ComponentPlan | None:
    where = f"components.{name}"
    if not isinstance(kind := given.get("kind"), str):
        known = ", ".join(sorted(known_kinds()))
        mistakes.append(f"{where}.kind must be a name; found {kind!r}. Known here: {known}.")
        return None
    of_all = {one.name for one in fields(ComponentKeys)} & given.keys()
    common, wrong = read(ComponentKeys, {key: given.pop(key) for key in of_all}, where)
    mistakes += wrong
    if common is None:
        return None
    manifest = _manifest(where, kind, mistakes)
    if manifest is None:
        return None
    params, wrong = read(manifest.params, given, where, folder)
    if wrong:
        mistakes += wrong
        return None
    try:
        takes, gives = manifest.ports(params)
    except QuintetError as error:
        mistakes.append(f"{where}: {error}")
        return None
    except Exception as error:  # of any kind: what it does here is its author's
        said = f"{type(error).__name__}: {error}"
        mistakes.append(f"{where}: kind {kind} cannot tell its ports from these settings ({said}).")
        return None
    return ComponentPlan(name, kind, manifest, given, params, takes, gives, common.threads)


def _manifest(where: str, kind: str, mistakes: list[str]) -> Manifest | None:
    try:
        return find(kind)
    except KeyError:
        mistakes.append(unknown(f"{where}.kind {kind}", kind, known_kinds()))
    except QuintetError as error:
        mistakes.append(f"{where}.{error}")
    except Exception as error:  # of any kind: the module is its author's
        said = f"{type(error).__name__}: {error}"
        mistakes.append(f"{where}.kind {kind} cannot be imported ({said}). Name a module:Class.")
    return None


def _links(
    table: list[dict[str, Any]],
    components: dict[str, ComponentPlan],
    wrong: set[str],
    mistakes: list[str],
) -> list[Link]:
    ports = {name: (one.takes, one.gives) for name, one in components.items()}
    found: list[Link] = []
    known = known_links()
    for number, given in enumerate(table):
        kind = str(given.get("kind", ""))
        lists = [given.get("between", []), given.get("pairs", [])]
        if kind not in known:
            mistakes.append(unknown(f"links.{number}.kind {kind}", kind, known))
        elif not all(map(_is_names, lists)):
            mistakes.append(f"links.{number}: components and ports are names; found {lists!r}.")
        elif not wrong & set(_named(lists)):
            try:
                found.append(maker(kind)(number, given, ports))
            except SceneError as error:
                mistakes += error.mistakes
    for name, count in Counter(link.name for link in found).items():
        if count > 1:
            mistakes.append(f"links: {count} have the name {name}. Give each its own.")
    return found


def _is_names(value: Any) -> bool:
    """Whether there are names in a list, and in the lists in it, and nothing else."""
    return isinstance(value, str) or (isinstance(value, list) and all(map(_is_names, value)))


def _named(value: Any) -> Iterator[str]:
    """Components that stand in a link's lists, whatever else is wrong with them."""
    if isinstance(value, list):
        for one in value:
            yield from _named(one)
    elif isinstance(value, str):
        yield value.split(".")[0]


def _expect(
    table: list[dict[str, Any]],
    components: dict[str, ComponentPlan],
    wrong: set[str],
    folder: Path,
    mistakes: list[str],
) -> list[Expectation]:
    found = []
    gives = {name: one.gives for name, one in components.items()}
    for number, given in enumerate(table):
        one, lacks = read(Expectation, given, f"expect.{given.get('name', number)}")
        mistakes += lacks
        if one is not None and one.component not in wrong:
            mistakes += check(one, gives, folder)
            found.append(one)
    return found
