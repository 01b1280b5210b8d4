"""A coupling: the members that it steps, what they gave last, and the books of their transfers.

Its scheme (`schemes`) decides in which order windows are stepped. A member is a component or a
group of components, which is a coupling itself (`group`).
"""

import contextlib
import math
import time
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, Protocol

from quintet.coupler.coupling.exchange import Delivery, Exchange, WindowInputs
from quintet.coupler.coupling.iteration.acceleration import Acceleration
from quintet.coupler.coupling.iteration.acceleration import make as make_acceleration
from quintet.coupler.coupling.iteration.convergence_log import ConvergenceLog
from quintet.coupler.coupling.iteration.convergence_measure import ConvergenceMeasure
from quintet.coupler.coupling.ledger import Ledger
from quintet.coupler.coupling.participant import Participant
from quintet.coupler.coupling.plan import CouplingPlan
from quintet.coupler.coupling.windows import BLIND, Windows, auto_length
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.lines.message import Message
from quintet.interfaces.serving.inputs import KnownEnds, value_at

# What components take from those that step after them: by the taker's name and the field's.
Guess = dict[tuple[str, str], Array]
Sums = dict[str, list[float]]


@dataclass(frozen=True, slots=True)
class Given:
    """What a member gave in a window: outputs of each component in it, and their sums."""

    outputs: dict[str, Fields]
    sent: dict[str, Sums]


class Member(Protocol):
    """What a coupling steps: a component, or a group of them."""

    @property
    def components(self) -> Mapping[str, Participant]:
        """All components in it, by name."""

    @property
    def inner(self) -> "Coupling | None":
        """Coupling of a group."""

    def stable(self) -> float:
        """Largest step from the present state [s]."""

    def start(
        self, coupling: "Coupling", window: "Window", inputs: dict[str, WindowInputs]
    ) -> None:
        """Order a window."""

    def finish(self, coupling: "Coupling", window: "Window") -> Given:
        """Wait for its end."""

    def book(self, coupling: "Coupling", window: "Window") -> None:
        """Book what its components say of the window, once it counts."""

    def keep(self, depth: int) -> None:
        """Order that the present state be kept."""

    def rewind(self, depth: int) -> None:
        """Order that it come back to the state kept."""

    def confirm(self) -> None:
        """Wait until such an order is carried out."""


@dataclass(frozen=True, slots=True)
class Window:
    """One window of a coupling."""

    number: int
    ticks: int
    dt: float  # s
    totals: bool  # whether the components' totals are wanted at its end


@dataclass(slots=True)
class Costs:
    """What coupling costs, in all groups together."""

    mapping: float = 0.0  # s spent on transfers and bookkeeping
    repetitions: int = 0  # of windows
    unconverged: int = 0  # windows that went on at the limit of repetitions
    checks: float = 0.0  # s spent on trial windows, all components included


