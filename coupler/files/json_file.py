"""A file for programs that a command leaves where it is told to; nothing else is ever replaced."""

import json
import os
from collections.abc import Collection
from pathlib import Path
from typing import Any

from quintet.coupler.files.disk import write_whole
from quintet.interfaces.errors import SceneError


class JsonFile:
    """What a command found, as JSON; with no path, nowhere."""

    def __init__(
        self,
        path: Path | None,
        keys: Collection[str],
        option: str = "--json",
        kind: type[dict[str, Any]] | type[list[Any]] | None = None,
    ) -> None:
        """Refuse a file, before anything is done, that is not what such a command left.

        Parameters
        ----------
        path : path or None
            As given.
        keys : collection of str
            Of the table that the command leaves, or of each in its list.
        option : str
            That names the file.
        kind : dict, list or None
            What the command leaves, if it leaves always the same: a table, or a list of tables.
        """
        self.path = path
        if path and path.exists() and not _is_of(path, keys, kind):
            raise SceneError(
                f"{option} {path}: it must be new, or what this command left there before; it is "
                "something else. Name another file."
            )

    def write(self, content: Any) -> None:
        """Write the file whole; where a link leads to it, the link stays."""
        if self.path:
            write_whole(self.path.resolve(), json.dumps(content, indent=2))


def require_writable(path: Path) -> None:
    """Refuse a file for results that cannot be written, before anything is computed for it."""
    # A file is replaced by a new one, for which its folder must be writable, too.
    places = [path.resolve().parent, *([path] if path.exists() else [])]
    if not all(os.access(place, os.W_OK) for place in places):
        raise SceneError(
            f"--json {path}: it must be a file that can be written; there is no such folder, or it "
            "is read-only. Name another."
        )
    if path.exists() and not path.is_file():  # a pipe or a device would be replaced as well
        raise SceneError(f"--json {path}: it must be a plain file; it is none. Name another.")


def _is_of(path: Path, keys: Collection[str], kind: type | None) -> bool:
    """Whether a file is empty, or JSON of tables with these keys."""
    try:
        text = path.read_bytes().decode()
        content = json.loads(text) if text else []
    except (OSError, ValueError, RecursionError):
        return False
    if text and kind and not isinstance(content, kind):
        return False
    tables = content if isinstance(content, list) else [content]
    return all(isinstance(entry, dict) and entry.keys() >= set(keys) for entry in tables)
