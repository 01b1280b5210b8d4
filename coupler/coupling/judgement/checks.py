"""All checks of a run's coupling, at every window's end and of the whole run."""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Optional, Protocol

from quintet.coupler.coupling.judgement.settling_watch import SettlingWatch
from quintet.coupler.coupling.judgement.stability_watch import StabilityWatch
from quintet.coupler.coupling.judgement.time_check import TimeCheck
from quintet.coupler.coupling.schedule import Coupling

if TYPE_CHECKING:  # only runs with error bars load it
    from quintet.coupler.coupling.judgement.error_bar import ErrorBar

Texts = Mapping[str, Mapping[str, str]]  # by link and subject


class Check(Protocol):
    """Watches the links of a run for one kind of error."""

    def check(self, coupling: Coupling) -> Texts:
        """Judge the links at a window's end."""

    def final_warnings(self, coupling: Coupling) -> Texts:
        """Judge the links by the whole run, once, at its end."""

    def save(self) -> dict[str, Any]:
        """All of it, for a snapshot."""

    def load(self, state: Mapping[str, Any]) -> None:
        """Come back to what was saved."""


class Judgement:
    """The checks of one run; their warnings are noted in its ledger.

    `error_bar` samples windows for the error bars of watched quantities, where a run wants them.
    """

    def __init__(self, links: Iterable[str], error_bar: Optional["ErrorBar"] = None) -> None:
        self.error_bar = error_bar
        self.time, self.stability = TimeCheck(), StabilityWatch(links)
        self._checks: dict[str, Check] = {
            "time": self.time,
            "settling": SettlingWatch(),
            "stability": self.stability,
        }

    def before_window(self, coupling: Coupling) -> None:
        """Step the coming window in pieces, if it is due for a comparison."""
        self.time.before(coupling)
        if self.error_bar:
            self.error_bar.before(coupling)

    def after_window(self, coupling: Coupling) -> None:
        """Judge all links; at the run's end also the whole run, its components included."""
        if self.error_bar:
            self.error_bar.check(coupling)
        note, finished = coupling.ledger.warnings.note, coupling.windows.finished
        for check in self._checks.values():
            rounds = [check.check(coupling)]
            rounds += [check.final_warnings(coupling)] if finished else []
            for texts in rounds:
                for link, warnings in texts.items():
                    note(f"link {link}", warnings)
        for name, participant in coupling.components.items() if finished else ():
            note(f"component {name}", participant.final_warnings())

    def suspects(self, coupling: Coupling) -> list[str]:
        """Couplings that were doubtful before a failure, in sentences."""
        return [*self.stability.suspects(coupling), *self.time.suspects(coupling)]

    def save(self) -> dict[str, Any]:
        """All of it, for a snapshot."""
        states = {name: check.save() for name, check in self._checks.items()}
        return states | ({"error_bar": self.error_bar.save()} if self.error_bar else {})

    def load(self, state: Mapping[str, Any]) -> None:
        """Come back to what was saved."""
        for name, check in self._checks.items():
            check.load(state[name])
        if self.error_bar:
            self.error_bar.load(state["error_bar"])