@dataclass(slots=True)
class Coupling:
    """All that a scheme works on.

    Parameters
    ----------
    plan : CouplingPlan
        Members, scheme and window, as the scene has them.
    members : mapping
        In the order in which they step.
    depth : int
        In how many groups it is.
    """

    plan: CouplingPlan
    members: Mapping[str, Member]
    exchange: Exchange
    ledger: Ledger
    depth: int = 0
    costs: Costs = field(default_factory=Costs)
    log: ConvergenceLog | None = None
    windows: Windows = field(default_factory=lambda: Windows(1.0, 1, 1.0))
    outside: Callable[[str], WindowInputs | None] = lambda _: None  # inputs from beyond a group
    outputs: dict[str, Fields] = field(default_factory=dict)  # the latest of every component
    previous: dict[str, Fields] = field(default_factory=dict)  # those a window before
    iterate: dict[str, Fields] = field(default_factory=dict)  # those of the last repetition
    sent: dict[str, Sums] = field(default_factory=dict)  # sums as given
    in_transit: Guess = field(default_factory=dict)  # impulses not yet applied
    relaxed: dict[tuple[int, str], Array] = field(default_factory=dict)  # last instants handed on
    late: set[int] = field(default_factory=set)  # transfers whose impulses wait for the next window
    last_dt: float = 0.0  # s, the last window
    on_mapping: Callable[[float, float], None] | None = None  # called with begin and end [s]
    transfers: dict[int, tuple[str, str]] = field(init=False)  # by number: members, giver and taker
    equal: set[str] = field(init=False)  # components that must make equal steps
    acceleration: Acceleration = field(init=False)
    measure: ConvergenceMeasure = field(init=False)

    def __post_init__(self) -> None:
        self.transfers = self.plan.transfers(self.exchange)
        self.equal = self.plan.equal(self.exchange)
        settings, is_impulse = self.plan.iteration, self.exchange.is_impulse
        self.acceleration = make_acceleration(settings, is_impulse)
        self.measure = ConvergenceMeasure(settings.tolerance, settings.absolute, is_impulse)

    @property
    def components(self) -> dict[str, Participant]:
        """Every component, also those in groups."""
        return {k: v for member in self.members.values() for k, v in member.components.items()}

    def carries(self, link: str) -> "Coupling | None":
        """Find the coupling, this or that of a group, whose windows a link's transfers cross."""
        if any(self.exchange.links[self.exchange.link_of[n]].name == link for n in self.transfers):
            return self
        return next((carrier for inner in self._inner() if (carrier := inner.carries(link))), None)

    def stable(self) -> float:
        """Longest window that the members' states allow [s]; inf if no member limits it."""
        stable = {name: member.stable() for name, member in self.members.items()}
        joined = {name for ends in self.transfers.values() for name in ends}
        steps = [step for name, step in stable.items() if name in joined or not joined]
        equal = [stable[name] for name in stable if name in self.equal]
        length, _ = auto_length(steps, equal)
        return length

    def allowed(self) -> float:
        """How long the next window may be where it follows the state [s].

        A group that nothing limits steps once in every window of the coupling around it.
        """
        length = self.stable()
        if math.isfinite(length) or self.depth:
            return length
        return self.windows.end * self.windows.tick / BLIND

    def collect_inputs(
        self, name: str, stepped: Collection[str], window: Window
    ) -> dict[str, WindowInputs]:
        """Bring to a member's components what the others gave; `stepped` have done this window."""
        with self.timed():
            deliveries_of: dict[str, list[tuple[Delivery, bool]]] = {}
            for number, (giver, member) in self.transfers.items():
                if member == name:
                    is_end, taker = giver in stepped, self.exchange.transfers[number].taker
                    delivery = self._deliver(number, is_end and name not in stepped, window)
                    deliveries_of.setdefault(taker, []).append((delivery, is_end))
            gathered = {}
            for taker, deliveries in deliveries_of.items():
                inputs = self.exchange.merge(taker, deliveries)
                inputs.outputs, inputs.sent = self.outputs[taker], dict(self.sent)
                gathered[taker] = inputs
            return gathered

    def with_outside(self, name: str, inputs: WindowInputs) -> WindowInputs:
        """Add the inputs of a component that come from beyond this group, if it is one."""
        if (outside := self.outside(name)) is None:
            return inputs
        # Impulses add up whenever they were known; only instants hold at a time.
        ends = [key for key in inputs.ends if not self.exchange.is_impulse(name, key)]
        both = WindowInputs(dict(inputs.fields), inputs.deliveries, ends)
        both.add(outside)
        return both

    def _deliver(self, number: int, is_ahead: bool, window: Window) -> Delivery:
        """Map a transfer over the window of its giver.

        Where the giver is a window ahead of the taker, the taker's own end is not known yet: it is
        where the last repetition ended, or where its rates lead.
        """
        transfer = self.exchange.transfers[number]
        giver, taker = transfer.giver, transfer.taker
        start, end = {giver: self.previous[giver]}, {giver: self.outputs[giver]}
        if transfer.needs and is_ahead:
            start[taker] = self.outputs[taker]
            end[taker] = self.iterate.get(taker) or self._ahead(taker, transfer.needs, window.dt)
        elif transfer.needs:
            start[taker], end[taker] = self.previous[taker], self.outputs[taker]
        delivery = self.exchange.deliver(number, start, end)
        self._relax(delivery, window)
        return delivery

    def _ahead(self, name: str, keys: Iterable[str], dt: float) -> Fields:
        """Outputs of a component as far ahead as their rates lead."""
        known = self.outputs[name]
        values = {}
        for key in keys:
            field = self.exchange.output(name, key)
            rate = known.get(f"{key.partition('.')[0]}.{field.rate}") if field.rate else None
            values[key] = value_at(field.kind, KnownEnds(known[key], rate), dt, dt)
        return values

    def _relax(self, delivery: Delivery, window: Window) -> None:
        """Hand on only a share of the change of instants, where the link says so."""
        number, link = delivery.number, self.exchange.link_of[delivery.number]
        factors = self.exchange.links[link].demands().relaxation
        if not factors:
            return
        factor = factors[min(window.number, len(factors) - 1)]
        after = dict(delivery.after)
        for key, array in after.items():
            if not self.exchange.is_impulse(delivery.transfer.taker, key):
                last = self.relaxed.get((number, key), array)
                after[key] = self.relaxed[number, key] = last + factor * (array - last)
        delivery.after = after

    def start(self, name: str, window: Window, inputs: dict[str, WindowInputs]) -> None:
        """Order one member's window."""
        self.members[name].start(self, window, inputs)

    def finish(self, name: str, window: Window) -> Given:
        """Wait for the end of one member's window."""
        return self.members[name].finish(self, window)

    def advance_outputs(self, answers: Given) -> None:
        """Make what a member gave the latest of its components."""
        for component, fields in answers.outputs.items():
            self.previous[component] = self.outputs[component]
            self.outputs[component] = fields
            self.sent[component] = answers.sent[component]

    def book(self, answers: Given, inputs: dict[str, WindowInputs], window: Window) -> None:
        """Book the transfers that brought a member's inputs, and those that it gave for."""
        with self.timed():
            for taker, arrived in inputs.items():
                for delivery in arrived.deliveries:
                    self.ledger.mapped(delivery, arrived.sent)
                    ends = arrived.outputs, answers.outputs[taker]
                    self.ledger.worked(delivery, arrived.fields, *ends, window.dt)
            for number in self.transfers:
                giver = self.exchange.transfers[number].giver
                if giver in answers.outputs:
                    self.ledger.given_for(number, answers.outputs[giver])

    def all_late(self) -> set[int]:
        """Transfers of this coupling and of its groups whose last impulses wait."""
        numbers = set(self.late)
        for inner in self._inner():
            numbers |= inner.all_late()
        return numbers

    def all_in_transit(self) -> Guess:
        """Impulses of this coupling and of its groups that are not yet applied."""
        arrays = dict(self.in_transit)
        for inner in self._inner():
            for key, array in inner.all_in_transit().items():
                arrays[key] = arrays[key] + array if key in arrays else array
        return arrays

    def _inner(self) -> Iterator["Coupling"]:
        return (member.inner for member in self.members.values() if member.inner is not None)

    @contextlib.contextmanager
    def timed(self) -> Iterator[None]:
        """Count the time that goes into transfers and bookkeeping."""
        began = time.perf_counter()
        yield
        ended = time.perf_counter()
        self.costs.mapping += ended - began
        if self.on_mapping:
            self.on_mapping(began, ended)

    def save(self) -> dict[str, Any]:
        """What outlives a window, for a snapshot and for a group that is repeated."""
        return {
            "outputs": dict(self.outputs),
            "previous": dict(self.previous),
            "sent": dict(self.sent),
            "in_transit": dict(self.in_transit),
            "relaxed": dict(self.relaxed),
            "late": sorted(self.late),
            "last_dt": self.last_dt,
            "windows": self.windows.save(),
            "acceleration": self.acceleration.save(),
            "measure": self.measure.save(),
        }

    def load(self, state: Mapping[str, Any]) -> None:
        """Come back to what was saved."""
        self.outputs, self.previous = dict(state["outputs"]), dict(state["previous"])
        self.sent, self.in_transit = dict(state["sent"]), dict(state["in_transit"])
        self.relaxed, self.late = dict(state["relaxed"]), set(state["late"])
        self.last_dt, self.iterate = state["last_dt"], {}
        self.windows.load(state["windows"])
        self.measure.load(state["measure"])
        if self.plan.scheme == "iterated" and state["acceleration"]:
            self.acceleration.load(state["acceleration"])


