"""Parameters of mooring lines; checked once, before a run starts."""

from typing import Annotated, ClassVar

from pydantic import Field

from quintet.interfaces.params import NotNegative, Positive, Vector, parameters


@parameters
class Line:
    """One line between an anchor that stands still and a body of a partner.

    Parameters
    ----------
    anchor : m
        Its fixed end.
    fairlead : m
        Where it is made fast to the body, as the run begins.
    body : 1
        Number of the body among those that the link brings, from 0.
    length : m
        Without pull.
    stiffness : N
        EA, pull over strain: Young's modulus times the area of the section.
    weight : N/m
        Of a length, less that of the water in its place. A line without weight is straight.
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


@parameters
class MooringLinesParams:
    """Lines that hold bodies; z is upwards.

    Parameters
    ----------
    lines
        In the order in which gauges count them.
    line_gauge
        Whether the pull of each line is given, as port `line_gauge`.
    """

    lines: Annotated[tuple[Line, ...], Field(min_length=1)]
    line_gauge: bool = True
