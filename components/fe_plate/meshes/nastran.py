"""What meshio's reader of Nastran files would lose without a word."""

from pathlib import Path
from typing import Any

import numpy as np

from quintet.interfaces.errors import SceneError

SUFFIXES = (".bdf", ".fem", ".nas")


def require_complete(path: Path) -> None:
    """Refuse a Nastran file that includes others, which meshio leaves out."""
    for number, line in enumerate(path.read_text(errors="replace").splitlines(), 1):
        if line.lstrip().upper().startswith("INCLUDE"):
            raise SceneError(
                f"file {path.name}, line {number}: it must have no INCLUDE; found one. Write all "
                "into one file."
            )


def require_basic_coordinates(path: Path, mesh: Any) -> None:
    """Refuse points in other coordinates than the basic ones, which meshio takes for these."""
    systems = np.asarray(mesh.point_data.get("nastran:ref", np.zeros(0)))
    if systems.any():
        raise SceneError(
            f"file {path.name}: each GRID must be in basic coordinates, a CP of 0 or none; found "
            f"{int(np.count_nonzero(systems))} in others, as {int(systems[systems != 0][0])}. "
            "Export the mesh in basic coordinates."
        )
