"""Where a picture or a page may be written: a place of ours, or one where nothing is."""

from collections.abc import Sequence
from pathlib import Path

from quintet.interfaces.errors import SceneError


def free_place(ours: Path, out: Path | None, formats: Sequence[str], force: bool) -> Path:
    """Choose the file of `--out`, or `ours` where there is none; refuse one that is there.

    `formats` are the endings that it may have.
    """
    if out is None:
        return ours
    if out.suffix.lower() not in formats:
        raise SceneError(
            f"--out {out}: it must end with one of {', '.join(formats)}; found "
            f"{out.suffix or 'no ending'}. Name another file."
        )
    if out.exists() and not force:
        raise SceneError(f"--out {out}: it exists. Name another file, or use --force.")
    return out
