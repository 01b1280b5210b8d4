"""Overrides of a scene file: presets and single settings."""

import os
import re
import shlex
import sys
from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import tomli_w

from quintet.coupler.scene.foreign_code import trusted_params
from quintet.coupler.scene.toml import LONGEST_KEY, value_of
from quintet.interfaces.errors import SceneError
from quintet.interfaces.materials.filling import places
from quintet.interfaces.params import DEEPEST, shown, unknown


def put_preset(table: dict[str, Any], preset: str) -> list[str]:
    """Apply a preset of the scene; return the mistakes."""
    presets = table.get("presets", {})
    if not isinstance(presets, dict) or not isinstance(presets.get(preset, {}), dict):
        return [
            f"presets.{preset} must be a table of paths and values; found {shown(presets)}. Write "
            f"[presets.{preset}]."
        ]
    if preset not in presets:
        return [unknown(f"preset {preset}", preset, presets)]
    return [m for path, value in presets[preset].items() for m in put(table, path, value)]


def put_set(table: dict[str, Any], setting: str) -> list[str]:
    """Apply ``PATH=VALUE``, the value in TOML; return the mistakes."""
    path, equals, text = setting.partition("=")
    if not equals:
        quoted = shown(setting)
        return [f"--set needs PATH=VALUE; found {quoted}. Give it as in --set window=1e-3."]
    if len(path) > LONGEST_KEY or path.count(".") >= DEEPEST:
        return [
            f"--set: a path must have at most {LONGEST_KEY} characters and {DEEPEST} parts; found "
            f"{shown(path)}. Correct it."
        ]
    try:
        value = value_of(text)
    except ValueError as error:
        return [f"--set {path}: {error}; found {shown(text)}. Correct it."]
    return put(table, path, value)


def put(table: dict[str, Any], path: str, value: Any) -> list[str]:
    """Set a value at a dotted path; new tables are made only within a component's settings."""
    *heads, last = path.split(".")
    at: Any = table
    for number, head in enumerate(heads):
        place = ".".join(heads[: number + 1])
        if isinstance(at, list):
            if not is_index(head, at):
                return [f"{place}: must be a number below {len(at)}; found {head!r}. Correct it."]
            at = at[int(head)]
        elif isinstance(at, dict) and (head in at or _may_be_made(heads[: number + 1])):
            at[head] = _material(table, at.get(head, {}), heads[: number + 1])
            at = at[head]
        else:
            return [unknown(place, head, at if isinstance(at, dict) else ())]
    if isinstance(at, list) and is_index(last, at):
        at[int(last)] = value
        return []
    if not isinstance(at, dict):
        return [f"{path} cannot be set: {'.'.join(heads)} is not a table."]
    at[last] = value
    return []


def _material(table: dict[str, Any], value: Any, heads: list[str]) -> Any:
    """Write the name of a component's material as a table, so that its constants can be set."""
    if not isinstance(value, str):
        return value
    names_one = heads[-1] == "material" or heads[-2:-1] == ["materials"]
    return {"material": value} if names_one or _takes_material(table, heads) else value


def _takes_material(table: dict[str, Any], heads: list[str]) -> bool:
    """Whether a table of a component of an installed kind may name a material."""
    components = table.get("components")
    if heads[0] != "components" or not isinstance(components, dict):
        return False
    component = components.get(heads[1]) if len(heads) > 1 else None
    kind = component.get("kind") if isinstance(component, dict) else None
    params = trusted_params(kind, Path(), imports=False)
    return params is not None and ".".join(heads[2:]) in dict(places(params))


def is_index(text: str, among: list[Any]) -> bool:
    """Whether a text is the number of an item of a list."""
    return text.isdecimal() and len(text) < 10 and int(text) < len(among)


def _may_be_made(heads: list[str]) -> bool:
    """Whether a scene may lack the table: its own, or inside a component's, which checks it."""
    return heads in (["output"], ["iteration"], ["error_bar"]) or (
        heads[0] == "components" and len(heads) > 2
    )


def tell_repeated(settings: Iterable[str], swaps: Iterable[str]) -> None:
    """Print which paths, and components to be swapped, are given more than once."""
    for option, values in (("--set", settings), ("--swap", swaps)):
        for path, count in Counter(setting.partition("=")[0] for setting in values).items():
            if count > 1:
                message = f"{option} {shown(path)} is given {count} times: the last one counts"
                print(f"quintet: {message}", file=sys.stderr)


def assignments(settings: Mapping[str, Any]) -> list[str]:
    """Write settings by dotted path as ``PATH=VALUE``."""
    return [f"{path}={value_text(value, path)}" for path, value in settings.items()]


def value_text(value: Any, path: str = "value") -> str:
    """Write one value as TOML on one line."""
    try:
        # Within two lists a table is written inline.
        text = tomli_w.dumps({"value": [[plain(value)]]}).removeprefix("value = ")
    except (TypeError, ValueError) as error:
        raise SceneError(f"{path}: a setting must be a value of TOML; found {value!r}.") from error
    # In texts a new line is escaped, so what is left of them lies between items of lists.
    text = re.sub(r"(?<=\[)\n *|,\n *(?=\])", "", text)
    return re.sub(r"\n *", " ", text).strip()[2:-2]


def plain(value: Any) -> Any:
    """Write numbers and arrays of numpy, and paths, as what TOML has."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, Mapping):
        return {str(key): plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(entry) for entry in value]
    return os.fspath(value) if isinstance(value, os.PathLike) else value


def run_arguments(
    scene: str,
    preset: str = "",
    settings: Iterable[str] = (),
    swaps: Iterable[str] = (),
    transport: str = "",
) -> list[str]:
    """Write a scene and its overrides as arguments of ``quintet run``."""
    line = [scene, *(["--preset", preset] if preset else [])]
    line += ["--transport", transport] if transport else []
    line += [word for swap in swaps for word in ("--swap", swap)]
    return [*line, *(word for setting in settings for word in ("--set", setting))]


def command_line(
    command: str,
    scene: str,
    preset: str = "",
    settings: Iterable[str] = (),
    swaps: Iterable[str] = (),
    transport: str = "",
    words: Iterable[str] = (),
) -> str:
    """Write a command of quintet about a scene for a shell; `words` are its own options."""
    arguments = run_arguments(scene, preset, settings, swaps, transport)
    return shlex.join(["quintet", command, *arguments, *words])
