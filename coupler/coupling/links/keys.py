"""The keys of a link's table in a scene."""

from collections.abc import Mapping
from typing import Any

from quintet.coupler.coupling.exchange import Ports
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import shown, unknown


def between(
    number: int, given: Mapping[str, Any], ports: Mapping[str, Ports], *more: str
) -> tuple[str, tuple[str, str]]:
    """Name of a link and the two components that it is between; it may have `more` keys."""
    only(number, given, ("kind", "name", "between", *more))
    pair: Any = given.get("between")
    if not is_pair(pair) or pair[0] == pair[1]:
        raise SceneError(
            f"links.{number}.between must name two components; found {shown(pair)}. Name both."
        )
    for name in pair:
        if name not in ports:
            raise SceneError(unknown(f"links.{number}: component {name}", name, ports))
    return str(given.get("name", "-".join(pair))), (pair[0], pair[1])


def is_pair(value: Any) -> bool:
    """Whether it is a list of two texts."""
    return isinstance(value, list) and [type(one) for one in value] == [str, str]


def is_stand_in(ports: Ports | None) -> bool:
    """Whether a component takes nothing at all, as a recording does: it is sent nothing."""
    return ports is not None and not ports[0]


def only(number: int, given: Mapping[str, Any], known: tuple[str, ...]) -> None:
    """Refuse keys that a link's table does not have."""
    wrong = [unknown(f"links.{number}.{key}", key, known) for key in given if key not in known]
    if wrong:
        raise SceneError(wrong)
