"""From parameters to lines and their first state."""

from collections.abc import Sequence

import numpy as np

from quintet.components.mooring_lines.params import Line
from quintet.components.mooring_lines.state import Lines, State


def lines_of(entries: Sequence[Line]) -> Lines:
    """What never changes of lines."""
    return Lines(
        anchor=np.array([line.anchor for line in entries], float),
        body=np.array([line.body for line in entries], np.int64),
        length=np.array([line.length for line in entries], float),
        stiffness=np.array([line.stiffness for line in entries], float),
        weight=np.array([line.weight for line in entries], float),
        has_bed=np.array([line.on_bed for line in entries], np.bool_),
    )


def first_state(entries: Sequence[Line], bodies: int) -> State:
    """State of lines before it is known where the bodies are."""
    lines = len(entries)
    orientation = np.zeros((bodies, 4))
    orientation[:, 0] = 1.0
    return State(
        fairlead=np.array([line.fairlead for line in entries], float),
        arm=np.zeros((lines, 3)),
        position=np.zeros((bodies, 3)),
        velocity=np.zeros((bodies, 3)),
        orientation=orientation,
        angular_velocity=np.zeros((bodies, 3)),
        load=np.zeros((bodies, 6)),
        pull=np.zeros((lines, 2)),
        clock=np.zeros(2),
    )