class Single:
    """A component as a member of a coupling."""

    inner: Coupling | None = None

    def __init__(self, participant: Participant) -> None:
        self.participant, self.name = participant, participant.name
        self.components = {participant.name: participant}
        self._inputs = WindowInputs()
        self._answer: Message | None = None

    def stable(self) -> float:
        """See `Member.stable`."""
        return self.participant.stable

    def start(self, coupling: Coupling, window: Window, inputs: dict[str, WindowInputs]) -> None:
        """See `Member.start`."""
        self._inputs = coupling.with_outside(self.name, inputs.get(self.name) or WindowInputs())
        fields, ends = self._inputs.fields, self._inputs.ends
        steps = int(self.name in coupling.equal)
        self.participant.start(window.dt, fields, ends, totals=window.totals, steps=steps)

    def finish(self, coupling: Coupling, window: Window) -> Given:
        """See `Member.finish`."""
        self._answer = self.participant.finish()
        fields, sent = self._answer.fields, self._answer.header["sent"]
        return Given({self.name: fields}, {self.name: sent})

    def book(self, coupling: Coupling, window: Window) -> None:
        """See `Member.book`."""
        answer, ledger = self._answer, coupling.ledger
        assert answer is not None
        with coupling.timed():
            ledger.book_given(self.name, answer.header, answer.fields)
            ledger.applied(self.name, self._inputs.fields, answer.header)
            ledger.moved(self.name, self._inputs, answer.header["inputs"], window.dt)
        if answer.header.get("totals"):
            ledger.totals[self.name] = answer.header["totals"]
        if warnings := answer.header.get("warnings"):
            ledger.warnings.note(f"component {self.name}", warnings)

    def keep(self, depth: int) -> None:
        """See `Member.keep`."""
        self.participant.order_keep(depth)

    def rewind(self, depth: int) -> None:
        """See `Member.rewind`."""
        self.participant.order_rewind(depth)

    def confirm(self) -> None:
        """See `Member.confirm`."""
        self.participant.receive()
