"""The plan of a coupling: its members, scheme and window, and what its links allow of these."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Literal, Union

from quintet.coupler.coupling.exchange import Exchange
from quintet.coupler.coupling.iteration.settings import IterationSettings

Scheme = Literal["serial", "parallel", "iterated"]


@dataclass(frozen=True, slots=True)
class CouplingPlan:
    """A coupling as a scene has it: of the whole run, or of a group.

    Parameters
    ----------
    name : str
        Of the group; "" of the whole run.
    members : mapping
        Components (None) and groups (their own plans), in the order in which they step.
    scheme : str
        How windows are stepped.
    window : float, s, or "auto"
        Length of a window.
    iteration : IterationSettings
        How windows are repeated, under the scheme iterated.
    """

    name: str
    members: Mapping[str, Union["CouplingPlan", None]]
    scheme: Scheme = "serial"
    window: float | Literal["auto"] = "auto"
    iteration: IterationSettings = field(default_factory=IterationSettings)

    def components(self) -> Iterator[str]:
        """Names of all components, also of those in groups."""
        for name, inner in self.members.items():
            if inner is None:
                yield name
            else:
                yield from inner.components()

    def member_of(self, component: str) -> str | None:
        """Name of the member in which a component is."""
        for name, inner in self.members.items():
            if name == component if inner is None else component in inner.components():
                return name
        return None

    def transfers(self, exchange: Exchange) -> dict[int, tuple[str, str]]:
        """Transfers between components of different members, and these: giver, taker."""
        pairs = {}
        for number, transfer in enumerate(exchange.transfers):
            giver, taker = self.member_of(transfer.giver), self.member_of(transfer.taker)
            if giver is not None and taker is not None and giver != taker:
                pairs[number] = giver, taker
        return pairs

    def equal(self, exchange: Exchange) -> set[str]:
        """Components that must step once in every window of this coupling."""
        components = set()
        for number in self.transfers(exchange):
            if exchange.links[exchange.link_of[number]].demands().equal_steps:
                transfer = exchange.transfers[number]
                components |= {transfer.giver, transfer.taker}
        return components

    def inner(self) -> list["CouplingPlan"]:
        """Plans of its groups."""
        return [plan for plan in self.members.values() if plan is not None]

    def iterated(self) -> Iterator[str]:
        """Names of the couplings that repeat windows: this one, and groups in it."""
        if self.scheme == "iterated":
            yield self.name
        for plan in self.inner():
            yield from plan.iterated()

    def follows(self, exchange: Exchange) -> bool:
        """Whether its windows, or those of a group in it, follow the state."""
        is_equal = self.window == "auto" or bool(self.equal(exchange))
        return is_equal or any(plan.follows(exchange) for plan in self.inner())


# Whether inputs that are instants hold at a window's end, by component and key.
AtEnd = Mapping[tuple[str, str], bool]


def mistakes(
    plan: CouplingPlan, exchange: Exchange, beyond: AtEnd = MappingProxyType({})
) -> list[str]:
    """Say what the links of a coupling, or of its groups, do not allow.

    `beyond` has the inputs that come from beyond a group.
    """
    where = f"groups.{plan.name}" if plan.name else "scene"
    wrong = [*_refused_schemes(plan, exchange, where), *_mixed_inputs(plan, exchange, where)]
    wrong += _carried_twice(plan, exchange)
    inside = _at_end(plan, exchange)
    wrong += _mixed_times(inside, beyond, where)
    for inner in plan.inner():
        wrong += mistakes(inner, exchange, {**beyond, **inside})
    return list(dict.fromkeys(wrong))


def _carried_twice(plan: CouplingPlan, exchange: Exchange) -> Iterator[str]:
    """Impulses that two links carry from the same items to the same input."""
    carriers: dict[tuple[str, str, str, str], str] = {}
    for number in plan.transfers(exchange):
        transfer, link = exchange.transfers[number], exchange.links[exchange.link_of[number]].name
        own_ports = {port.name for port in exchange.ports[transfer.giver][1] if port.items == "own"}
        for read, filled in exchange.sums[number]:
            if read.partition(".")[0] not in own_ports:
                continue  # each link has rows of its own
            place = transfer.giver, read, transfer.taker, filled
            if place in carriers:
                yield (
                    f"link {link}: {transfer.giver}.{read} must reach {transfer.taker}.{filled} "
                    f"once; link {carriers[place]} brings it already. Remove one of the two."
                )
            carriers.setdefault(place, link)


def _at_end(plan: CouplingPlan, exchange: Exchange) -> AtEnd:
    """Inputs that this coupling's own transfers bring."""
    order = list(plan.members)
    at_end: dict[tuple[str, str], bool] = {}
    for number, (giver, taker) in plan.transfers(exchange).items():
        transfer = exchange.transfers[number]
        before = order.index(giver) < order.index(taker)
        known = plan.scheme == "iterated" or (plan.scheme == "serial" and before)
        for key in transfer.fills:
            if not exchange.is_impulse(transfer.taker, key):
                at_end[transfer.taker, key] = known
    return at_end


