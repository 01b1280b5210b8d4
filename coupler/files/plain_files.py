"""Files of a run are plain files of its folder: nothing is written or removed through a link.

A symbolic link in the place of a file leads into another folder, and a file with several hard
links is also another's; a run that wrote there would change what is not its own.
"""

import os
import stat
from collections.abc import Iterable, Iterator
from pathlib import Path

from quintet.interfaces.errors import SceneError

SPECIAL = {
    stat.S_IFIFO: "a named pipe",
    stat.S_IFSOCK: "a socket",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
}


def require_plain(folder: Path, files: Iterable[Path]) -> None:
    """Refuse links and special files in the place of files of a run, and of folders above them.

    Parameters
    ----------
    folder : Path
        Of the run; links that lead to it are the user's own.
    files : iterable of Path
        Below the folder; those that do not exist are free.
    """
    above: set[Path] = set()
    for path in files:
        above.update(list(path.relative_to(folder).parents)[:-1])
        _require(folder, path, _wrong_file(path))
    for place in sorted(above):
        _require(folder, folder / place, _wrong_folder(folder / place))


def require_no_links(folder: Path) -> None:
    """Refuse symbolic links anywhere below a folder."""
    for place in _below(folder):
        if place.is_symlink():
            _require(folder, place, _link(place))


def _below(folder: Path) -> Iterator[Path]:
    for place, folders, files in os.walk(folder):  # which follows no link
        yield from (Path(place, name) for name in (*folders, *files))


def _require(folder: Path, path: Path, wrong: str) -> None:
    if wrong:
        raise SceneError(
            f"{folder}: {path.relative_to(folder)} must be this folder's own, so that nothing "
            f"else is changed; it is {wrong}. Remove it, or name another folder."
        )


def _wrong_file(path: Path) -> str:
    """What stands in the place of a file, if it must not be written to; else nothing."""
    try:
        status = path.lstat()
    except (FileNotFoundError, NotADirectoryError):
        return ""
    if stat.S_ISLNK(status.st_mode):
        return _link(path)
    if stat.S_ISDIR(status.st_mode):
        return "a folder in the place of a file"
    if not stat.S_ISREG(status.st_mode):
        return SPECIAL.get(stat.S_IFMT(status.st_mode), "no plain file")
    return f"one of {status.st_nlink} hard links to a file" if status.st_nlink > 1 else ""


def _wrong_folder(path: Path) -> str:
    if path.is_symlink():
        return _link(path)
    return "" if path.is_dir() or not path.exists() else "a file in the place of a folder"


def _link(path: Path) -> str:
    return f"a symbolic link to {os.readlink(path)}"
