"""``[components.NAME]``: kind and settings of each component, checked by its manifest."""

from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from quintet.coupler.scene.foreign_code import is_trusted, unread_manifest
from quintet.coupler.scene.scene import NAME, ComponentKeys, ComponentPlan
from quintet.interfaces.errors import QuintetError, SceneError
from quintet.interfaces.manifest import Manifest, find, known_kinds, unknown_kind
from quintet.interfaces.params import beyond_computing, read, shown

Table = dict[str, Any]


def require_components(path: Path, table: Table, mistakes: list[str]) -> Table:
    """Tables of the components; without any, nothing else can be said of a scene."""
    tables = table.get("components", {})
    if isinstance(tables, dict) and tables:
        return tables
    said = "components: a scene needs at least one. Add [components.NAME]."
    if tables:
        said = f"components must be tables; found {shown(tables)}. Write [components.NAME]."
    raise SceneError([f"{path.name}: {mistake}" for mistake in (*mistakes, said)])


def read_components(
    table: Table, folder: Path, mistakes: list[str], imports: bool = True
) -> dict[str, ComponentPlan]:
    """Read the components of a scene; those with mistakes are left out.

    `imports` is whether code of the scene's own may be imported to read them.
    """
    plans = {}
    for name, keys in table.items():
        if not NAME.fullmatch(name) or name == "coupler":
            mistakes.append(
                f"components: a name must be letters, digits, _ or -, and not coupler; found "
                f"{name!r}. Rename it."
            )
        elif not isinstance(keys, dict):
            mistakes.append(
                f"components.{name} must be a table; found {shown(keys)}. Give it a kind."
            )
        elif plan := _component(name, dict(keys), folder, mistakes, imports):
            plans[name] = plan
    return plans


def _component(
    name: str, keys: Table, folder: Path, mistakes: list[str], imports: bool
) -> ComponentPlan | None:
    where = f"components.{name}"
    if not isinstance(kind := keys.get("kind"), str):
        known = ", ".join(sorted(known_kinds()))
        mistakes.append(f"{where}.kind must be a name; found {shown(kind)}. Known here: {known}.")
        return None
    of_all = {field.name for field in fields(ComponentKeys)} & keys.keys()
    common, wrong = read(ComponentKeys, {key: keys.pop(key) for key in of_all}, where)
    mistakes += wrong
    if common is None:
        return None
    if not (imports or is_trusted(kind, folder)):
        unread = unread_manifest(kind)
        return ComponentPlan(
            name, kind, unread, keys, None, (), (), threads=common.threads, unread=True
        )
    manifest = _manifest(where, kind, mistakes)
    if manifest is None:
        return None
    try:
        params, wrong = read(manifest.params, keys, where, folder)
        if wrong:
            mistakes += wrong
            return None
        with np.errstate(over="raise", divide="raise", invalid="raise"):
            takes, gives = manifest.ports(params)
            plan = manifest.plan(params) if manifest.plan else None
    except QuintetError as error:
        mistakes.append(f"{where}: {error}")
        return None
    except (ArithmeticError, np.linalg.LinAlgError) as error:
        mistakes.append(beyond_computing(where, keys, error))
        return None
    except Exception as error:  # of any kind: what it does here is its author's
        said = f"{type(error).__name__}: {error}"
        mistakes.append(f"{where}: kind {kind} cannot tell its ports from these settings ({said}).")
        return None
    return ComponentPlan(name, kind, manifest, keys, params, takes, gives, common.threads, plan)


def _manifest(where: str, kind: str, mistakes: list[str]) -> Manifest | None:
    try:
        return find(kind)
    except KeyError:
        mistakes.append(unknown_kind(f"{where}.kind {kind}", kind))
    except QuintetError as error:
        mistakes.append(f"{where}.{error}")
    except (Exception, SystemExit) as error:  # of any kind: the module is its author's
        said = f"{type(error).__name__}: {error}"
        mistakes.append(f"{where}.kind {kind} cannot be imported ({said}). Name a module:Class.")
    return None