def _mixed_times(inside: AtEnd, beyond: AtEnd, where: str) -> Iterator[str]:
    """Inputs of which some rows come from within a group, and some, of another time, do not."""
    times = {True: "end", False: "beginning"}
    for component, key in sorted(inside.keys() & beyond.keys()):
        within, outside = inside[component, key], beyond[component, key]
        if within != outside:
            yield (
                f"{where}: the inputs of {component}.{key.partition('.')[0]} from within the group "
                f"and from outside it must hold at the same time; found the {times[within]} of "
                f"a window within it, the {times[outside]} outside. Change the order, or use "
                "scheme iterated for both."
            )


def _refused_schemes(plan: CouplingPlan, exchange: Exchange, where: str) -> Iterator[str]:
    for number, ends in plan.transfers(exchange).items():
        link = exchange.links[exchange.link_of[number]]
        demands, transfer = link.demands(), exchange.transfers[number]
        if plan.scheme not in demands.schemes:
            yield (
                f"{where}.scheme must be {' or '.join(demands.schemes)} for link {link.name}; "
                f"found {plan.scheme}: {demands.reason}. Change the scheme, or put the two in a "
                "group of their own."
            )
        if plan.scheme == "serial" and demands.first:
            earlier, later = (plan.member_of(component) for component in demands.first)
            order = list(plan.members)
            if earlier and later and order.index(earlier) > order.index(later):
                yield (
                    f"{where}.order must have {earlier} before {later} for link {link.name}; found "
                    f"{', '.join(order)}: {demands.reason}. Change the order."
                )
        if demands.equal_steps and {transfer.giver, transfer.taker} != set(ends):
            yield (
                f"link {link.name}: both sides must make equal steps; one of them is in a group. "
                "Put both in the same group."
            )


def _mixed_inputs(plan: CouplingPlan, exchange: Exchange, where: str) -> Iterator[str]:
    """Inputs of which some rows come from before, and some from after their taker."""
    if plan.scheme != "serial":
        return
    order = list(plan.members)
    sides: dict[tuple[str, str], set[bool]] = {}
    for number, (giver, taker) in plan.transfers(exchange).items():
        transfer = exchange.transfers[number]
        for key in transfer.fills:
            if not exchange.is_impulse(transfer.taker, key):
                before = order.index(giver) < order.index(taker)
                sides.setdefault((transfer.taker, key), set()).add(before)
    for (component, key), kinds in sides.items():
        if len(kinds) > 1:
            yield (
                f"{where}: the inputs of {component}.{key.partition('.')[0]} must all come from "
                "components that step before it, or all from ones after it; they come from both. "
                "Change the order, or use scheme parallel or iterated."
            )
