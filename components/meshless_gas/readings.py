"""What a scene says about what is read of a gas: when it has settled, and where fronts are."""

from collections.abc import Callable, Sequence
from typing import Annotated, Literal

from pydantic import Field

from quintet.interfaces.params import Positive, Vector, parameters


@parameters
class Steady:
    """When a flow counts as settled: from then on the gas is left as it is.

    With it alone the gas gives `body.settled`, 1 from then on.

    Parameters
    ----------
    steps : 1
        Between two looks.
    change : 1
        Largest root mean square of the densities' relative change in a step.
    force : 1
        Largest change of the force on walls from look to look, over the sum of what acts on their
        nodes.
    """

    steps: Annotated[int, Field(ge=1)] = 200
    change: Positive = 1e-5
    force: Positive = 1e-4


@parameters
class Front:
    """A straight line on which a front is looked for.

    Parameters
    ----------
    begin, end : m
        Of the line.
    field
        What the front is a jump of.
    level : of the field
        The front is where it is first passed, from the line's begin on; nowhere if it is not.
    """

    begin: Vector
    end: Vector
    field: Literal["density", "pressure"] = "density"
    level: Positive

    def __post_init__(self) -> None:
        if self.begin == self.end:
            raise ValueError("fronts: a line must end elsewhere than it begins. Correct it.")


def wrong_places(
    probes: Sequence[Vector],
    fronts: Sequence[Front],
    holds: Callable[[Vector, int], bool],
    dimensions: int,
) -> list[str]:
    """Which places of probes and ends of fronts lie outside the nodes, or off their plane.

    `holds` says whether a place (3,) m lies in the cloud, of so many dimensions.
    """
    ends = [
        (f"fronts, item {k}: {name}", place)
        for k, front in enumerate(fronts)
        for name, place in (("begin", front.begin), ("end", front.end))
    ]
    places = [(f"probes, item {k}", place) for k, place in enumerate(probes)] + ends
    outside = [
        f"{name}: it must lie among the nodes; found {list(place)} m. Move it."
        for name, place in places
        if not holds(place, dimensions)
    ]
    return outside + [
        f"{name}: in two dimensions a line lies in the plane y = 0; found {list(place)} m. Set y "
        "to 0."
        for name, place in ends
        if dimensions == 2 and place[1] != 0.0
    ]
