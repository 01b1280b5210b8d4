"""A group: components with a scheme and windows of their own, stepped together as one member.

Within a window of the coupling around it a group steps through its own windows. What comes from
beyond it is interpolated between the ends of the outer window, as a component's inputs are over
its steps; impulses that go beyond it are summed.
"""

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from quintet.coupler.coupling.answers import AnswerSums
from quintet.coupler.coupling.exchange import Exchange, WindowInputs
from quintet.coupler.coupling.iteration.convergence_log import ConvergenceLog
from quintet.coupler.coupling.ledger import Ledger
from quintet.coupler.coupling.participant import Participant
from quintet.coupler.coupling.plan import CouplingPlan
from quintet.coupler.coupling.schedule import (
    Costs,
    Coupling,
    Given,
    Member,
    Single,
    Sums,
    Window,
)
from quintet.coupler.coupling.schemes import advance
from quintet.coupler.coupling.windows import Windows, whole_windows
from quintet.interfaces.component import Array, Fields
from quintet.interfaces.errors import SceneError
from quintet.interfaces.serving.inputs import Inputs


class Group:
    """A coupling that is a member of another one."""

    def __init__(self, inner: Coupling) -> None:
        self.inner: Coupling | None = inner
        self.coupling = inner
        self.components: Mapping[str, Participant] = inner.components
        self.inputs = {  # from beyond the group
            name: Inputs(inner.exchange.ports[name][0]) for name in self.components
        }
        self._dt = 0.0  # s, the outer window
        self._taken: set[str] = set()  # components that take something from beyond it
        self._kept: dict[int, dict[str, Any]] = {}
        inner.outside = self._outside

    def stable(self) -> float:
        """See `Member.stable`: its own longest window, or what its members allow."""
        window = self.coupling.plan.window
        return self.coupling.stable() if window == "auto" else window

    def start(self, coupling: Coupling, window: Window, inputs: dict[str, WindowInputs]) -> None:
        """See `Member.start`."""
        self._dt, self._taken = window.dt, set()
        for name in self.components:
            arrived = coupling.with_outside(name, inputs.get(name) or WindowInputs())
            if arrived.fields:
                self._taken.add(name)
                self.inputs[name].arrive(arrived.fields, arrived.ends, window.dt)
        self._begin(coupling.windows, window)

    def _begin(self, outer: Windows, window: Window) -> None:
        """Lay the group's windows into one of the coupling around it."""
        mine, plan = self.coupling.windows, self.coupling.plan
        if plan.follows(self.coupling.exchange):
            mine.tick, mine.end, mine.follows = outer.tick, window.ticks, plan.window == "auto"
            mine.follows = mine.follows or bool(self.coupling.equal)
            mine.length = float("inf") if plan.window == "auto" else plan.window
            if not mine.follows:  # divided as below, in ticks
                mine.length = whole_windows(window.dt, mine.length)
            mine.begin()
            return
        assert plan.window != "auto"
        mine.divide(window.dt, plan.window)

    def _outside(self, name: str) -> WindowInputs | None:
        """What a component gets from beyond the group in the group's present window."""
        if name not in self._taken:
            return None
        mine, inputs = self.coupling.windows, self.inputs[name]
        begin, end = mine.time, mine.time_after
        if mine.now + mine.length_now >= mine.end:
            end = self._dt  # to the bit: a flag holds at the end, not before
        outside = WindowInputs()
        for key, rate in inputs.rate.items():
            outside.fields[key] = rate * (end - begin)
        for key in inputs.start:
            known = key in inputs.end
            outside.fields[key] = inputs.value(key, end if known else begin, self._dt)
            if known:
                outside.ends.append(key)
        return outside

    def finish(self, coupling: Coupling, window: Window) -> Given:
        """See `Member.finish`: step through the group's windows."""
        total: dict[str, dict[str, Array]] = {}
        sent: dict[str, dict[str, Any]] = {}
        windows = self.coupling.windows
        while not windows.finished:
            advance(self.coupling, lambda now: window.totals and now >= windows.end)
            for name in self.components:
                self._add(total.setdefault(name, {}), name)
                _add_sums(sent.setdefault(name, {}), self.coupling.sent[name])
        return Given({name: fields for name, fields in total.items()}, sent)

    def _add(self, total: dict[str, Array], name: str) -> None:
        gives = self.coupling.exchange.gives[name]
        for key, array in self.coupling.outputs[name].items():
            summed = gives[key].centring == "impulse" and key in total
            total[key] = total[key] + array if summed else array

    def book(self, coupling: Coupling, window: Window) -> None:
        """See `Member.book`: its own windows have done so."""

    def keep(self, depth: int) -> None:
        """See `Member.keep`."""
        books = {"ledger": self.coupling.ledger.save(), "log": self._log_sizes()}
        unconverged = self.coupling.costs.unconverged
        self._kept[depth] = {**self.save(), **books, "unconverged": unconverged}
        for component in self.components.values():
            component.order_keep(depth)

    def rewind(self, depth: int) -> None:
        """See `Member.rewind`: the books of its own windows come back too."""
        self.load(self._kept[depth])
        self.coupling.ledger.load(self._kept[depth]["ledger"])
        self.coupling.costs.unconverged = self._kept[depth]["unconverged"]
        for log, size in self._kept[depth]["log"]:
            log.cut(size)
        for component in self.components.values():
            component.order_rewind(depth)

    def _log_sizes(self) -> list[tuple[ConvergenceLog, int]]:
        """Logs of the group and of those in it, and their lengths [bytes]."""
        log = self.coupling.log
        sizes = [(log, log.size())] if log else []
        for component in self.coupling.members.values():
            sizes += component._log_sizes() if isinstance(component, Group) else []
        return sizes

    def confirm(self) -> None:
        """See `Member.confirm`."""
        for component in self.components.values():
            component.receive()

    def save(self) -> dict[str, Any]:
        """What outlives a window, for a snapshot and for windows that are repeated."""
        inner = [group for group in self.coupling.members.values() if isinstance(group, Group)]
        return {
            "coupling": self.coupling.save(),
            "inputs": {name: line.save() for name, line in self.inputs.items()},
            "groups": [group.save() for group in inner],
        }

    def load(self, state: Mapping[str, Any]) -> None:
        """Come back to what was saved."""
        self.coupling.load(state["coupling"])
        for name, inputs in self.inputs.items():
            inputs.load(state["inputs"][name])
        inner = [group for group in self.coupling.members.values() if isinstance(group, Group)]
        for group, saved in zip(inner, state["groups"], strict=True):
            group.load(saved)


