"""What a scene's partners must be like: checked as ports are joined and as a run begins."""

import numpy as np

from quintet.components.mooring_lines.params import MooringLinesParams
from quintet.interfaces.component import Array
from quintet.interfaces.errors import SceneError


def refuse_missing_bodies(params: MooringLinesParams, bodies: int) -> None:
    """Refuse lines of bodies that no partner has."""
    wrong = [(k, line.body) for k, line in enumerate(params.lines) if line.body >= bodies]
    if wrong:
        raise SceneError(
            [
                f"lines.{k}.body must be below {bodies}, the number of bodies that links bring; "
                f"found {body}. Correct it."
                for k, body in wrong
            ]
        )


def refuse_sunken_fairleads(params: MooringLinesParams, fairlead: Array) -> None:
    """Refuse lines on a bed whose fairleads begin below it."""
    height = fairlead[:, 2] - np.array([line.anchor[2] for line in params.lines])
    sentences = [
        f"lines.{k}: the fairlead must not be below the bed, on which the anchor stands; found it "
        f"{-rise:g} m below. Correct it, or set on_bed = false."
        for k, (line, rise) in enumerate(zip(params.lines, height.tolist(), strict=True))
        if line.weight > 0.0 and line.on_bed and rise < 0.0
    ]
    if sentences:
        raise SceneError(sentences)
