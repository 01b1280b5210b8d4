"""What is carried between components: the legs of all links, and how their rows meet."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np

from quintet.interfaces.component import Array, Field, Fields, Port
from quintet.interfaces.errors import LinkError

Ports = tuple[tuple[Port, ...], tuple[Port, ...]]  # takes, gives
Works = list[tuple[str, str, str]]  # force, velocity, position or "": all of one component


@dataclass(slots=True)
class Leg:
    """One direction of a link: from the giver's outputs to the taker's inputs.

    ``sums`` pairs impulses before and after the mapping whose sums must be equal.
    ``works_on`` says by which of the taker's own outputs its impulses do work.
    ``moment`` gives the angular impulse about the origin of what was mapped.
    """

    giver: str
    taker: str
    carry: Callable[[Fields], dict[str, Array]]
    sums: tuple[tuple[str, str], ...] = ()
    works_on: tuple[tuple[str, str, str], ...] = ()  # taken impulse, given rate, position or ""
    moment: Callable[[Fields], Array] | None = None


class Link(Protocol):
    """A kind of exchange between two components, matched to their ports."""

    name: str
    legs: list[Leg]
    works: dict[str, Works]  # for the component that gives a force on moving items
    partner: dict[str, str]  # component -> its port whose rows belong to the other side
    memory: Any  # what must come back when a window is repeated

    def describe(self, described: Mapping[str, Fields]) -> dict[str, dict[str, Array]]:
        """From what both sides say of themselves, make the static fields that each takes."""


def requires(ports: Ports, name: str, takes: Port | None, gives: Port | None) -> list[str]:
    """List what a component's ports lack for a role in a link; empty when it fits."""
    lacks = []
    for verb, needed, offered in (("take", takes, ports[0]), ("give", gives, ports[1])):
        if needed is None:
            continue
        found = next((port for port in offered if port.name == needed.name), None)
        if found is None:
            lacks.append(f"{name} must {verb} a port {needed.name}")
        else:
            lacks += misfits(name, found, needed)
    return lacks


def misfits(name: str, found: Port, needed: Port) -> list[str]:
    """Say which fields of a port are not as the other side has them."""
    theirs = {field.name: field for field in needed.fields}
    wrong = []
    for mine in found.fields:
        other = theirs.get(mine.name)
        place = f"{name}.{found.name}.{mine.name}"
        if other is None:
            wrong.append(f"{place} is not known to the other side ({', '.join(theirs)})")
        elif mine.unit != other.unit:
            wrong.append(f"{place} is in {mine.unit}, the other side's in {other.unit}")
        elif mine.centring != other.centring:
            wrong.append(f"{place} is {mine.centring}, the other side's {other.centring}")
        elif mine.shape != other.shape:
            wrong.append(f"{place} has shape {mine.shape}, the other side's {other.shape}")
    return wrong


@dataclass(frozen=True, slots=True)
class Brought:
    """What one leg brought: its giver's rows, before and after the mapping."""

    number: int  # of the link
    leg: Leg
    before: Fields
    after: Fields
    moment: Array | None  # angular impulse about the origin, where it is known


@dataclass(slots=True)
class Carried:
    """Inputs for one component, and what each leg brought to them."""

    fields: dict[str, Array] = field(default_factory=dict)
    legs: list[Brought] = field(default_factory=list)
    ends: list[str] = field(default_factory=list)  # instants that hold at the window's end
    guessed: list[str] = field(default_factory=list)  # replaced by an iteration's guess
    mixed: list[str] = field(default_factory=list)  # some rows hold at the end, some do not
    outputs: dict[str, Fields] = field(default_factory=dict)  # from which they were carried
    sent: dict[str, dict[str, list[float]]] = field(default_factory=dict)  # sums of those


