"""A ledger that books nothing: recorded components tell no sums, and nobody reads them here."""

from collections.abc import Mapping
from typing import Any


class NoWarnings:
    """Takes warnings of components and forgets them."""

    def note(self, *_: object) -> None:
        """See `RunWarnings.note`."""


class NoLedger:
    """The calls of `Ledger` that a coupling makes within its windows."""

    def __init__(self) -> None:
        self.totals: dict[str, Any] = {}
        self.warnings = NoWarnings()

    def primed(self, *_: object) -> None:
        """See `Ledger.primed`."""

    def book_given(self, *_: object) -> None:
        """See `Ledger.book_given`."""

    def given_for(self, *_: object) -> None:
        """See `Ledger.given_for`."""

    def mapped(self, *_: object) -> None:
        """See `Ledger.mapped`."""

    def applied(self, *_: object) -> None:
        """See `Ledger.applied`."""

    def moved(self, *_: object) -> None:
        """See `Ledger.moved`."""

    def worked(self, *_: object) -> None:
        """See `Ledger.worked`."""

    def save(self) -> dict[str, Any]:
        """See `Ledger.save`."""
        return {}

    def go_on(self, state: Mapping[str, Any]) -> None:
        """See `Ledger.go_on`."""

    def load(self, state: Mapping[str, Any]) -> None:
        """See `Ledger.load`."""
