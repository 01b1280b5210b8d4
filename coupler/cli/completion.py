"""Words that a shell may complete: scenes, presets, kinds, components, materials and keys.

Imported only while a shell asks, which argcomplete tells by an environment variable. Nothing of a
scene's own is imported: keys of kinds ``module:Class`` beside a scene are not offered.
"""

import argparse
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import argcomplete

from quintet.coupler.coupling.links import keys_of
from quintet.coupler.reference.sections import subjects
from quintet.coupler.scene.foreign_code import trusted_params
from quintet.coupler.scene.read import library, locate, parse
from quintet.coupler.scene.scene import ComponentKeys, GroupSettings, SceneFile
from quintet.coupler.scene.tables import SceneTables
from quintet.coupler.study.peers.table import peers_of
from quintet.interfaces.errors import QuintetError
from quintet.interfaces.keys import keys
from quintet.interfaces.manifest import known_kinds
from quintet.interfaces.materials.library import library as materials

Words = list[str]
TABLES = ("components", "groups", "links", "expect", "study", "stability", "scan", "control")


def answer(parser: argparse.ArgumentParser) -> None:
    """Print the words that complete what the shell holds, and exit."""
    for command in _commands(parser).values():
        for action in command._actions:
            if completer := _completer(command, action):
                action.completer = completer  # type: ignore[attr-defined]
    argcomplete.autocomplete(parser, always_complete_options="long")


def _commands(parser: argparse.ArgumentParser) -> Mapping[str, argparse.ArgumentParser]:
    (choices,) = (
        action.choices
        for action in parser._actions
        if isinstance(action, argparse._SubParsersAction)
    )
    return choices


def _completer(
    command: argparse.ArgumentParser, action: argparse.Action
) -> Callable[..., Words] | None:
    """Return what completes an argument of a command; None for argparse's own choices and files."""
    name = command.prog.split()[-1]
    by_argument: dict[tuple[str, str], Callable[..., Words]] = {
        ("bench", "name"): lambda **_: ["exchange", *sorted(known_kinds())],
        ("compile", "names"): lambda **_: [*library(), *sorted(known_kinds())],
        ("conform", "kind"): lambda **_: sorted(known_kinds()),
        ("describe", "subject"): lambda **_: [subject for subject, _ in subjects()],
        ("join", "name"): lambda parsed_args, **_: list(_components(parsed_args)),
        ("materials", "name"): lambda **_: sorted(materials()),
        ("study", "beside"): peers,
    }
    by_name: dict[str, Callable[..., Words]] = {
        "scene": scenes,
        "preset": lambda parsed_args, **_: list(_table(parsed_args).get("presets", {})),
        "settings": settings,
        "over": settings,
        "swap": swaps,
        "elsewhere": lambda parsed_args, **_: list(_components(parsed_args)),
        "component": lambda parsed_args, **_: list(_components(parsed_args)),
    }
    return by_argument.get((name, action.dest)) or by_name.get(action.dest)


def scenes(prefix: str, **_: Any) -> Words:
    """Scenes of the library, and files."""
    files = argcomplete.completers.FilesCompleter(("toml",), directories=True)
    return [*library(), *files(prefix)]


def peers(parsed_args: argparse.Namespace, **_: Any) -> Words:
    """Other programs that the scene on the line has inputs for."""
    scene = getattr(parsed_args, "scene", None)
    try:
        return list(peers_of(locate(scene).parent)) if scene else []
    except QuintetError:
        return []


def swaps(prefix: str, parsed_args: argparse.Namespace, **_: Any) -> Words:
    """``NAME=KIND``: components, then kinds."""
    name, equals, _rest = prefix.partition("=")
    if not equals:
        return [f"{component}=" for component in _components(parsed_args)]
    return [f"{name}={kind}" for kind in sorted(known_kinds())]


def settings(prefix: str, parsed_args: argparse.Namespace, **_: Any) -> Words:
    """Dotted paths of keys of the scene that is named, one part further than what is written."""
    above = prefix.rpartition(".")[0]
    table = _table(parsed_args)
    paths = list(key_paths(table, above))
    begun = [path for path in paths if path.startswith(prefix)]
    # A single table is entered at once: the shell would put a space behind it.
    while len(begun) == 1 and begun[0].endswith("."):
        inner = list(key_paths(table, begun[0].removesuffix(".")))
        if not inner:
            break
        begun = inner
    return begun


def key_paths(table: Mapping[str, Any], above: str) -> Iterator[str]:
    """Yield paths below a table of a scene: those of tables end in a dot, of values in ``=``."""
    names = above.split(".") if above else []
    root = f"{above}." if above else ""
    if not names:
        yield from (_written(key.name, key.inner is not None) for key in keys(SceneFile))
        yield from (f"{key.name}." for key in keys(SceneTables) if table.get(key.name))
        return
    first, *rest = names
    entry = table.get(first)
    if first in TABLES and not rest:
        yield from (f"{root}{name}." for name in _names(entry))
        return
    if first in TABLES:
        params, entry, rest = _classes(first, rest[0], entry), _at(entry, rest[0]), rest[1:]
    else:
        params, entry, rest = [SceneFile], table, names
    yield from (f"{root}{path}" for part in params for path in _keys_below(part, entry, rest))


def _classes(table: str, name: str, entry: Any) -> list[type]:
    """Parameter classes of a table of a scene."""
    chosen = _at(entry, name)
    if not isinstance(chosen, dict):
        return []
    kind = chosen.get("kind")
    if table == "components":
        params = trusted_params(kind, Path(), False) if kind else None  # nothing of its folder
        return [ComponentKeys, *([params] if params else [])]
    if table == "links":
        params = keys_of(kind)
        return [params] if params else []
    if table == "groups":
        return [GroupSettings]
    return [key.inner for key in keys(SceneTables) if key.name == table and key.inner is not None]


def _keys_below(params: type, entry: Any, names: list[str]) -> Iterator[str]:
    """Yield keys of a class below a path of names, as far as its tables go."""
    known = {key.name: key for key in keys(params)}
    if not names:
        yield from (_written(key.name, key.inner is not None) for key in known.values())
        return
    key, rest = known.get(names[0]), names[1:]
    if key is None or key.inner is None:
        return
    entry = entry.get(names[0]) if isinstance(entry, dict) else None
    if key.place in ("list", "names"):
        if not rest:
            yield from (f"{name}." for name in _names(entry))
            return
        entry, rest = _at(entry, rest[0]), rest[1:]
    yield from _keys_below(key.inner, entry, rest)


def _written(name: str, is_table: bool) -> str:
    return f"{name}." if is_table else f"{name}="


def _names(entry: Any) -> Words:
    """Names of the tables of an entry, or numbers of those in a list."""
    if isinstance(entry, list):
        return [str(number) for number in range(len(entry))]
    return [str(name) for name in entry] if isinstance(entry, dict) else []


def _at(entry: Any, name: str) -> Any:
    if isinstance(entry, list):
        return entry[int(name)] if name.isdecimal() and int(name) < len(entry) else None
    return entry.get(name) if isinstance(entry, dict) else None


def _table(options: argparse.Namespace) -> dict[str, Any]:
    """Tables of the scene that stands on the line; none if it cannot be read."""
    scene = getattr(options, "scene", None)
    try:
        return parse(locate(scene)) if scene else {}
    except (QuintetError, OSError):
        return {}


def _components(options: argparse.Namespace) -> Mapping[str, Any]:
    components = _table(options).get("components", {})
    return components if isinstance(components, dict) else {}
