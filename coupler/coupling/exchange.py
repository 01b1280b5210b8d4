"""What crosses between components: the transfers of all links, and how their rows meet.

What a link makes of the components' static fields, its maps, is made when ports are joined and
lives here, in the exchange of one run.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from quintet.coupler.coupling.link import Binding, Ends, Link, Mapped, Ports, Transfer
from quintet.coupler.coupling.pairing import Works, equal_sums, works, works_on
from quintet.interfaces.component import Array, Field, Fields, Port, fields_of
from quintet.interfaces.errors import LinkError

MASS = "kg"  # unit of instants that add up, as impulses do
Sampler = Callable[[str, Fields], Fields]  # component and request -> its samples


@dataclass(slots=True)
class Delivery:
    """What one transfer brought: its giver's rows, before and after the mapping."""

    number: int  # of the transfer
    transfer: Transfer
    before: Fields
    after: Fields
    moment: Array | None  # angular impulse about the origin, where it is known


@dataclass(slots=True)
class WindowInputs:
    """Inputs of one component for a window, and the deliveries that they were made from."""

    fields: dict[str, Array] = field(default_factory=dict)
    deliveries: list[Delivery] = field(default_factory=list)
    ends: list[str] = field(default_factory=list)  # instants that hold at the window's end
    mixed: list[str] = field(default_factory=list)  # some rows hold at the end, some do not
    outputs: Fields = field(default_factory=dict)  # the taker's own at the window's start
    sent: dict[str, dict[str, list[float]]] = field(default_factory=dict)  # sums of the givers

    def add(self, other: "WindowInputs") -> None:
        """Add inputs that come from elsewhere: rows that one side does not have are zero there."""
        for key, array in other.fields.items():
            if key in self.fields and (key in self.ends) != (key in other.ends):
                raise LinkError(
                    f"{key}: what comes from within a group and from beyond it must hold at the "
                    "same time. Change the order, or use the same kind of scheme for both."
                )
            self.fields[key] = self.fields[key] + array if key in self.fields else array
        self.ends += [key for key in other.ends if key not in self.ends]
        self.mixed += other.mixed


