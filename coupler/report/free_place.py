"""Where a picture or a page may be written: a place of ours, or one where nothing is."""

from collections.abc import Sequence
from pathlib import Path

from quintet.interfaces.errors import SceneError


def free_place(
    ours: Path, out: Path | None, formats: Sequence[str], force: bool, option: str = "--out"
) -> Path:
    """Choose the file of an option, or `ours` where there is none; refuse one that is there.

    `formats` are the endings that it may have.
    """
    if out is None:
        return ours
    if out.suffix.lower() not in formats:
        raise SceneError(
            f"{option} {out}: it must end with one of {', '.join(formats)}; found "
            f"{out.suffix or 'no ending'}. Name another file."
        )
    above = next(folder for folder in out.parents if folder.exists())
    if not above.is_dir():
        raise SceneError(
            f"{option} {out}: it must lie in a folder; {above} is none. Name another file."
        )
    if out.is_dir():
        raise SceneError(f"{option} {out}: it must be a file; found a folder. Name another file.")
    if out.exists() and not force:
        raise SceneError(f"{option} {out}: it exists. Name another file, or use --force.")
    return out
