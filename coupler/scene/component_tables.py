"""``[components.NAME]``: kind and settings of each component, checked by its manifest."""

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from quintet.coupler.scene.foreign_code import is_trusted, unread_manifest
from quintet.coupler.scene.scene import NAME, ComponentKeys, ComponentPlan
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import QuintetError, SceneError
from quintet.interfaces.manifest import Manifest, find, known_kinds, unknown_kind
from quintet.interfaces.params import beyond_computing, read, shown

Table = dict[str, Any]
DEVICE = re.compile(r"opencl(:\d{1,4}(,\d{1,4})*)?")
Pair = tuple[tuple[str, str], tuple[str, str]]  # component and port of the giver, of the taker


def require_components(path: Path, table: Table, mistakes: list[str]) -> Table:
    """Tables of the components; without any, nothing else can be said of a scene."""
    tables = table.get("components", {})
    if isinstance(tables, dict) and tables:
        return tables
    message = "components: a scene needs at least one. Add [components.NAME]."
    if tables:
        message = f"components must be tables; found {shown(tables)}. Write [components.NAME]."
    raise SceneError([f"{path.name}: {mistake}" for mistake in (*mistakes, message)])


def read_components(
    table: Table,
    folder: Path,
    mistakes: list[str],
    imports: bool = True,
    links: Iterable[Table] = (),
    begun: Collection[str] = (),
) -> dict[str, ComponentPlan]:
    """Read the components of a scene; those with mistakes are left out.

    Parameters
    ----------
    table
        Tables of the components by their names.
    folder
        Of the scene.
    mistakes
        Added to.
    imports
        Whether code of the scene's own may be imported to read them.
    links
        Tables of the links: components whose tables their partners complete are read last.
    begun
        Components that begin from another run: where they would stand otherwise is not checked.
    """
    plans: dict[str, ComponentPlan] = {}
    pairs = list(_pairs(links))
    completed = {taker for _, (taker, _) in pairs if _is_completed(table.get(taker))}
    last = completed | {name for name in table if _is_code(table[name])}
    for name in sorted(table, key=last.__contains__):
        keys = table[name]
        if not NAME.fullmatch(name) or name == "coupler":
            mistakes.append(
                f"components: a name must be letters, digits, _ or -, and not coupler; found "
                f"{name!r}. Rename it."
            )
        elif not isinstance(keys, dict):
            mistakes.append(
                f"components.{name} must be a table; found {shown(keys)}. Give it a kind."
            )
        elif not _waits(name, pairs, completed, table.keys() - plans.keys()):
            partners = _starts(name, pairs, plans) if name in last else {}
            settings = (name, dict(keys), folder, mistakes, imports, partners)
            if plan := _component(*settings, begun=name in begun):
                plans[name] = plan
    return {name: plans[name] for name in table if name in plans}


def _pairs(links: Iterable[Table]) -> Iterator[Pair]:
    """Components and ports that links pair, the giver's first; mistakes are left out."""
    for link in links:
        pairs = link.get("pairs")
        for pair in pairs if isinstance(pairs, list) else ():
            if isinstance(pair, list) and len(pair) == 2 and all(isinstance(p, str) for p in pair):
                (giver, _, source), (taker, _, target) = (path.partition(".") for path in pair)
                yield (giver, source), (taker, target)


def _is_code(keys: Any) -> bool:
    """Whether a component is a class of the scene's own, whose table partners may complete."""
    return isinstance(keys, dict) and ":" in str(keys.get("kind", ""))


def _is_completed(keys: Any) -> bool:
    """Whether partners complete the table of a component, of an installed kind."""
    kind = keys.get("kind") if isinstance(keys, dict) else None
    try:
        return kind in known_kinds() and find(str(kind)).complete is not None
    except Exception:  # reported as it is read
        return False


def _waits(name: str, pairs: Iterable[Pair], completed: set[str], unread: set[str]) -> bool:
    """Whether the table of a component lacks what a partner with mistakes would state."""
    partners = {giver for (giver, _), (taker, _) in pairs if taker == name}
    return name in completed and bool(partners & unread - completed)