class Exchange:
    """All links of a run, with the maps that they made."""

    def __init__(self, links: Sequence[Link], ports: Mapping[str, Ports]) -> None:
        self.links, self.ports = list(links), ports
        self.takes = {name: fields_of(takes) for name, (takes, _) in ports.items()}
        self.gives = {name: fields_of(gives) for name, (_, gives) in ports.items()}
        self._ports = {
            name: {port.name: port for port in takes} for name, (takes, _) in ports.items()
        }
        pairs = [(n, transfer) for n, link in enumerate(self.links) for transfer in link.transfers]
        self.transfers = [transfer for _, transfer in pairs]
        self.link_of = [number for number, _ in pairs]  # of each transfer
        self.sums = [equal_sums(transfer, self.takes, self.gives) for transfer in self.transfers]
        self.works_of = [works(link.transfers, self.takes, self.gives) for link in self.links]
        self.works_on = [
            works_on(transfer, self.links[link].transfers, self.takes, self.gives)
            for link, transfer in pairs
        ]
        self._bindings: list[Binding] = []
        self.samples: list[tuple[str, Fields, Fields]] = []  # component, request, its answer
        self._maps: list[Callable[[Ends, Ends], Mapped]] = []
        self._moment: list[Callable[[Ends, Ends, Fields], Array] | None] = []
        self._rows: dict[tuple[str, str], dict[int, slice]] = {}  # (component, port) -> by link

    def bind(
        self, described: Mapping[str, Fields], sample: Sampler = lambda _name, _request: {}
    ) -> dict[str, Mapped]:
        """Static fields for every component: a partner's in rows, those of own items added up.

        A link finds the samples for which it asks among what a component described.
        """
        self._bindings, self.samples = [], []
        for link in self.links:
            all_described = dict(described)
            for name, request in link.requests(described).items():
                answer = sample(name, request)
                all_described[name] = {**described[name], **answer}
                self.samples.append((name, request, answer))
            self._bindings.append(link.bind(all_described))
        self._maps = [maps for binding in self._bindings for maps in binding.maps]
        self._moment = [
            moment
            for binding in self._bindings
            for moment in binding.moment or (None,) * len(binding.maps)
        ]
        merged: dict[str, Mapped] = {name: {} for name in self.ports}
        for binding in self._bindings:
            for name, fields in binding.static.items():
                for key, array in fields.items():
                    merged[name][key] = self._join(name, key, merged[name].get(key), array)
        return merged

    def samples_of(self, name: str) -> dict[str, Array]:
        """Samples of a component's rigid bodies, each with its request: what a replay answers.

        Those of a mesh follow from its nodes and faces. Nodes and faces that a mesh listed on
        request replace those that it described.
        """
        answers = [(request, answer) for owner, request, answer in self.samples if owner == name]
        listed = [answer for _, answer in answers if any(key.endswith(".start") for key in answer)]
        tables = {key: array for answer in listed for key, array in answer.items()}
        return tables | {
            f"samples.{number}.{key}": array
            for number, (request, answer) in enumerate(answers)
            if any(key.endswith(".arm") for key in answer)
            for key, array in {**request, **answer}.items()
        }

    def _join(self, name: str, key: str, known: Array | None, array: Array) -> Array:
        if known is None:
            return array
        if self._port(name, key).items == "own":
            return np.asarray(known + array)
        field_name = key.partition(".")[2]
        static = next(field for field in self._port(name, key).static if field.name == field_name)
        counted = known.max(initial=-1.0) + 1.0 if static.labels else 0.0
        return np.concatenate([known, array + counted])

    def count_rows(self, outputs: Mapping[str, Fields]) -> None:
        """Find out which rows of a port that several links share belong to which of them."""
        counts: dict[tuple[str, str], dict[int, int]] = {}
        for number, transfer in enumerate(self.transfers):
            link, taker = self.link_of[number], transfer.taker
            partner = self._partner_port(link, taker)
            if not partner:
                continue
            mapped = self._maps[number](outputs, outputs)
            sizes = [len(a) for key, a in mapped.items() if key.partition(".")[0] == partner]
            if sizes:
                counts.setdefault((taker, partner), {})[link] = sizes[0]
        for place, by_link in counts.items():
            first, self._rows[place] = 0, {}
            for link, count in sorted(by_link.items()):
                self._rows[place][link] = slice(first, first + count)
                first += count

    def _partner_port(self, link: int, name: str) -> str:
        """Port of a component whose rows belong to the other side of a link, or ""."""
        fills = (t.fills for t in self.links[link].transfers if t.taker == name)
        ports = (self._port(name, key) for keys in fills for key in keys)
        return next((port.name for port in ports if port.items == "partner"), "")

    def shares(self, name: str) -> dict[str, list[tuple[int, int]]]:
        """Rows of each link in the ports of a component that several links share."""
        return {
            port: [(span.start, span.stop) for span in rows.values()]
            for (taker, port), rows in self._rows.items()
            if taker == name and len(rows) > 1
        }

    def sharing(self, name: str) -> dict[str, int]:
        """How many links share the work of each force that a component gives."""
        shares = self.shares(name)
        return {
            force: len(shares.get(velocity.partition(".")[0], ((),)))
            for force, velocity, _ in reversed(self.works(name))
        }

    def share_of(self, link: int, name: str, port: str) -> int:
        """Place of a link among those that share a port of a component."""
        rows = self._rows.get((name, port), {})
        return sorted(rows).index(link) if len(rows) > 1 else 0

    def is_impulse(self, taker: str, key: str) -> bool:
        """Whether an input of a component is an integral over the window."""
        return self.takes[taker][key].centring == "impulse"

    def _port(self, taker: str, key: str) -> Port:
        return self._ports[taker][key.partition(".")[0]]

    def unit(self, taker: str, key: str) -> str:
        """Unit of an input; of an impulse, that of its rate."""
        return self.takes[taker][key].unit

    def output(self, giver: str, key: str) -> Field:
        """Field of a component's output."""
        return self.gives[giver][key]

    def works(self, name: str) -> Works:
        """Pairs of force and velocity by which a component's links do work."""
        return sorted({work for by_name in self.works_of for work in by_name.get(name, [])})

    def both_count_work(self, link: int) -> bool:
        """Whether the side that is pushed counts the work of a link too."""
        return any(self.works_on[n] for n, number in enumerate(self.link_of) if number == link)

    def joined(self, name: str) -> list[str]:
        """Names of a component's ports that have a partner."""
        keys = {
            key for transfer in self.transfers if transfer.taker == name for key in transfer.fills
        }
        keys |= {
            key for transfer in self.transfers if transfer.giver == name for key in transfer.reads
        }
        return sorted({key.partition(".")[0] for key in keys})

    def wanted(self, name: str, asked: Iterable[str] = ()) -> list[str]:
        """Outputs of a component that a link reads, or that somebody asked for."""
        keys = set(asked)
        for transfer, worked in zip(self.transfers, self.works_on, strict=True):
            if transfer.giver == name:
                keys |= set(transfer.reads)
            if transfer.taker == name:
                keys |= set(transfer.needs)
                keys |= {key for _, *both in worked for key in both}
        return [key for key in self.gives[name] if key in keys]

    def deliver(self, number: int, start: Ends, end: Ends) -> Delivery:
        """Map what a giver gave in a window, from the outputs of both sides at its two ends."""
        transfer = self.transfers[number]
        start, end = self._own_rows(number, start), self._own_rows(number, end)
        after = self._maps[number](start, end)
        moment = self._moment[number]
        turned = moment(start, end, after) if moment else None
        return Delivery(number, transfer, end[transfer.giver], after, turned)

    def rows(self, number: int, outputs: Fields) -> Fields:
        """Outputs of a transfer's giver; of a port that several links share, the link's rows."""
        giver, link = self.transfers[number].giver, self.link_of[number]
        taken = self._partner_port(link, giver)
        shared = self._rows.get((giver, taken), {})
        if len(shared) < 2:
            return outputs
        partners = {port.name for port in self.ports[giver][1] if port.items == "partner"}
        rows = shared[link]
        return {k: v[rows] if k.partition(".")[0] in partners else v for k, v in outputs.items()}

    def _own_rows(self, number: int, outputs: Ends) -> Ends:
        giver = self.transfers[number].giver
        return {**outputs, giver: self.rows(number, outputs[giver])}

    def merge(self, taker: str, deliveries: Sequence[tuple[Delivery, bool]]) -> WindowInputs:
        """Bring together what several transfers brought; each says whether it holds at the end."""
        inputs = WindowInputs(deliveries=[delivery for delivery, _ in deliveries])
        gathered: dict[str, list[tuple[Delivery, bool]]] = {}
        for delivery, is_end in deliveries:
            for key in delivery.after:
                gathered.setdefault(key, []).append((delivery, is_end))
        for key, parts in gathered.items():
            inputs.fields[key] = self._merge(taker, key, [delivery for delivery, _ in parts])
            ahead = [is_end for _, is_end in parts]
            if all(ahead):
                inputs.ends.append(key)
            elif any(ahead):
                inputs.mixed.append(key)
        return inputs

    def _merge(self, taker: str, key: str, parts: list[Delivery]) -> Array:
        if self._port(taker, key).items == "partner":
            rows = self._rows.get((taker, key.partition(".")[0]), {})
            arrays = {self.link_of[delivery.number]: delivery.after[key] for delivery in parts}
            if len(arrays) == 1 and len(rows) <= 1:
                return parts[0].after[key]
            if len(rows) <= len(arrays):
                return np.concatenate([arrays[link] for link in sorted(arrays)])
            whole = np.zeros(
                (max(span.stop for span in rows.values()), *parts[0].after[key].shape[1:])
            )
            for link, array in arrays.items():
                whole[rows[link]] = array
            return whole
        if len(parts) == 1:
            return parts[0].after[key]
        if not self.is_impulse(taker, key) and self.unit(taker, key) != MASS:
            raise LinkError(
                f"{taker}.{key}: inputs of several links can be added up only where they are "
                "impulses, as forces are; this one is an instant. "
                f"Join {taker}.{key.partition('.')[0]} once."
            )
        return np.asarray(np.sum([delivery.after[key] for delivery in parts], axis=0))