def assemble(
    plan: CouplingPlan,
    participants: Mapping[str, Participant],
    exchange: Exchange,
    ledger: Ledger,
    logs: Mapping[str, ConvergenceLog] | None = None,
    costs: Costs | None = None,
    depth: int = 0,
) -> Coupling:
    """Make the coupling of a plan, with its groups; `logs` are those of convergence, by name."""
    costs, logs = costs or Costs(), logs or {}
    members: dict[str, Member] = {}
    for name, inner in plan.members.items():
        if inner is None:
            members[name] = Single(participants[name])
        else:
            coupling = assemble(inner, participants, exchange, ledger, logs, costs, depth + 1)
            members[name] = Group(coupling)
    return Coupling(plan, members, exchange, ledger, depth, costs, logs.get(plan.name))


def join_ports(
    coupling: Coupling,
    described: Mapping[str, Fields],
    asked: Mapping[str, Iterable[str]],
    begin: Callable[[Coupling], None] = lambda _: None,
) -> None:
    """Join all ports and hand out what holds at the start.

    Parameters
    ----------
    described : mapping
        Static fields that each component told.
    asked : mapping
        Outputs of each component that somebody wants who is no component.
    begin : function
        Brings components to where they start, if that is not where their parameters say.
    """
    exchange, participants = coupling.exchange, coupling.components
    static = exchange.bind(described, lambda name, request: participants[name].sample(request))
    wanted = {name: exchange.wanted(name, asked.get(name, ())) for name in participants}
    for name, participant in participants.items():
        works, joined = exchange.works(name), exchange.joined(name)
        header = {"works": works, "joined": joined, "wanted": wanted[name]}
        participant.bind(static[name], **header)
    begin(coupling)
    # Motion is known at once; forces, which follow from it, are zero before the first window.
    outputs = _give_all(exchange, participants, wanted)
    initial = {name: {**described[name], **fields} for name, fields in outputs.items()}
    if refused := [text for link in exchange.links for text in link.refusals(initial)]:
        raise SceneError(refused)
    exchange.count_rows(outputs)
    for name, participant in participants.items():
        participant.sums = AnswerSums(
            exchange.takes[name], exchange.gives[name], exchange.sharing(name)
        )
    for name, participant in participants.items():
        numbers = [n for n, transfer in enumerate(exchange.transfers) if transfer.taker == name]
        instants = _instants(exchange, name, numbers, outputs)
        participant.prime(instants, shares=exchange.shares(name))
        coupling.ledger.primed(name, instants)
    # A component may change by what it was primed with: a fluid loses what lies inside bodies.
    _begin(coupling, _give_all(exchange, participants, wanted))
    for participant in participants.values():
        participant.order_prepare()  # all at the same time, for some compile
    for participant in participants.values():
        participant.prepared()


def _give_all(
    exchange: Exchange,
    participants: Mapping[str, Participant],
    wanted: Mapping[str, Iterable[str]],
) -> dict[str, Fields]:
    return {
        name: participant.give(wanted[name], exchange.gives[name])
        for name, participant in participants.items()
    }


def _instants(
    exchange: Exchange, name: str, numbers: Iterable[int], outputs: Mapping[str, Fields]
) -> dict[str, Array]:
    deliveries = [(exchange.deliver(number, outputs, outputs), False) for number in numbers]
    fields = exchange.merge(name, deliveries).fields
    return {k: v for k, v in fields.items() if not exchange.is_impulse(name, k)}


def _begin(coupling: Coupling, outputs: Mapping[str, Fields]) -> None:
    """Give a coupling, and its groups, the outputs at the start."""
    for name in coupling.components:
        coupling.outputs[name] = coupling.previous[name] = outputs[name]
        coupling.sent[name] = {}
    exchange = coupling.exchange
    for stepper in coupling.members.values():
        if not isinstance(stepper, Group):
            continue
        _begin(stepper.coupling, outputs)
        for name in stepper.components:
            numbers = [  # of what comes from beyond the group, and from beyond those around it
                number
                for number, transfer in enumerate(exchange.transfers)
                if transfer.taker == name and transfer.giver not in stepper.components
            ]
            stepper.inputs[name].arrive(_instants(exchange, name, numbers, outputs), (), 1.0)


def _add_sums(total: dict[str, Any], sums: Sums) -> None:
    for key, sums_row in sums.items():
        total[key] = (
            [a + b for a, b in zip(total[key], sums_row, strict=True)] if key in total else sums_row
        )
