"""A file for programs that a command leaves where it is told to; nothing else is ever replaced."""

import json
from collections.abc import Collection
from pathlib import Path
from typing import Any

from quintet.coupler.files.disk import write_whole
from quintet.interfaces.errors import SceneError


class JsonFile:
    """What a command found, as JSON; with no path, nowhere."""

    def __init__(self, path: Path | None, keys: Collection[str]) -> None:
        """Refuse a file, before anything is done, that is not what such a command left.

        Parameters
        ----------
        path : path or None
            As given.
        keys : collection of str
            Of the table that the command leaves, or of each in its list.
        """
        self.path = path
        if path and path.exists() and not _is_of(path, keys):
            raise SceneError(
                f"--json {path}: it must be new, or what this command left there before; it is "
                "something else. Name another file."
            )

    def write(self, content: Any) -> None:
        """Write the file whole."""
        if self.path:
            write_whole(self.path, json.dumps(content, indent=2))


def _is_of(path: Path, keys: Collection[str]) -> bool:
    """Whether a file is empty, or JSON of tables with these keys."""
    try:
        text = path.read_bytes().decode()
        found = json.loads(text) if text else []
    except (OSError, ValueError, RecursionError):
        return False
    tables = found if isinstance(found, list) else [found]
    return all(isinstance(one, dict) and one.keys() >= set(keys) for one in tables)
