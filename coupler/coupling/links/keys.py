"""The keys of a link's table in a scene: published by its kind, checked before it is made."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from typing import Annotated, Any

from pydantic import BeforeValidator

from quintet.coupler.coupling.link import Link, Ports
from quintet.interfaces.errors import SceneError
from quintet.interfaces.params import parameters, read, renamed_keys, shown, unknown


def _is_pair(value: Any) -> bool:
    return isinstance(value, list) and [type(entry) for entry in value] == [str, str]


def _two_components(value: Any) -> tuple[Any, ...]:
    if not _is_pair(value) or value[0] == value[1]:
        raise ValueError(f"between must name two components; found {shown(value)}. Name both.")
    return tuple(value)


def _port_pairs(value: Any) -> tuple[Any, ...]:
    if not isinstance(value, list) or not value or not all(map(_is_pair, value)):
        raise ValueError(
            "pairs must be pairs of ports, the giver first, as in "
            f'[["a.motion", "b.foot"]]; found {shown(value)}. Name both of each.'
        )
    pairs = [tuple(pair) for pair in value]
    if twice := [pair for number, pair in enumerate(pairs) if pair in pairs[:number]]:
        raise ValueError(
            f"pairs must be different, as what is carried twice counts twice; found "
            f"{shown(list(twice[0]))} again. Remove it."
        )
    return tuple(pairs)


Between = Annotated[tuple[str, str], BeforeValidator(_two_components)]
Pairs = Annotated[tuple[tuple[str, str], ...], BeforeValidator(_port_pairs)]
Make = Callable[[str, Any, Mapping[str, Ports]], Link]  # name, its keys, ports of components


@parameters
class LinkKeys:
    """What links of all kinds have, beside the keys of their own kind.

    Parameters
    ----------
    kind
        An installed kind of link.
    name
        In the ledger; the names of its components if not given.
    """

    kind: str
    name: str = ""


@dataclass(frozen=True, slots=True)
class LinkKind:
    """A kind of link with the parameter class of its keys; called with a table, it makes one."""

    keys: type
    make: Make

    def __call__(self, number: int, table: dict[str, Any], ports: Mapping[str, Ports]) -> Link:
        """Check the table, and make the link; one between two has their names if it has none."""
        where, common = f"links.{number}", {field.name for field in fields(LinkKeys)}
        own_names = {field.name for field in fields(self.keys)}
        known = [*common, *own_names, *renamed_keys(self.keys)]
        if strange := [key for key in table if key not in known]:
            raise SceneError([unknown(f"{where}.{key}", key, known) for key in strange])
        shared = {"kind": "", **{key: value for key, value in table.items() if key in common}}
        all_have, wrong = read(LinkKeys, shared, where)
        of_kind = {key: value for key, value in table.items() if key not in common}
        keys, also_wrong = read(self.keys, of_kind, where)
        if all_have is None or keys is None:
            raise SceneError([*wrong, *also_wrong])
        pair = getattr(keys, "between", ())
        for name in pair:
            if name not in ports:
                raise SceneError(unknown(f"{where}: component {name}", name, ports))
        return self.make(all_have.name or "-".join(pair), keys, ports)


def with_keys(keys: type) -> Callable[[Make], LinkKind]:
    """Make a kind of link of a function ``make(name, keys, ports)`` and the class of its keys.

    The class is made by `quintet.interfaces.params.parameters`; `keys` is one of it. Its
    docstring is what ``quintet describe`` and ``quintet schema`` tell of each key.
    """
    return lambda make: LinkKind(keys, make)


def is_stand_in(ports: Ports | None) -> bool:
    """Whether a component takes nothing at all, as a recording does: it is sent nothing."""
    return ports is not None and not ports[0]
