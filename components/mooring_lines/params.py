"""Parameters of mooring lines; checked once, before a run starts."""

from typing import Annotated, ClassVar

from pydantic import Field

from quintet.components.mooring_lines.state import BELOW
from quintet.interfaces.params import NotNegative, Positive, Vector, parameters


@parameters
class Line:
    """One line between an anchor that stands still and a body of a partner.

    Parameters
    ----------
    anchor : m
        Its fixed end.
    fairlead : m
        Where it is made fast to the body, as the run begins, in the world.
    body : 1
        Number of the body, from 0; the bodies of several links follow one another in the order of
        the links.
    length : m
        Unstretched.
    stiffness : N
        EA, pull over strain: Young's modulus times the area of the section.
    weight : N/m
        Per unstretched length, in water. A line without weight is straight.
    on_bed
        Whether a line with weight may lie on a level bed at the height of its anchor. If not, it
        may hang below its anchor.
    """

    RENAMED: ClassVar = {"EA": "stiffness", "unstretched_length": "length"}
    anchor: Vector
    fairlead: Vector
    body: Annotated[int, Field(ge=0)] = 0
    length: Positive
    stiffness: Positive
    weight: NotNegative = 0.0
    on_bed: bool = True

    def __post_init__(self) -> None:
        rise = self.fairlead[2] - self.anchor[2]
        if self.weight > 0.0 and self.on_bed and rise < -BELOW * self.length:
            raise ValueError(
                "lines.fairlead must not be below the bed, which is at the height of the anchor; "
                f"found it {-rise:g} m below. Correct it, or set on_bed = false."
            )


@parameters
class MooringLinesParams:
    """Lines that hold bodies; z is upwards.

    Parameters
    ----------
    lines
        In the order in which gauges count them.
    """

    lines: Annotated[tuple[Line, ...], Field(min_length=1)]
