"""Warnings of a run: reasons why its results may be wrong. A run with one ends with status 1."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class RunWarning:
    """One reason why the results may be wrong."""

    source: str  # "component NAME", "link NAME" or "scene"
    subject: str  # what is wrong, in a word: one warning for each source and subject
    time: float  # s, end of the window in which it was raised first
    text: str

    def __str__(self) -> str:
        return f"warning of {self.source}: {self.text}"


class RunWarnings:
    """All warnings so far, by source and subject; the text is the latest, the time the first."""

    def __init__(self) -> None:
        self._all: dict[tuple[str, str], RunWarning] = {}
        self._new: dict[tuple[str, str], RunWarning] = {}

    def note(self, source: str, texts: Mapping[str, str]) -> None:
        """Take the warnings of one source, by subject, in a window that counts."""
        for subject, text in texts.items():
            self._new[source, subject] = RunWarning(source, subject, 0.0, text)

    def close_window(self, time: float) -> list[RunWarning]:
        """End a window at a time [s]; return the warnings that were raised for the first time."""
        raised = []
        for key, warning in self._new.items():
            first = self._all.get(key)
            since = first.time if first else time
            self._all[key] = RunWarning(*key, since, warning.text)
            if first is None:
                raised.append(self._all[key])
        self._new.clear()
        return raised

    def __bool__(self) -> bool:
        return bool(self._all)

    def summary(self) -> list[dict[str, Any]]:
        """What ``results.json`` has of them."""
        return [asdict(warning) for warning in self._all.values()]

    def save(self) -> list[dict[str, Any]]:
        """All of them, for a snapshot and for windows that are repeated."""
        return [asdict(warning) for warning in (*self._all.values(), *self._new.values())]

    def load(self, state: list[dict[str, Any]]) -> None:
        """Come back to what was saved."""
        self._new.clear()
        self._all = {(row["source"], row["subject"]): RunWarning(**row) for row in state}
