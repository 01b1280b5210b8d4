"""The keys of ``[iteration]``: how windows are repeated until what crosses the links agrees."""

from collections.abc import Iterable, Mapping
from dataclasses import field
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from quintet.interfaces.component import Port
from quintet.interfaces.params import Count, Fraction, Positive, parameters, unknown

Windows = Annotated[int, Field(ge=0)]


@parameters
class IterationSettings:
    """How windows are repeated.

    Parameters
    ----------
    acceleration
        How the next guess is made: relaxed by a constant factor, by Aitken's (small interfaces,
        little added mass), or by interface quasi-Newton (strong coupling).
    tolerance : 1
        A field has converged when its residual, what was found less what was guessed, is below
        this share of its norm.
    absolute : of the field, of an impulse that of its rate
        By ``"component.port.field"`` of the side that takes it: the root mean square of the
        residual below which it counts as converged, however small its values are.
    limit : 1
        Repetitions of one window at most.
    relaxation : 1
        Share of the residual that is added to the guess: always (constant), in the first
        repetition of a window at most (aitken), while there are no columns (iqn-ils).
    reuse : 1
        Former windows whose columns are used again (iqn-ils).
    filter : 1
        A column of which newer ones leave less than this share is dropped (iqn-ils).
    at_limit
        What happens when `limit` is met: the run ends, or goes on with what was found.

    References
    ----------
    Küttler and Wall (2008), Comput. Mech. 43, 61; Degroote, Bathe and Vierendeels (2009),
    Comput. Struct. 87, 793; Mehl et al. (2016), Comput. Math. Appl. 71, 869.
    """

    RENAMED: ClassVar = {"aitken": "acceleration"}

    acceleration: Literal["constant", "aitken", "iqn-ils"] = "aitken"
    tolerance: Positive = 1e-6
    absolute: Mapping[str, Positive] = field(default_factory=dict)
    limit: Count = 50
    relaxation: Positive = 0.5
    reuse: Windows = 10
    filter: Fraction = 1e-2
    at_limit: Literal["stop", "continue"] = "stop"


def unknown_fields(
    settings: IterationSettings,
    takes: Mapping[str, Iterable[Port]],
    where: str = "iteration",
    unread: tuple[str, ...] = (),
) -> list[str]:
    """Say which keys of `absolute` no component takes; `takes` gives the ports of each.

    Of keys that begin with one of `unread` nothing is known.
    """
    known = [
        f"{name}.{port.name}.{field.name}"
        for name, ports in takes.items()
        for port in ports
        for field in port.fields
    ]
    wrong = [key for key in settings.absolute if key not in known and not key.startswith(unread)]
    return [unknown(f"{where}.absolute: field {key}", key, known) for key in wrong]
