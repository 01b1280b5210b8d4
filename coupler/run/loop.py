"""The window loop of a run, until its end or until something ends it."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Protocol

from quintet.coupler.coupling.group import join_ports
from quintet.coupler.coupling.judgement.checks import Judgement
from quintet.coupler.coupling.participant import describe_all
from quintet.coupler.coupling.schedule import Coupling
from quintet.coupler.coupling.schemes import advance
from quintet.coupler.coupling.windows import Windows, run_windows
from quintet.coupler.run.beginning import Start
from quintet.interfaces.component import Fields


class Observer(Protocol):
    """Sees a run pass: writes it down, tells the user, asks for an end."""

    def plan(self, windows: Windows) -> None:
        """Say at which times windows must end."""

    def begin(self, coupling: Coupling, described: Mapping[str, Fields]) -> None:
        """Take note of the start, with all components primed."""

    def due(self, ticks: int) -> bool:
        """Whether totals and views are wanted at a time [ticks]."""

    def end_window(self, coupling: Coupling) -> None:
        """Take note of a window's end."""

    def warn(self, text: str) -> None:
        """Tell what makes the run doubtful."""

    def wants_end(self) -> bool:
        """Whether to stop here."""

    def ends_early(self, coupling: Coupling) -> None:
        """Take note that it stops at the end of a window, before the last."""


@dataclass(frozen=True, slots=True)
class RunEnd:
    """How far a run came."""

    finished: bool
    windows: int
    time: float  # s, simulated


def run(
    coupling: Coupling,
    end: float,
    observer: Observer,
    asked: Mapping[str, Iterable[str]],
    judgement: Judgement,
    resume: Callable[[Coupling], None] | None = None,
    start: Start | None = None,
) -> RunEnd:
    """Couple to the end [s], from the start or from where `resume` brings the coupling.

    `asked` has the outputs of each component that are wanted although no link reads them; `start`
    is the state of another run that it begins from.
    """
    described = describe_all(coupling.components)
    join_ports(coupling, described, asked, *([start.begin] if start else []))
    plan, exchange = coupling.plan, coupling.exchange
    follows = plan.window == "auto" or bool(coupling.equal)
    length = float("inf") if plan.window == "auto" else plan.window
    coupling.windows = windows = run_windows(end, length, follows, plan.follows(exchange))
    observer.plan(windows)
    if resume:
        resume(coupling)
    elif start:
        start.go_on(coupling)
    observer.begin(coupling, described)
    ledger = coupling.ledger
    while not windows.finished and not observer.wants_end():
        judgement.before_window(coupling)
        advance(coupling, lambda now: judgement.stability.needs_totals or observer.due(now))
        ledger.close_window(coupling.all_late(), coupling.all_in_transit())
        judgement.after_window(coupling)
        raised = ledger.warnings.close_window(windows.time)
        observer.end_window(coupling)
        for warning in raised:
            observer.warn(str(warning))
    if not windows.finished:
        observer.ends_early(coupling)
    return RunEnd(windows.finished, windows.done, windows.time)
