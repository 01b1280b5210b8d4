"""Totals, failures and warnings of lines."""

from quintet.components.mooring_lines.state import Array, Lines, State
from quintet.interfaces.component import Totals
from quintet.interfaces.errors import StepError

STRETCHED = 0.2  # of a line's length: more is warned of


def failure(line: int, fairlead: Array, lines: Lines, state: State) -> StepError:
    """What a line that has no place is reported with."""
    rise = float(fairlead[line, 2] - lines.anchor[line, 2])
    reason = (
        f"its fairlead is {-rise:.4g} m below the bed. Set on_bed = false if it may be there"
        if lines.has_bed[line] and rise < 0.0
        else "its shape was not found. Check its length, stiffness and weight"
    )
    return StepError(f"line {line}, at {state.clock[0]:.6g} s: {reason}.", fairlead[line])


def totals(energy: float) -> Totals:
    """Lines have no mass; their energy is that of stretch, and of weight above the anchors."""
    return Totals(potential=energy)


def warnings(tension: Array, lines: Lines) -> dict[str, str]:
    """Warn of lines that are stretched by more than cables bear."""
    strain = tension / lines.stiffness
    line = int(strain.argmax())
    if strain[line] <= STRETCHED:
        return {}
    return {
        "stretch": f"line {line} is stretched by {100.0 * strain[line]:.3g} %; cables break before "
        f"{100.0 * STRETCHED:g} %. Check lines.{line}.length and stiffness."
    }