def _starts(name: str, pairs: Iterable[Pair], plans: Mapping[str, ComponentPlan]) -> Fields:
    """What the partners of a component state at the start, by its own ports."""
    fields: dict[str, Array] = {}
    for (giver, source), (taker, target) in pairs:
        if taker != name or giver not in plans:
            continue
        try:
            start = plans[giver].initial()
        except Exception:  # of any kind: it is reported as the scene's start is checked
            continue
        for key, array in start.items():
            port, _, field = key.partition(".")
            if port == source:
                fields[f"{target}.{field}"] = array
    return fields


def _component(
    name: str,
    keys: Table,
    folder: Path,
    mistakes: list[str],
    imports: bool,
    partners: Fields,
    begun: bool,
) -> ComponentPlan | None:
    where = f"components.{name}"
    if not isinstance(kind := keys.get("kind"), str):
        known = ", ".join(sorted(known_kinds()))
        mistakes.append(f"{where}.kind must be a name; found {shown(kind)}. Known here: {known}.")
        return None
    of_all = {field.name for field in fields(ComponentKeys)}
    common_keys = {key: keys.pop(key) for key in of_all & keys.keys()}
    common, wrong = read(ComponentKeys, common_keys, where)
    mistakes += wrong
    if common is None:
        return None
    if not (imports or is_trusted(kind, folder)):
        unread = unread_manifest(kind)
        return ComponentPlan(
            name, kind, unread, keys, None, (), (), threads=common.threads,
            ranks=common.ranks, unread=True,
        )  # fmt: skip
    manifest = _manifest(where, kind, mistakes)
    if manifest is None:
        return None
    if sentence := _wrong_ranks(where, kind, common, manifest) or _wrong_device(
        where, common, manifest
    ):
        mistakes.append(sentence)
        return None
    try:
        if partners and manifest.complete:
            keys = manifest.complete(keys, partners)
        params, wrong = read(manifest.params, keys, where, folder, not begun, of_all)
        if wrong:
            mistakes += wrong
            return None
        manifest.check_ranks(params, common.ranks)
        manifest.check_device(params, common.device, common.ranks)
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
        cause = f"{type(error).__name__}: {error}"
        mistakes.append(
            f"{where}: kind {kind} cannot tell its ports from these settings ({cause})."
        )
        return None
    return ComponentPlan(
        name, kind, manifest, keys, params, takes, gives, common.threads, common.ranks, plan, begun,
        device=common.device,
    )  # fmt: skip


def _wrong_ranks(where: str, kind: str, common: ComponentKeys, manifest: Manifest) -> str:
    """Sentence about several ranks of a kind that computes on one; "" if it can."""
    if common.ranks == 1 or manifest.ranks:
        return ""
    return (
        f"{where}.ranks must be 1, for kind {kind} computes on one rank; found {common.ranks}. "
        "Give it threads."
    )


def _wrong_device(where: str, common: ComponentKeys, manifest: Manifest) -> str:
    """Sentence about a device on which a component cannot compute; "" if it can."""
    device = common.device
    if device == "cpu":
        return ""
    if not DEVICE.fullmatch(device):
        return (
            f"{where}.device must be cpu, opencl, or opencl:0 and so on, of several ranks also "
            f"opencl:0,1 and so on; found {shown(device)}. `quintet devices` lists the devices of "
            "this machine."
        )
    if not manifest.opencl:
        return (
            f"{where}.device must be cpu, for kind {manifest.kind} computes on the processor; "
            f"found {device}. Remove it."
        )
    if common.ranks > 1 and not manifest.opencl_ranks:
        return (
            f"{where}.ranks must be 1 of kind {manifest.kind} on a device; found {common.ranks} "
            f"and {device}. Remove one of them."
        )
    numbers = device.count(",") + 1
    if numbers not in (1, common.ranks):
        return (
            f"{where}.device must have one number, for all ranks, or one for each rank; found "
            f"{device} and ranks = {common.ranks}. Change one of them."
        )
    return ""


def _manifest(where: str, kind: str, mistakes: list[str]) -> Manifest | None:
    try:
        return find(kind)
    except KeyError:
        mistakes.append(unknown_kind(f"{where}.kind {kind}", kind))
    except QuintetError as error:
        mistakes.append(f"{where}.{error}")
    except (Exception, SystemExit) as error:  # of any kind: the module is its author's
        cause = f"{type(error).__name__}: {error}"
        mistakes.append(f"{where}.kind {kind} cannot be imported ({cause}). Name a module:Class.")
    return None
