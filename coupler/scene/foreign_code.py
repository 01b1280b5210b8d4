"""Which kinds of components may be imported to check a scene, and what is said of the others.

A scene is data: to check one of somebody else must not run code that lies beside it, nor a module
that its author picked. Kinds that are installed under ``quintet.components`` are trusted as every
installed package is; so is quintet itself with the scenes that come with it.
"""

import os
from collections.abc import Iterable, Mapping
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from quintet.interfaces.component import Port
from quintet.interfaces.manifest import Manifest, find, known_kinds
from quintet.interfaces.params import parameters
from quintet.interfaces.serving.process import STARTER

_announced: set[tuple[str, str]] = set()  # kinds, and the files of which this process told


@parameters
class Unread:
    """Keys of a kind that was not imported."""


def _no_ports(_: Any) -> tuple[tuple[Port, ...], tuple[Port, ...]]:
    return (), ()


def unread_manifest(kind: str) -> Manifest:
    """Manifest in the place of that of a kind which was not imported: no keys and no ports."""
    return Manifest(kind, "code that was not imported", Unread, kind, _no_ports)


def is_trusted(kind: str, folder: Path) -> bool:
    """Whether a kind may be imported to check a scene in a folder."""
    module = kind.partition(":")[0]
    if ":" not in kind or kind in known_kinds().values() or module.split(".")[0] == "quintet":
        return True
    file = folder.resolve() / f"{module}.py"
    library = Path(str(files("quintet.scenarios"))).resolve()
    ours = library in file.parents and "." not in module and file.is_file()
    return ours and _origin(module) in (None, str(file))


def trusted_params(kind: Any, folder: Path, imports: bool) -> type | None:
    """Parameter class of a kind; None of one that is not to be imported, or cannot be.

    `imports` tells whether code of the scene's own may be imported.
    """
    if not isinstance(kind, str):
        return None
    if not (imports or is_trusted(kind, folder)):
        return None
    try:
        manifest = find(kind)
    except (Exception, SystemExit):  # of any kind: reported as the component is read
        return None
    return manifest.params


def trusted_tables(tables: Any, folder: Path) -> dict[str, Any]:
    """Tables of components whose kinds may be imported to check a scene in a folder."""
    if not isinstance(tables, Mapping):
        return {}
    return {
        name: keys
        for name, keys in tables.items()
        if isinstance(keys, Mapping) and is_trusted(str(keys.get("kind", "")), folder)
    }


def unread_note(names: Iterable[str], kind: str) -> str:
    """Say what was not checked of components of a kind, and what checks it."""
    return (
        f"not checked: keys, ports, links and expectations of {', '.join(names)}, as {kind} is "
        "code that only --import, or a run, imports"
    )


def announce(kinds: Iterable[str], folder: Path) -> None:
    """Print, once for each, which code of a scene's own is imported now, from where.

    A process that was started by another one of quintet says nothing: that one has said it.
    """
    if STARTER in os.environ:
        return
    for kind in dict.fromkeys(kinds):
        module = kind.partition(":")[0]
        where = _origin(module) or f"a module {module}"
        if (kind, where) not in _announced and not is_trusted(kind, folder):
            _announced.add((kind, where))
            print(f"the scene's kind {kind} is code: importing {where}", flush=True)


def _origin(module: str) -> str | None:
    """File of a module, or of the package that it is in; nothing of it is run to find it."""
    try:
        spec = find_spec(module.split(".")[0])
    except (ImportError, ValueError):
        return None
    return spec.origin if spec else None
