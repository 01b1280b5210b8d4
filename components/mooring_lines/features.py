"""What the state of another run must be like, from which lines begin."""

import numpy as np

from quintet.components.mooring_lines.state import State
from quintet.interfaces.component import Fields
from quintet.interfaces.errors import SceneError


def refuse_other_lines(state: State, saved: Fields) -> None:
    """Refuse a state of other lines or bodies: lines stay fast where they were."""
    for name, what in (("fairlead", "lines"), ("position", "bodies")):
        before, now = len(saved[name]), len(getattr(state, name))
        if before != now:
            raise SceneError(
                f"the state that it begins from must be of its {now} {what}; found {before}. Make "
                "both scenes alike, or leave it out of begin_from.components."
            )
    moved = np.abs(saved["fairlead"] - state.fairlead).max(axis=1)
    if moved.any():
        raise SceneError(
            f"lines.{int(moved.argmax())}.fairlead must be that of the run from which it begins; "
            f"found it {moved.max():g} m away. Correct it, or leave the lines out of "
            "begin_from.components."
        )