@dataclass(slots=True)
class Exchange:
    """All links of a scene."""

    links: list[Link]
    ports: dict[str, Ports]
    _slices: dict[tuple[str, str, int], slice] = field(default_factory=dict)

    def bind(self, described: Mapping[str, Fields]) -> dict[str, dict[str, Array]]:
        """Static fields for every component: a partner's in rows, those of own items added up."""
        merged: dict[str, dict[str, Array]] = {name: {} for name in self.ports}
        for link in self.links:
            for name, fields in link.describe(described).items():
                for key, array in fields.items():
                    known = merged[name].get(key)
                    if known is None:
                        merged[name][key] = array
                    elif self._port(name, key).items == "partner":
                        counted = known.max(initial=-1.0) + 1.0 if self._labels(name, key) else 0.0
                        merged[name][key] = np.concatenate([known, array + counted])
                    else:
                        merged[name][key] = known + array
        return merged

    def memory(self) -> list[Any]:
        """What the links remember of the last windows."""
        return [link.memory for link in self.links]

    def recall(self, memory: list[Any]) -> None:
        """Come back to what they remembered."""
        for link, remembered in zip(self.links, memory, strict=True):
            link.memory = remembered

    def is_impulse(self, taker: str, key: str) -> bool:
        """Whether an input of a component is an integral over the window."""
        return self._field(taker, key).centring == "impulse"

    def _field(self, taker: str, key: str) -> Field:
        name = key.partition(".")[2]
        return next(one for one in self._port(taker, key).fields if one.name == name)

    def _labels(self, taker: str, key: str) -> bool:
        name = key.partition(".")[2]
        return any(one.labels for one in self._port(taker, key).static if one.name == name)

    def _port(self, taker: str, key: str) -> Port:
        name = key.partition(".")[0]
        return next(port for port in self.ports[taker][0] if port.name == name)

    def unit(self, taker: str, key: str) -> str:
        """Unit of an input; of an impulse, that of its rate."""
        return self._field(taker, key).unit

    def follows(self, name: str) -> bool:
        """Whether a component takes the motion of a partner's items."""
        return any(name in link.partner for link in self.links)

    def works(self, name: str) -> Works:
        """Pairs of force and velocity by which a component's links do work."""
        return sorted({work for link in self.links for work in link.works.get(name, [])})

    def inputs(self, taker: str, outputs: Mapping[str, Fields], fresh: Collection[str]) -> Carried:
        """Carry to one component what the others gave; `fresh` ones are a window ahead."""
        carried = Carried()
        gathered: dict[str, list[tuple[Brought, Array]]] = {}
        for number, link in enumerate(self.links):
            for leg in link.legs:
                if leg.taker != taker or leg.giver not in outputs:
                    continue
                mine = self.rows(number, leg, outputs)
                mapped = leg.carry(mine)
                moment = leg.moment(mapped) if leg.moment else None
                brought = Brought(number, leg, mine, mapped, moment)
                carried.legs.append(brought)
                for key, array in mapped.items():
                    gathered.setdefault(key, []).append((brought, array))
        for key, parts in gathered.items():
            carried.fields[key] = self._merge(taker, key, parts)
            ahead = [brought.leg.giver in fresh for brought, _ in parts]
            if all(ahead):
                carried.ends.append(key)
            elif any(ahead):
                carried.mixed.append(key)
        return carried

    def rows(self, number: int, leg: Leg, outputs: Mapping[str, Fields]) -> Fields:
        """Outputs of a leg's giver; of a port that several links share, the link's own rows."""
        giver, given = leg.giver, outputs[leg.giver]
        taken = self.links[number].partner.get(giver)
        if taken is None or sum(link.partner.get(giver) == taken for link in self.links) == 1:
            return given
        if (giver, taken, number) not in self._slices:
            self.inputs(giver, outputs, ())  # finds out which rows are whose
        rows = self._slices[giver, taken, number]
        partners = {port.name for port in self.ports[giver][1] if port.items == "partner"}
        return {k: v[rows] if k.split(".")[0] in partners else v for k, v in given.items()}

    def _merge(self, taker: str, key: str, parts: list[tuple[Brought, Array]]) -> Array:
        if len(parts) == 1:
            return parts[0][1]
        if self._port(taker, key).items == "partner":
            first, name = 0, key.partition(".")[0]
            for brought, array in parts:
                self._slices[taker, name, brought.number] = slice(first, first + len(array))
                first += len(array)
            return np.concatenate([array for _, array in parts])
        if not self.is_impulse(taker, key):
            raise LinkError(
                f"{taker}.{key}: only forces of several links can be added up; this is a value. "
                f"Join {taker}.{key.partition('.')[0]} once."
            )
        return np.sum([array for _, array in parts], axis=0)
