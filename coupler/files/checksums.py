"""Checksums of the files of a run that are no HDF5: its results, ledger, logs and scene.

Results hold those of the other files, and one of themselves; snapshots hold those of files that a
resumed run continues. Both are CRC-32, as of recordings.
"""

import json
import zlib
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from quintet.coupler.files.disk import check_length
from quintet.interfaces.errors import SceneError

KEY = "checksums"  # in results, by file
OWN = "results.json"
BLOCK = 1 << 20  # bytes read at once


def of_file(path: Path, size: int | None = None) -> list[int]:
    """Length [bytes] and checksum of a file, or of its beginning."""
    crc, left = 0, path.stat().st_size if size is None else size
    done = 0
    with open(path, "rb") as file:
        while block := file.read(min(BLOCK, left - done)):
            crc, done = zlib.crc32(block, crc), done + len(block)
    return [done, crc]


def of_files(folder: Path, names: Iterable[str]) -> dict[str, list[int]]:
    """The same of those files of a folder that are there."""
    return {name: of_file(folder / name) for name in names if (folder / name).is_file()}


def require_same(folder: Path, sums: Mapping[str, list[int]], names: Iterable[str]) -> None:
    """Refuse files of a folder that do not begin as they were when their checksums were made."""
    for name in names:
        if name not in sums:
            continue
        path, (size, _) = folder / name, sums[name]
        check_length(path, size)
        if of_file(path, size) != list(sums[name]):
            raise SceneError(
                f"{path}: its first {size} bytes must be as the run wrote them; they were changed. "
                "Copy the file again from where it was made, or run the scene again."
            )


def sealed(content: Mapping[str, Any], sums: Mapping[str, list[int]]) -> str:
    """Write results as JSON, with the checksums of other files and their own."""
    table = json.loads(json.dumps({**content, KEY: dict(sums)}, default=float))
    table[KEY][OWN] = _own(table)
    return json.dumps(table, indent=2)


def require_sealed(table: dict[str, Any], path: Path) -> None:
    """Refuse results that are not as they were written; what has no checksums passes."""
    if KEY not in table:
        return
    sums = table[KEY] if isinstance(table[KEY], dict) else {}
    rest = {**table, KEY: {name: sum_of_file for name, sum_of_file in sums.items() if name != OWN}}
    if sums.get(OWN) != _own(rest):
        raise SceneError(
            f"{path}: it must be as the run wrote it; it was changed. Copy it again from where it "
            "was made, or run the scene again."
        )


def _own(table: Mapping[str, Any]) -> int:
    return zlib.crc32(json.dumps(table).encode())
