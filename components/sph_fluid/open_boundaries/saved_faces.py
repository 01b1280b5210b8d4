"""Faces with buffers in saved states: a state suits only a fluid with the same ones."""

from collections.abc import Sequence

import numpy as np

from quintet.components.sph_fluid.setup.geometry import FACES
from quintet.components.sph_fluid.state import Whole
from quintet.interfaces.component import Fields
from quintet.interfaces.errors import SceneError

SAVED = "passages"  # key of a saved state: numbers of `PASSAGES`, in the order of the buffers
PASSAGES = [f"{way} {face}" for way in ("inflow", "outflow") for face in FACES]


def numbers_of(names: Sequence[str]) -> dict[str, Whole]:
    """Field of a saved state for the names of buffers, as "inflow x-"."""
    return {SAVED: np.array([PASSAGES.index(name) for name in names], np.int64)}


def refuse_other_faces(saved: Fields, names: Sequence[str]) -> None:
    """Refuse a saved state whose buffers have other names, or another order."""
    before = [PASSAGES[number] for number in saved.get(SAVED, ())]
    if before != list(names):
        raise SceneError(
            "the state that it begins from must have the same inflows and outflows in the same "
            f"order, {_listed(names)}; found {_listed(before)}. Give boundary.inflow and "
            "boundary.outflow the faces that they had in that run; speeds and levels may differ."
        )


def _listed(names: Sequence[str]) -> str:
    return ", ".join(names) or "none"
