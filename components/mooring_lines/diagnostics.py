"""Totals, failures, notes and warnings of lines."""

import numpy as np

from quintet.components.mooring_lines.state import Array, Lines, State
from quintet.interfaces.component import Totals
from quintet.interfaces.errors import StepError

MOST_TOLD = 8  # lines, in a note
STRETCHED = 0.2  # of a line's length: more is warned of


def failure(line: int, fairlead: Array, lines: Lines, state: State) -> StepError:
    """What a line that has no place is reported with."""
    rise = float(fairlead[line, 2] - lines.anchor[line, 2])
    reason = "its shape was not found. Check its length, stiffness and weight"
    if not np.isfinite(fairlead[line]).all():
        reason = f"the motion of body {lines.body[line]} is not finite. Check its loads"
    elif lines.has_bed[line] and rise < 0.0:
        reason = (
            f"its fairlead is {-rise:.4g} m below the bed. Set on_bed = false if it may be there"
        )
    return StepError(f"line {line}, at {state.clock[0]:.6g} s: {reason}.", fairlead[line])


def totals(energy: float) -> Totals:
    """Lines have no mass; their energy is that of stretch, and of weight above the anchors."""
    return Totals(potential=energy, dissipated=0.0)


def notes(lines: Lines, state: State) -> tuple[str, ...]:
    """Which body each line holds, where there are several."""
    if len(state.position) < 2:
        return ()
    reach = np.linalg.norm(state.arm, axis=1)
    held = [
        f"line {line} holds body {body}, {reach[line]:.4g} m from its centre of mass"
        for line, body in enumerate(lines.body[:MOST_TOLD].tolist())
    ]
    more = [f"{len(lines.body) - MOST_TOLD} more lines"] if len(lines.body) > MOST_TOLD else []
    return ("; ".join([*held, *more]),)


def warnings(gauge: Array, lines: Lines, mass: Array, step: float) -> dict[str, str]:
    """Warn of lines that are stretched beyond the strength of cables, and of unstable windows.

    Windows must be shorter than 2 √(m/k), as steps of leap-frog for a mass m on a spring k.
    """
    texts = {}
    strain = gauge[:, 0] / lines.stiffness
    line = int(strain.argmax())
    if strain[line] > STRETCHED:
        texts["stretch"] = (
            f"line {line} is stretched by {100.0 * strain[line]:.3g} %; cables break before "
            f"{100.0 * STRETCHED:g} %. Check lines.{line}.length and stiffness."
        )
    stiffness = np.bincount(lines.body, gauge[:, 3], len(mass))
    squares = stiffness / mass  # 1/s2
    body = int(squares.argmax())
    if step * step * squares[body] > 4.0:
        longest = 2.0 / squares[body] ** 0.5
        texts["window"] = (
            f"windows must be shorter than {longest:.3g} s for body {body} on lines of "
            f"{stiffness[body]:.3g} N/m; found {step:.3g} s. Set a shorter window."
        )
    return texts
