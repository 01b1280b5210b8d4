"""Links: one file, one kind of exchange between two components.

``KINDS`` makes a link from its table in the scene; it imports only the kinds that are named.
"""

from collections.abc import Callable, Mapping
from typing import Any

from quintet.coupler.coupling.exchange import Link, Ports
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import unknown

CONTACTS = ("walls", "potential")  # as at the fluid's walls, or by a contact potential
Maker = Callable[[int, dict[str, Any], Mapping[str, Ports]], Link]


def _fsi(number: int, given: dict[str, Any], ports: Mapping[str, Ports]) -> Link:
    # Only kinds that a scene names are loaded.
    from quintet.coupler.coupling.links.fsi import join

    name, pair = _between(number, given, ports, "contact")
    contact = given.get("contact", CONTACTS[0])
    if contact not in CONTACTS:
        raise SceneError(
            f"links.{number}.contact must be one of {', '.join(CONTACTS)}, as at the fluid's walls "
            f"or by a contact potential; found {contact!r}. Correct it, or leave it out for walls."
        )
    return join(name, pair, ports, contact == "potential")


def _glue(number: int, given: dict[str, Any], ports: Mapping[str, Ports]) -> Link:
    # Only kinds that a scene names are loaded.
    from quintet.coupler.coupling.links.glue import join

    return join(*_between(number, given, ports), ports)


def _direct(number: int, given: dict[str, Any], ports: Mapping[str, Ports]) -> Link:
    # Only kinds that a scene names are loaded.
    from quintet.coupler.coupling.links.direct import join

    _only(number, given, ("kind", "name", "pairs"))
    pairs = given.get("pairs")
    if not isinstance(pairs, list) or not all(isinstance(p, list) and len(p) == 2 for p in pairs):
        raise SceneError(
            f"links.{number}.pairs must be pairs of ports, the giver first, as in "
            f'[["a.motion", "b.foot"]]; found {pairs!r}.'
        )
    names = dict.fromkeys(str(path).split(".")[0] for pair in pairs for path in pair)
    return join(str(given.get("name", "-".join(names))), pairs, ports)


def _between(
    number: int, given: dict[str, Any], ports: Mapping[str, Ports], *more: str
) -> tuple[str, tuple[str, str]]:
    _only(number, given, ("kind", "name", "between", *more))
    pair = given.get("between")
    if not isinstance(pair, list) or len(pair) != 2 or pair[0] == pair[1]:
        raise SceneError(f"links.{number}.between must name two components; found {pair!r}.")
    for name in pair:
        if name not in ports:
            raise SceneError(unknown(f"links.{number}: component {name}", str(name), ports))
    return str(given.get("name", "-".join(pair))), (pair[0], pair[1])


def _only(number: int, given: dict[str, Any], known: tuple[str, ...]) -> None:
    wrong = [unknown(f"links.{number}.{key}", key, known) for key in given if key not in known]
    if wrong:
        raise SceneError(wrong)


KINDS: dict[str, Maker] = {"fsi": _fsi, "glue": _glue, "direct": _direct}
