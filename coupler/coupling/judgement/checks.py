"""All checks of a run's coupling, at every window's end and of the whole run."""

from collections.abc import Mapping
from typing import Protocol

from quintet.coupler.coupling.judgement.time_check import TimeCheck
from quintet.coupler.coupling.schedule import Coupling

Texts = Mapping[str, Mapping[str, str]]  # by link and subject


class Check(Protocol):
    """Watches the links of a run for one kind of error."""

    def look(self, coupling: Coupling) -> Texts:
        """Judge the links at a window's end."""

    def final_warnings(self, coupling: Coupling) -> Texts:
        """Judge the links by the whole run, once, at its end."""


class Checks:
    """The checks of one run; what they find is noted in its ledger."""

    def __init__(self, coupling: Coupling) -> None:
        self._coupling, self._time = coupling, TimeCheck()
        ledger = coupling.ledger
        self._checks: tuple[Check, ...] = (self._time, ledger.settling, ledger.watch)

    def before_window(self) -> None:
        """Step the coming window in pieces, if it is due for a look."""
        self._time.before(self._coupling)

    def after_window(self) -> None:
        """Judge all links; at the run's end also the whole run, its components included."""
        coupling, note = self._coupling, self._coupling.ledger.warnings.note
        finished = coupling.windows.finished
        for check in self._checks:
            rounds = [check.look(coupling)]
            rounds += [check.final_warnings(coupling)] if finished else []
            for texts in rounds:
                for link, found in texts.items():
                    note(f"link {link}", found)
        for name, participant in coupling.components.items() if finished else ():
            note(f"component {name}", participant.final_warnings())
